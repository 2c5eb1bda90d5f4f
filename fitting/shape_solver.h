// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "fitting/normal_equations.h"

namespace articap {

struct ShapeSolverOptions {
  MarkerLoss loss;
  int max_evaluations = 60;
  // Converged when the next step is foreseen to promise less than this part of the objective, or
  // less than 1e-12 mm.
  double relative_tolerance = 1e-8;
};

// What happened to one frame.
struct ShapeSolution {
  double objective = 0;  // as of the last linearisation: within the tolerance
  int evaluations = 0;   // of all positions, most of them with their Jacobian
  bool converged = false;
};

// minimise f(y) = sum_i loss(|q_i(y) - p_i|^2)  subject to  lower <= y <= upper
// by successive linearisation (Fletcher 1982; "prox-linear"): the markers are linearised at y, the
// loss of the linearised residuals, which is convex, is minimised over the box, and y moves there.
// The markers are nearly linear over the step from one frame to the next, so that the kinks of the
// sum of distances are dealt with in the cheap inner problem and a few evaluations do. Made for
// thousands of frames with a few dozen markers; SolveShapeWithCeres is its reference.
class ShapeSolver {
 public:
  // The evaluator must outlive the solver. A parameter with lower == upper is held there.
  ShapeSolver(const VirtualMarkerEvaluator& evaluator, Eigen::VectorXd lower, Eigen::VectorXd upper,
              const ShapeSolverOptions& options = {});

  void SetBounds(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
    lower_ = lower;
    upper_ = upper;
  }

  // From *parameters, which is first brought into the box, to the minimum, or to the best point
  // that was found.
  ShapeSolution Solve(MarkerPositions measured_in_rig, Eigen::VectorXd* parameters);

 private:
  double ToleranceOf(double objective) const;
  double MinimizeLinearized(double curvature_share);
  double SolveModel(double curvature_share);

  LinearizedFrame frame_;
  Eigen::VectorXd lower_, upper_;
  ShapeSolverOptions options_;

  // Of the inner problem, relative to the y that the frame is linearised at.
  Eigen::VectorXd box_lower_, box_upper_;
  Eigen::VectorXd move_, candidate_move_, step_;
  NormalEquations current_, candidate_;
  Eigen::MatrixXd model_;
};

}  // namespace articap
