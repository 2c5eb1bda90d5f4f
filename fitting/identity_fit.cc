// SPDX-License-Identifier: MIT
#include "fitting/identity_fit.h"

#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>

#include "core/check.h"
#include "fitting/cost_functions/identity_cost.h"

namespace articap {
namespace {

// How far a marker sits from its landmark on a rig of the right identity, mm: the glue, and the
// rig's own departure from any face.
constexpr double kLandmarkSigma_mm = 2.5;

// The landmarks' displacement per unit of each slider in this pose. Positions are linear in
// identity.
std::vector<Eigen::Matrix3Xd> LandmarkDisplacements(const FaceRig& rig, const Eigen::VectorXd& pose,
                                                    std::span<const LandmarkPoint> points,
                                                    const std::vector<Eigen::Vector3d>& neutral) {
  const int num_sliders = static_cast<int>(rig.identity().size());
  std::vector<Eigen::Matrix3Xd> displacements(points.size(), Eigen::Matrix3Xd(3, num_sliders));
  for (int k = 0; k < num_sliders; ++k) {
    const auto moved = rig.WithIdentity(Eigen::VectorXd::Unit(num_sliders, k)).Evaluate(pose);
    for (std::size_t i = 0; i < points.size(); ++i)
      displacements[i].col(k) = moved[points[i].vertex] - neutral[points[i].vertex];
  }
  return displacements;
}

void AddSliders(const FaceRig& rig, const std::vector<std::optional<double>>& given,
                double* identity, ceres::Problem* problem) {
  const auto& sliders = rig.definition().identity_sliders;
  const int num_sliders = static_cast<int>(sliders.size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(num_sliders, num_sliders);
  std::vector<int> held;
  for (int k = 0; k < num_sliders; ++k) {
    weights(k, k) = 2 / (sliders[k].max - sliders[k].min);
    if (given[k]) {
      identity[k] = *given[k];
      held.push_back(k);
    }
  }
  problem->AddResidualBlock(new ceres::NormalPrior(weights, Eigen::VectorXd::Zero(num_sliders)),
                            nullptr, identity);
  for (int k = 0; k < num_sliders; ++k)
    if (!given[k]) {
      problem->SetParameterLowerBound(identity, k, sliders[k].min);
      problem->SetParameterUpperBound(identity, k, sliders[k].max);
    }
  if (static_cast<int>(held.size()) == num_sliders)
    problem->SetParameterBlockConstant(identity);
  else if (!held.empty())
    problem->SetManifold(identity, new ceres::SubsetManifold(num_sliders, held));
}

}  // namespace

Eigen::VectorXd FitIdentity(const FaceRig& rig, const Eigen::VectorXd& pose,
                            std::span<const LandmarkPoint> points, const Sim3d& rig_from_head,
                            const std::vector<std::optional<double>>& given) {
  const int num_sliders = static_cast<int>(rig.definition().identity_sliders.size());
  ARTICAP_CHECK_EQ(static_cast<int>(given.size()), num_sliders);
  Eigen::VectorXd identity = Eigen::VectorXd::Zero(num_sliders);
  if (num_sliders == 0) return identity;

  const FaceRig average = rig.WithIdentity(identity);
  const auto neutral = average.Evaluate(pose);
  const auto normals = VertexNormals({neutral, average.neutral_mesh().triangles});
  const auto displacements = LandmarkDisplacements(average, pose, points, neutral);
  double rotation[4] = {rig_from_head.rotation.w(), rig_from_head.rotation.x(),
                        rig_from_head.rotation.y(), rig_from_head.rotation.z()};
  Eigen::Vector3d translation_mm = rig_from_head.translation_mm;
  double log_scale = std::log(rig_from_head.scale);

  ceres::Problem problem;
  problem.AddParameterBlock(rotation, 4, new ceres::QuaternionManifold);
  for (std::size_t i = 0; i < points.size(); ++i)
    problem.AddResidualBlock(
        IdentityCost::Create(
            points[i].point_in_head,
            neutral[points[i].vertex] + points[i].height_mm * normals[points[i].vertex],
            displacements[i]),
        new ceres::ScaledLoss(new ceres::HuberLoss(2 * kLandmarkSigma_mm),
                              1 / (kLandmarkSigma_mm * kLandmarkSigma_mm), ceres::TAKE_OWNERSHIP),
        rotation, translation_mm.data(), &log_scale, identity.data());
  AddSliders(rig, given, identity.data(), &problem);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return identity;
}

}  // namespace articap
