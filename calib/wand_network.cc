// SPDX-License-Identifier: MIT
#include "calib/wand_network.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "calib/camera_blocks.h"
#include "calib/cost_functions/corner_cost.h"
#include "calib/view_noise.h"

namespace articap {
namespace {

PointMotion MotionOfEnd(const WandNetwork& network, const std::vector<double>& times_s, int instant,
                        int end) {
  const std::optional<int> middle = MiddleOfTriple(times_s, instant);
  if (!middle) return {};
  std::array<TimedPoint, 3> path;
  for (int i = 0; i < 3; ++i) {
    const WandInstant& at = network.instants[*middle - 1 + i];
    path[i] = {at.time_s, at.ends_mm[end]};
  }
  return MotionThrough(path, times_s[instant]);
}

// Both ends of an instant, one after the other.
using EndsBlock = std::array<double, 6>;

class WandProblem {
 public:
  WandProblem(const WandNetwork& network, const AdjustOptions& options)
      : network_(network), options_(options), cameras_(network.array, options) {
    for (const WandInstant& instant : network.instants) {
      EndsBlock& ends = ends_.emplace_back();
      for (int end = 0; end < 2; ++end)
        Eigen::Map<Eigen::Vector3d>{ends.data() + 3 * end} = instant.ends_mm[end];
    }
    const std::vector<double> times_s = InstantTimes_s(network);
    for (const WandSighting& sighting : network.sightings) AddSighting(sighting, times_s);
    for (EndsBlock& ends : ends_) {
      if (!problem_.HasParameterBlock(ends.data())) continue;
      seen_.push_back(ends.data());
      problem_.AddResidualBlock(
          RodLengthCost{network.length_mm, network.length_sigma_mm / network.sigma_px}.Create(),
          nullptr, ends.data());
      row_views_.push_back(-1);
    }
    cameras_.Constrain(problem_);
  }
  WandProblem(const WandProblem&) = delete;
  WandProblem& operator=(const WandProblem&) = delete;

  ceres::Solver::Summary Solve() { return SolveBySchur(problem_, seen_, options_); }

  WandNetwork Solution() const {
    WandNetwork network = network_;
    network.array = cameras_.Array();
    for (std::size_t i = 0; i < ends_.size(); ++i)
      for (int end = 0; end < 2; ++end)
        network.instants[i].ends_mm[end] =
            Eigen::Map<const Eigen::Vector3d>(ends_[i].data() + 3 * end);
    return network;
  }

  ArrowCovariance Covariance() {
    return CovarianceOfCameras(problem_, cameras_, seen_, row_views_);
  }

  const std::vector<CameraParameter>& parameters() const { return cameras_.parameters(); }
  int num_free() const { return static_cast<int>(cameras_.parameters().size() + 6 * seen_.size()); }

 private:
  void AddSighting(const WandSighting& sighting, const std::vector<double>& times_s) {
    for (int end = 0; end < 2; ++end) {
      PointMotion motion = MotionOfEnd(network_, times_s, sighting.instant, end);
      motion.shift_s = sighting.time_s - times_s[sighting.instant];
      problem_.AddResidualBlock(RodEndCost{end, sighting.ends_px[end], motion}.Create(),
                                LossOf(options_, sighting.camera), cameras_.lens(sighting.camera),
                                cameras_.pose(sighting.camera),
                                cameras_.time_offset(sighting.camera),
                                ends_[sighting.instant].data());
      row_views_.insert(row_views_.end(), 2, sighting.camera);
    }
  }

  const WandNetwork& network_;
  const AdjustOptions& options_;
  CameraBlocks cameras_;
  std::vector<EndsBlock> ends_;
  std::vector<double*> seen_;  // those that a sighting shows
  std::vector<int> row_views_;
  ceres::Problem problem_;
};

std::vector<std::array<Eigen::Vector2d, 2>> ResidualsOf(const WandNetwork& network) {
  const std::vector<double> times_s = InstantTimes_s(network);
  std::vector<std::array<Eigen::Vector2d, 2>> residuals;
  for (const WandSighting& sighting : network.sightings) {
    const Camera& camera = network.array.cameras[sighting.camera];
    const double after_s =
        sighting.time_s + camera.time_offset_s - network.instants[sighting.instant].time_s;
    const auto ends = EndsAfter(network, times_s, sighting.instant, after_s);
    std::array<Eigen::Vector2d, 2>& of_ends = residuals.emplace_back();
    for (int end = 0; end < 2; ++end) {
      const auto expected = Project(network.array, {sighting.camera, -1}, ends[end]);
      of_ends[end] = expected ? Eigen::Vector2d(sighting.ends_px[end] - *expected)
                              : Eigen::Vector2d::Constant(HUGE_VAL);
    }
  }
  return residuals;
}

// Of the ends and, in the same unit, of the lengths.
NoiseSums SumsOf(const AdjustedWand& adjusted, const AdjustOptions& options,
                 const std::vector<double>& redundancies) {
  NoiseSums sums(options, redundancies);
  const WandNetwork& network = adjusted.network;
  for (std::size_t i = 0; i < network.sightings.size(); ++i)
    for (const Eigen::Vector2d& residual : adjusted.residuals_px[i])
      sums.Add(network.sightings[i].camera, residual);
  for (const WandInstant& instant : network.instants)
    sums.AddOther(((instant.ends_mm[0] - instant.ends_mm[1]).norm() - network.length_mm) *
                  network.sigma_px / network.length_sigma_mm);
  return sums;
}

// A length that is wrong is so at every instant: all distances from the first camera, which is the
// stage's origin, grow by the same part, and no residual shows it.
void AddScaleError(const WandNetwork& network, const std::vector<CameraParameter>& parameters,
                   Eigen::MatrixXd& covariance) {
  Eigen::VectorXd by_scale = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size()));
  for (int i = 0; i < by_scale.size(); ++i)
    if (parameters[i].kind == CameraParameter::Kind::kTranslation)
      by_scale(i) = network.array.cameras[parameters[i].index]
                        .cam_from_stage.translation_mm[parameters[i].component];
  const double scale_sigma = network.length_sigma_mm / network.length_mm;
  covariance += scale_sigma * scale_sigma * by_scale * by_scale.transpose();
}

}  // namespace

std::vector<double> InstantTimes_s(const WandNetwork& network) {
  std::vector<double> times_s;
  for (const WandInstant& at : network.instants) times_s.push_back(at.time_s);
  return times_s;
}

std::array<Eigen::Vector3d, 2> EndsAfter(const WandNetwork& network,
                                         const std::vector<double>& times_s, int instant,
                                         double after_s) {
  std::array<Eigen::Vector3d, 2> ends = network.instants[instant].ends_mm;
  for (int end = 0; end < 2; ++end)
    ends[end] += MotionOfEnd(network, times_s, instant, end).After(after_s);
  return ends;
}

AdjustedWand AdjustWand(const WandNetwork& network, const AdjustOptions& options) {
  WandProblem problem(network, options);
  const ceres::Solver::Summary summary = problem.Solve();
  AdjustedWand adjusted;
  adjusted.network = problem.Solution();
  adjusted.converged = summary.termination_type == ceres::CONVERGENCE;
  adjusted.residuals_px = ResidualsOf(adjusted.network);
  const ArrowCovariance covariance = problem.Covariance();
  const NoiseSums sums = SumsOf(adjusted, options, covariance.redundancies);
  adjusted.noise_px = sums.NoiseOfViews_px();
  adjusted.sigma_px = sums.PooledNoise_px();
  adjusted.parameters = problem.parameters();
  adjusted.covariance =
      sums.VarianceFactor_px2(summary.num_residuals - problem.num_free()) * covariance.cameras;
  AddScaleError(adjusted.network, adjusted.parameters, adjusted.covariance);
  FillSigmas(adjusted.parameters, adjusted.covariance, adjusted.network.array);
  return adjusted;
}

}  // namespace articap
