// SPDX-License-Identifier: MIT
#include "fitting/orientation_fit.h"

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>

#include "core/alignment.h"
#include "core/check.h"
#include "fitting/cost_functions/ceres_marker_loss.h"
#include "fitting/cost_functions/similarity_cost.h"

namespace articap {
namespace {

Sim3d ClosedForm(std::span<const PointPair> pairs) {
  std::vector<Eigen::Vector3d> in_head, in_rig;
  for (const PointPair& pair : pairs) {
    in_head.push_back(pair.point_in_head);
    in_rig.push_back(pair.point_in_rig);
  }
  return AlignSimilarity(in_head, in_rig);
}

}  // namespace

OrientationFit FitOrientation(std::span<const PointPair> pairs, const MarkerLoss& loss,
                              const std::optional<Sim3d>& start) {
  ARTICAP_CHECK_GE(pairs.size(), 3u);
  const Sim3d first = start ? *start : ClosedForm(pairs);
  double rotation[4] = {first.rotation.w(), first.rotation.x(), first.rotation.y(),
                        first.rotation.z()};
  Eigen::Vector3d translation_mm = first.translation_mm;
  double log_scale = std::log(first.scale);

  CeresMarkerLoss ceres_loss(loss);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  problem.AddParameterBlock(rotation, 4, new ceres::QuaternionManifold);
  for (const PointPair& pair : pairs)
    problem.AddResidualBlock(SimilarityCost::Create(pair.point_in_head, pair.point_in_rig),
                             &ceres_loss, rotation, translation_mm.data(), &log_scale);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.gradient_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  OrientationFit fit;
  fit.rig_from_head = {
      std::exp(log_scale),
      Eigen::Quaterniond(rotation[0], rotation[1], rotation[2], rotation[3]).normalized(),
      translation_mm};
  fit.converged = summary.IsSolutionUsable();
  for (const PointPair& pair : pairs) {
    const double residual_mm = (fit.rig_from_head * pair.point_in_head - pair.point_in_rig).norm();
    fit.residuals_mm.push_back(residual_mm);
    fit.objective += loss(residual_mm * residual_mm).cost;
  }
  return fit;
}

}  // namespace articap
