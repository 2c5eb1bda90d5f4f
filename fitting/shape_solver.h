// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "fitting/normal_equations.h"

namespace articap {

struct ShapeSolverOptions {
  MarkerLoss loss;
  int max_evaluations = 60;
  // Converged when a step promises less than this part of the objective, or less than 1e-12 mm.
  double relative_tolerance = 1e-8;
};

// What happened to one frame.
struct ShapeSolution {
  double objective = 0;
  int evaluations = 0;  // of all positions and their Jacobian
  bool converged = false;
};

// minimise f(y) = sum_i loss(|q_i(y) - p_i|^2)  subject to  lower <= y <= upper
// by a damped Newton method (Levenberg-Marquardt on the loss' full second order) whose steps solve
// the box-constrained quadratic model. Made for thousands of frames with a few dozen markers: no
// allocation in the loop, warm starts. CeresShapeSolver is its reference.
class ShapeSolver {
 public:
  // The evaluator must outlive the solver. A parameter with lower == upper is held there.
  ShapeSolver(const VirtualMarkerEvaluator& evaluator, Eigen::VectorXd lower, Eigen::VectorXd upper,
              const ShapeSolverOptions& options = {});

  void SetBounds(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
    lower_ = lower;
    upper_ = upper;
  }

  // From *parameters, which is first brought into the box, to the minimum.
  ShapeSolution Solve(MarkerPositions measured_in_rig, Eigen::VectorXd* parameters);

 private:
  struct Step {
    Eigen::VectorXd change;
    double promised = 0;  // decrease of the model
  };
  Step SolveModel(bool far, double damping, const Eigen::VectorXd& parameters);

  NormalEquationBuilder builder_;
  Eigen::VectorXd lower_, upper_;
  ShapeSolverOptions options_;
  NormalEquations current_, candidate_;
  Eigen::MatrixXd model_;
};

}  // namespace articap
