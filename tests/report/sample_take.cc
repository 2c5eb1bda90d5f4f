// SPDX-License-Identifier: MIT
#include "tests/report/sample_take.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace articap {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TriangleMesh MakeEgg(int num_rings, int num_columns) {
  TriangleMesh mesh;
  for (int ring = 0; ring <= num_rings; ++ring)
    for (int column = 0; column < num_columns; ++column) {
      const double polar = kPi * ring / num_rings;
      const double around = 2 * kPi * column / num_columns;
      mesh.vertices.emplace_back(70 * std::sin(polar) * std::sin(around), 105 * std::cos(polar),
                                 85 * std::sin(polar) * std::cos(around));
    }
  for (int ring = 0; ring < num_rings; ++ring)
    for (int column = 0; column < num_columns; ++column) {
      const int a = ring * num_columns + column;
      const int b = ring * num_columns + (column + 1) % num_columns;
      mesh.triangles.emplace_back(a, a + num_columns, b);
      mesh.triangles.emplace_back(b, a + num_columns, b + num_columns);
    }
  return mesh;
}

WeightMap WeightsAround(const TriangleMesh& mesh, const std::string& name,
                        const Eigen::Vector3d& center, double radius_mm) {
  WeightMap map{name, {}};
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    map.weights.push_back(std::exp(-(vertex - center).squaredNorm() / (radius_mm * radius_mm)));
  return map;
}

StageReport MakeReport(const std::string& stage, const std::string& verdict) {
  StageReport report;
  report.stage = stage;
  report.verdict = verdict;
  report.figures = {{"frames", 1590}, {"median_residual_mm", 0.4312}, {"largest_turn_deg", 12.5}};
  report.texts = {
      {"mode", "rigid"},
      {"references", "ForeHead_M,ForeHead_L,ForeHead_R,Leye_Inside,Reye_Inside,NoseTop,NoseHead"},
      {"axes", "y from Chin to NoseTop, x from Reye_Outside to Leye_Outside"}};
  for (int i = 1; i <= 12; ++i)
    report.figures.emplace_back("a_figure_of_some_length_" + std::to_string(i) + "_mm", i / 7.0);
  report.tables = {{"references", {"rms_mm", "largest_mm"}, {{"brow", {0.21, 0.88}}}}};
  report.options = {{"max_residual_mm", "2"}, {"robust", "true"}};
  return report;
}

}  // namespace

FaceRig MakeEggRig() {
  RigDefinition rig;
  rig.name = "egg";
  rig.mesh = MakeEgg(28, 36);
  rig.colors.assign(rig.mesh.vertices.size(), Eigen::Vector3f(0.55f, 0.32f, 0.24f));
  rig.part_names = {"skin"};
  rig.region_names = {"all"};
  rig.triangle_part.assign(rig.mesh.triangles.size(), 0);
  rig.triangle_region.assign(rig.mesh.triangles.size(), 0);
  rig.parameters = {{"jaw_rotation", ParameterUnit::kRadian, -0.05, 0.35, "opens the jaw", ""},
                    {"lip_rounding", ParameterUnit::kMillimetre, -2, 9, "rounds the lips", ""},
                    {"jaw_shift", ParameterUnit::kMillimetre, -6, 6, "moves the jaw left", ""}};
  rig.weight_maps = {WeightsAround(rig.mesh, "jaw", {0, -70, 60}, 55),
                     WeightsAround(rig.mesh, "mouth", {0, -30, 80}, 22)};
  rig.transforms = {{WeightedTransform::Kind::kTranslate, 1, 1, Eigen::Vector3d(0, 0, 1), -1}};
  rig.landmarks = {{"nose_tip", 36 * 13}, {"chin", 36 * 22}, {"upper_lip_center", 36 * 16}};
  for (int column : {3, 33}) rig.landmarks.push_back({"corner", 36 * 17 + column});
  rig.landmarks[3].name = "left_mouth_corner";
  rig.landmarks[4].name = "right_mouth_corner";
  rig.jaw = JawJoint{.weight_map = 0,
                     .pivot_vertex = 36 * 14 + 9,
                     .rotation_parameter = 0,
                     .thrust_parameter = -1,
                     .shift_parameter = 2};
  return *FaceRig::Create(std::move(rig));
}

SampleTake MakeSampleTake(const FaceRig& rig, int num_frames, double rate_hz) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const RigDefinition& definition = rig.definition();
  const int num_parameters = rig.num_parameters();
  SampleTake take;
  ParameterTrack& track = take.parameters;
  track.rate_hz = rate_hz;
  track.values.resize(num_frames, num_parameters);
  track.sigmas.setConstant(num_frames, num_parameters, kNaN);
  for (const RigParameter& parameter : definition.parameters) {
    track.names.push_back(parameter.name);
    track.units.push_back(parameter.unit == ParameterUnit::kRadian       ? "rad"
                          : parameter.unit == ParameterUnit::kMillimetre ? "mm"
                                                                         : "1");
    take.ranges.push_back({parameter.min, parameter.max, parameter.description});
  }
  std::vector<Landmark> places;
  for (const Landmark& landmark : definition.landmarks)
    if (landmark.name.find("pivot") == std::string::npos && landmark.name.find("center") != 4 &&
        places.size() < 36)
      places.push_back(landmark);
  std::vector<std::string> names;
  for (const Landmark& place : places) names.push_back(place.name);
  take.measured = RigTracks(names, num_frames, rate_hz);
  take.virtual_markers = RigTracks(names, num_frames, rate_hz);
  take.residuals.names = names;
  take.residuals.distances_mm.setConstant(num_frames, static_cast<int>(names.size()),
                                          std::numeric_limits<float>::quiet_NaN());
  take.head_pose.mode = StabilizationMode::kRigid;
  take.head_pose.rate_hz = rate_hz;

  const char* const phones[] = {"", "DH", "AH", "B", "ER", "CH", "K", "AX", "N", "UW1"};
  for (int frame = 0; frame < num_frames; ++frame) {
    const double time_s = frame / rate_hz;
    Eigen::VectorXd pose(num_parameters);
    for (int i = 0; i < num_parameters; ++i) {
      const RigParameter& parameter = definition.parameters[i];
      // Syllables at some 4 Hz in phrases of 3 s, each parameter with a phase of its own.
      const double syllable = std::sin(2 * kPi * (3.1 + 0.23 * i) * time_s + i);
      const double phrase = std::pow(std::sin(kPi * time_s / 3 + 0.4 * i), 2);
      const double gesture = 0.55 * phrase * syllable;
      pose[i] = gesture > 0 ? gesture * parameter.max : -gesture * 0.8 * parameter.min;
    }
    HeadPose head;
    head.head_from_stage.rotation =
        Eigen::AngleAxisd(0.12 * std::sin(time_s), Eigen::Vector3d(0.3, 1, 0.1).normalized());
    head.head_from_stage.translation_mm = {4 * std::sin(0.7 * time_s), 2 * std::cos(time_s), 3};
    head.residual_mm = 0.2 + 0.05 * std::abs(normal(random));
    const bool is_lost = frame % 400 >= 250 && frame % 400 < 262;
    if (is_lost) head = {{}, kNaN, HeadPoseStatus::kTooFewReferences};
    take.head_pose.poses.push_back(head);
    track.phones.emplace_back(phones[(frame / 7) % 10]);
    track.statuses.push_back(is_lost          ? FitStatus::kNoHeadPose
                             : frame % 97 < 3 ? FitStatus::kWeak
                                              : FitStatus::kOk);
    if (is_lost) {
      track.values.row(frame).setConstant(kNaN);
      track.residuals_mm.push_back(kNaN);
      continue;
    }
    track.values.row(frame) = pose;
    for (int i = 0; i < num_parameters; ++i)
      track.sigmas(frame, i) =
          (0.02 + 0.01 * std::sin(time_s + i)) * (take.ranges[i].max - take.ranges[i].min);
    if (track.statuses.back() == FitStatus::kWeak) track.sigmas(frame, 0) = kInfinity;
    const std::vector<Eigen::Vector3d> vertices = rig.Evaluate(pose);
    double sum_mm = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const int marker = static_cast<int>(k);
      const Eigen::Vector3d& q = vertices[places[k].vertex];
      const double sigma_mm =
          0.15 + 0.04 * static_cast<double>(k % 9) + (k % 11 == 3 && frame % 300 < 40 ? 1.5 : 0);
      const Eigen::Vector3d p =
          q + sigma_mm * Eigen::Vector3d{normal(random), normal(random), normal(random)};
      take.virtual_markers.Set(frame, marker, q);
      if (k % 13 == 5 && frame % 220 > 180) continue;  // a marker that is lost now and then
      take.measured.Set(frame, marker, p);
      take.residuals.distances_mm(frame, marker) = static_cast<float>((p - q).norm());
      sum_mm += (p - q).norm();
    }
    track.residuals_mm.push_back(sum_mm / static_cast<double>(places.size()));
  }
  take.reports = {MakeReport("stabilize", "The head was found in 97.0 % of the frames."),
                  MakeReport("bind", "The reference pose is tied to the rig."),
                  MakeReport("fit", "All frames with a head pose have parameters.")};
  take.reports[0].warnings = {"48 frames have too few head references and no pose"};
  take.reports[2].warnings = {"jaw_rotation is not determined in 3.1 % of the frames"};
  return take;
}

ReportPageInput SampleTake::Input(const FaceRig& rig) const {
  return {.title = "A sample take",
          .reports = reports,
          .parameters = &parameters,
          .ranges = ranges,
          .residuals = &residuals,
          .head_pose = &head_pose,
          .rig = &rig,
          .measured = &measured,
          .virtual_markers = &virtual_markers,
          .window = std::nullopt};
}

}  // namespace articap
