// SPDX-License-Identifier: MIT
#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "calib/camera_blocks.h"
#include "calib/cost_functions/corner_cost.h"
#include "calib/network.h"
#include "calib/view_noise.h"
#include "core/check.h"

namespace articap {
namespace {

// Where a corner goes between the placements next to it in time: through its three places runs a
// parabola.
PointMotion MotionOf(const Network& network, const std::vector<double>& times_s, int placement,
                     const Eigen::Vector3d& corner_mm) {
  const std::optional<int> middle = MiddleOfTriple(times_s, placement);
  if (!middle) return {};
  std::array<TimedPoint, 3> path;
  for (int i = 0; i < 3; ++i) {
    const Placement& at = network.placements[*middle - 1 + i];
    path[i] = {at.time_s, at.stage_from_board * corner_mm};
  }
  return MotionThrough(path, times_s[placement]);
}

// Gives visit(sighting, cost, parameter blocks...) every corner of every sighting.
template <class Visit>
void VisitCorners(const Network& network, CameraBlocks& cameras, std::vector<PoseBlock>& placements,
                  const Visit& visit) {
  std::vector<double> times_s;
  for (const Placement& at : network.placements) times_s.push_back(at.time_s);
  for (std::size_t index = 0; index < network.sightings.size(); ++index) {
    const NetworkSighting& sighting = network.sightings[index];
    double* const lens = cameras.lens(sighting.view.camera);
    double* const pose = cameras.pose(sighting.view.camera);
    double* const placement = placements[sighting.placement].data();
    for (std::size_t i = 0; i < sighting.corners.size(); ++i) {
      const Eigen::Vector3d corner = network.board.corner_in_board_mm(sighting.corners[i]);
      const Eigen::Vector2d& seen_px = sighting.points_px[i];
      if (sighting.view.mirror >= 0) {
        const Mirror& mirror = cameras.mirror_info(sighting.view.mirror);
        visit(index, MirroredCornerCost{corner, seen_px, mirror.glass_mm, mirror.glass_index}, lens,
              pose, cameras.mirror(sighting.view.mirror), placement);
      } else if (network.moving) {
        PointMotion motion = MotionOf(network, times_s, sighting.placement, corner);
        motion.shift_s = sighting.time_s - times_s[sighting.placement];
        visit(index, MovingCornerCost{corner, seen_px, motion}, lens, pose,
              cameras.time_offset(sighting.view.camera), placement);
      } else {
        visit(index, DirectCornerCost{corner, seen_px}, lens, pose, placement);
      }
    }
  }
}

std::vector<PoseBlock> PlacementBlocksOf(const Network& network) {
  std::vector<PoseBlock> blocks;
  for (const Placement& placement : network.placements)
    blocks.push_back(ToBlock(placement.stage_from_board));
  return blocks;
}

class NetworkProblem {
 public:
  NetworkProblem(const Network& network, const AdjustOptions& options)
      : network_(network),
        options_(options),
        cameras_(network.array, options),
        placements_(PlacementBlocksOf(network)) {
    VisitCorners(network, cameras_, placements_,
                 [&](std::size_t sighting, const auto& cost, auto*... blocks) {
                   const int view = network.array.IndexOf(network.sightings[sighting].view);
                   problem_.AddResidualBlock(cost.Create(), LossOf(options, view), blocks...);
                   row_views_.insert(row_views_.end(), 2, view);
                 });
    cameras_.Constrain(problem_);
    for (PoseBlock& placement : placements_)
      if (problem_.HasParameterBlock(placement.data())) {
        AddPose(problem_, placement);
        seen_placements_.push_back(placement.data());
      }
  }
  NetworkProblem(const NetworkProblem&) = delete;
  NetworkProblem& operator=(const NetworkProblem&) = delete;

  ceres::Solver::Summary Solve() { return SolveBySchur(problem_, seen_placements_, options_); }

  Network Solution() const {
    Network network = network_;
    network.array = cameras_.Array();
    for (std::size_t i = 0; i < placements_.size(); ++i)
      network.placements[i].stage_from_board = FromBlock(placements_[i]);
    return network;
  }

  // For residuals of unit variance; rotations as angles.
  ArrowCovariance Covariance() {
    return CovarianceOfCameras(problem_, cameras_, seen_placements_, row_views_);
  }

  const std::vector<CameraParameter>& parameters() const { return cameras_.parameters(); }
  int num_free() const {
    return static_cast<int>(cameras_.parameters().size() + 6 * seen_placements_.size());
  }

 private:
  const Network& network_;
  const AdjustOptions& options_;
  CameraBlocks cameras_;
  std::vector<PoseBlock> placements_;
  std::vector<double*> seen_placements_;
  std::vector<int> row_views_;
  ceres::Problem problem_;
};

}  // namespace

bool LensFreedom::any() const {
  return focal || aspect || principal_point ||
         std::find(distortion.begin(), distortion.end(), true) != distortion.end();
}

void DistanceRms::Add(std::span<const Eigen::Vector2d> residuals_px) {
  for (const Eigen::Vector2d& residual : residuals_px) squares_px2_ += residual.squaredNorm();
  count_ += residuals_px.size();
}

double DistanceRms::px() const { return std::sqrt(squares_px2_ / static_cast<double>(count_)); }

double RmsOf(std::span<const Eigen::Vector2d> residuals_px) {
  DistanceRms rms;
  rms.Add(residuals_px);
  return rms.px();
}

double AdjustedNetwork::rms_px() const {
  DistanceRms rms;
  for (const auto& residuals : residuals_px) rms.Add(residuals);
  return rms.px();
}

std::vector<std::vector<Eigen::Vector2d>> ResidualsOf(const Network& network) {
  CameraBlocks cameras(network.array, {});
  std::vector<PoseBlock> placements = PlacementBlocksOf(network);
  std::vector<std::vector<Eigen::Vector2d>> residuals(network.sightings.size());
  VisitCorners(network, cameras, placements,
               [&](std::size_t sighting, const auto& cost, auto*... blocks) {
                 Eigen::Vector2d expected_less_seen = Eigen::Vector2d::Constant(NAN);
                 cost(static_cast<const double*>(blocks)..., expected_less_seen.data());
                 residuals[sighting].push_back(-expected_less_seen);
               });
  return residuals;
}

AdjustedNetwork Adjust(const Network& network, const AdjustOptions& options) {
  NetworkProblem problem(network, options);
  const ceres::Solver::Summary summary = problem.Solve();
  AdjustedNetwork adjusted;
  adjusted.network = problem.Solution();
  adjusted.converged = summary.termination_type == ceres::CONVERGENCE;
  adjusted.solver_message = summary.message;
  adjusted.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  adjusted.residuals_px = ResidualsOf(adjusted.network);
  adjusted.degrees_of_freedom = summary.num_residuals - problem.num_free();
  const ArrowCovariance covariance = problem.Covariance();
  NoiseSums sums(options, covariance.redundancies);
  for (std::size_t i = 0; i < adjusted.residuals_px.size(); ++i)
    for (const Eigen::Vector2d& residual : adjusted.residuals_px[i])
      sums.Add(network.array.IndexOf(network.sightings[i].view), residual);
  adjusted.noise_px = sums.NoiseOfViews_px();
  adjusted.sigma_px = sums.PooledNoise_px();
  adjusted.parameters = problem.parameters();
  adjusted.covariance = sums.VarianceFactor_px2(adjusted.degrees_of_freedom) * covariance.cameras;
  FillSigmas(adjusted.parameters, adjusted.covariance, adjusted.network.array);
  return adjusted;
}

}  // namespace articap
