// SPDX-License-Identifier: MIT
#include "rig/io/gltf_compare.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

namespace articap {
namespace {

constexpr int kRandomPoses = 24;
constexpr int kKeyFrames = 50;

// Poses that a file is compared in: neutral, each end of each range, then random ones within them.
std::vector<Eigen::VectorXd> SamplePoses(const FaceRig& rig) {
  const auto& ranges = rig.definition().parameters;
  std::vector<Eigen::VectorXd> poses = {Eigen::VectorXd::Zero(rig.num_parameters())};
  for (int i = 0; i < rig.num_parameters(); ++i)
    for (const double end : {ranges[i].min, ranges[i].max}) {
      poses.push_back(poses.front());
      poses.back()[i] = end;
    }
  std::mt19937_64 random(20040617);
  for (int k = 0; k < kRandomPoses; ++k) {
    poses.push_back(poses.front());
    for (int i = 0; i < rig.num_parameters(); ++i) {
      const double share = static_cast<double>(random() >> 11) * 0x1p-53;
      poses.back()[i] = ranges[i].min + share * (ranges[i].max - ranges[i].min);
    }
  }
  return poses;
}

// The file as another program would pose it, against the rig.
class FileComparison {
 public:
  FileComparison(const FaceRig& rig, GltfModel model)
      : rig_(rig), model_(std::move(model)), parts_(PartMeshes(rig.definition())) {
    if (rig.definition().jaw) jaw_node_ = model_.skins.at(0).joints.at(1);
  }

  // All distances in mm.
  double LargestDistance(const Eigen::VectorXd& parameters, const std::vector<float>& weights,
                         const Eigen::Vector3f& jaw_translation_m,
                         const Eigen::Quaternionf& jaw_rotation) {
    if (jaw_node_ >= 0)
      model_.nodes[jaw_node_].parent_from_node =
          Eigen::Translation3f(jaw_translation_m) * jaw_rotation.normalized();
    const std::vector<Eigen::Vector3d> expected_mm = rig_.Evaluate(parameters);
    const int node = model_.mesh_nodes.front();
    double largest_mm = 0;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      const std::vector<Eigen::Vector3f> found_m =
          EvaluatePrimitive(model_, node, model_.meshes[0].primitives[part], weights);
      for (std::size_t i = 0; i < found_m.size(); ++i)
        largest_mm = std::max(largest_mm, (kMetre_mm * found_m[i].cast<double>() -
                                           expected_mm[parts_[part].rig_vertex[i]])
                                              .norm());
    }
    return largest_mm;
  }

  double LargestDistance(const Eigen::VectorXd& parameters, const TargetPlan& plan) {
    JawPose jaw;
    if (rig_.definition().jaw) jaw = PoseJaw(rig_, parameters);
    return LargestDistance(parameters, TargetWeights(plan, parameters),
                           jaw.translation_m.cast<float>(), jaw.rotation.cast<float>());
  }

  // A key frame as the animation's channels hold it.
  double DistanceInKeyFrame(const RigAnimation& animation, int frame) {
    const auto values = [&](const char* path, std::size_t width) {
      for (const GltfModel::Channel& channel : model_.channels)
        if (channel.path == path)
          return std::vector<float>(
              channel.values.begin() + static_cast<long>(frame * width),
              channel.values.begin() + static_cast<long>((frame + 1) * width));
      return std::vector<float>(width, 0.0f);
    };
    const std::vector<float> t = values("translation", 3);
    const std::vector<float> q = values("rotation", 4);
    return LargestDistance(animation.parameters.row(frame).transpose(),
                           values("weights", model_.meshes[0].target_names.size()),
                           {t[0], t[1], t[2]}, {q[3], q[0], q[1], q[2]});
  }

  const GltfModel& model() const { return model_; }

 private:
  const FaceRig& rig_;
  GltfModel model_;
  std::vector<PartMesh> parts_;
  int jaw_node_ = -1;
};

}  // namespace

ExportReport CompareWithRig(const FaceRig& rig, const TargetPlan& plan, GltfModel model,
                            const std::optional<RigAnimation>& animation) {
  FileComparison comparison(rig, std::move(model));
  ExportReport report;
  const auto note = [&](double deviation_mm) {
    report.largest_deviation_mm = std::max(report.largest_deviation_mm, deviation_mm);
    ++report.poses_compared;
  };
  for (const Eigen::VectorXd& pose : SamplePoses(rig)) note(comparison.LargestDistance(pose, plan));
  if (animation) {
    const int num_frames = static_cast<int>(animation->parameters.rows());
    for (int frame = 0; frame < num_frames; frame += std::max(1, num_frames / kKeyFrames))
      note(comparison.DistanceInKeyFrame(*animation, frame));
  }
  report.target_names = comparison.model().meshes[0].target_names;
  return report;
}

}  // namespace articap
