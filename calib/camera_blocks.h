// SPDX-License-Identifier: MIT
#pragma once

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "calib/cost_functions/corner_cost.h"
#include "calib/covariance.h"
#include "calib/network.h"

namespace articap {

using PoseBlock = std::array<double, kPoseSize>;
PoseBlock ToBlock(const Rigid3d& transform);
Rigid3d FromBlock(const PoseBlock& block);

// Adds a pose to a problem, with its rotation on the sphere of quaternions.
void AddPose(ceres::Problem& problem, PoseBlock& pose);

// The parameters of an array of cameras, as Ceres adjusts them.
class CameraBlocks {
 public:
  CameraBlocks(const CameraArray& array, const AdjustOptions& options);
  CameraBlocks(const CameraBlocks&) = delete;
  CameraBlocks& operator=(const CameraBlocks&) = delete;

  double* lens(int camera) { return cameras_[camera].lens.data(); }
  double* pose(int camera) { return cameras_[camera].pose.data(); }
  double* time_offset(int camera) { return &cameras_[camera].time_offset_s; }
  double* mirror(int mirror) { return mirrors_[mirror].data(); }
  const Mirror& mirror_info(int mirror) const { return array_.mirrors[mirror]; }
  int num_views() const { return static_cast<int>(cameras_.size() + mirrors_.size()); }

  // Once all residuals are in: manifolds, and what is held. Blocks that no residual has are left
  // out.
  void Constrain(ceres::Problem& problem);

  // The array with the adjusted values.
  CameraArray Array() const;

  // The free parameters and their blocks, in the order of the covariance.
  const std::vector<CameraParameter>& parameters() const { return parameters_; }
  const std::vector<double*>& free_blocks() const { return free_blocks_; }

 private:
  struct CameraBlock {
    std::array<double, kLensSize> lens{};
    PoseBlock pose{};
    double time_offset_s = 0;
  };

  void ConstrainLens(ceres::Problem& problem, int camera);
  void ConstrainPose(ceres::Problem& problem, int camera);
  void ConstrainTimeOffset(ceres::Problem& problem, int camera);
  void ConstrainMirror(ceres::Problem& problem, int mirror);

  CameraArray array_;
  AdjustOptions options_;
  std::vector<CameraBlock> cameras_;
  std::vector<std::array<double, kMirrorSize>> mirrors_;
  std::vector<CameraParameter> parameters_;
  std::vector<double*> free_blocks_;
};

// What the residuals of a view (its index in CameraArray::views()) cost: of their squares over its
// noise, with Huber's loss. The caller owns it; null: plain least squares.
ceres::LossFunction* LossOf(const AdjustOptions& options, int view);

// Minimises by Levenberg and Marquardt's method. `places`, blocks that share no residual with one
// another (the board's placements, the wand's instants), are eliminated first.
ceres::Solver::Summary SolveBySchur(ceres::Problem& problem, const std::vector<double*>& places,
                                    const AdjustOptions& options);

// The covariance of the cameras' free parameters at the solution, for residuals of unit variance,
// the places being free too; rotations as angles. `row_views` says of each residual, in the order
// in which they were added, which view's it is; -1: no view's.
ArrowCovariance CovarianceOfCameras(ceres::Problem& problem, const CameraBlocks& cameras,
                                    const std::vector<double*>& places,
                                    const std::vector<int>& row_views);

// Writes the standard deviations of a covariance (already times the variance of the residuals) into
// the cameras and mirrors; 0 for what was held.
void FillSigmas(const std::vector<CameraParameter>& parameters, const Eigen::MatrixXd& covariance,
                CameraArray& array);

}  // namespace articap
