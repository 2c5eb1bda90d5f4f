// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fitting/marker_loss.h"
#include "rig/virtual_marker_evaluator.h"

namespace articap {

// The objective of one frame, f(y) = sum_i loss(|q_i(y) - p_i|^2) over the markers seen, to second
// order; the curvature of q itself is left out. With r = q - p, J = dq/dy and the loss' derivatives
// l1, l2 by |r|^2:
struct NormalEquations {
  double objective = 0;
  Eigen::VectorXd gradient;  // sum 2 l1 J^T r
  // sum 2 l1 J^T J: the quadratic model of iteratively reweighted least squares. For concave losses
  // it majorises the objective, so its steps are safe, but converge linearly.
  Eigen::MatrixXd reweighted_hessian;
  // sum 4 l2 (J^T r)(J^T r)^T: with it the model is Newton's, and steps converge quadratically.
  Eigen::MatrixXd loss_curvature;
};

// One frame's markers: positions in the rig frame, NaN where missing; the order is the evaluator's.
using MarkerPositions = std::span<const Eigen::Vector3d>;

// One frame with its markers' residuals linearised at some y: r_i(y + d) = r_i + J_i d. Buffers are
// reused from frame to frame.
class LinearizedFrame {
 public:
  // The evaluator must outlive the frame.
  LinearizedFrame(const VirtualMarkerEvaluator& evaluator, const MarkerLoss& loss);

  void Linearize(MarkerPositions measured_in_rig, const Eigen::VectorXd& parameters);

  // The normal equations at y + d, by the linearised residuals.
  void Build(const Eigen::VectorXd& d, NormalEquations* equations);

  // The true objective, without derivatives.
  double Objective(MarkerPositions measured_in_rig, const Eigen::VectorXd& parameters) const;

 private:
  struct Marker {
    std::span<const int> columns;  // the parameters that move it
    Eigen::Vector3d residual;
    std::size_t first;  // of its 3 x columns numbers in jacobians_
  };
  void AddMarker(const Marker& marker, const Eigen::Vector3d& residual, double weight,
                 double curvature, NormalEquations* equations);

  const VirtualMarkerEvaluator& evaluator_;
  MarkerLoss loss_;
  std::vector<Marker> seen_;
  std::vector<double> jacobians_;
  std::vector<double> slopes_;  // J^T r of one marker
};

}  // namespace articap
