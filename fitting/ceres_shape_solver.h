// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/shape_solver.h"

namespace articap {

// ceres::Solve on the problem of ShapeSolver: the reference that it is tested against, and what
// `articap fit --solver ceres` runs. A problem a frame, so slow.
ShapeSolution SolveShapeWithCeres(const VirtualMarkerEvaluator& evaluator,
                                  const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                  const MarkerLoss& loss, MarkerPositions measured_in_rig,
                                  Eigen::VectorXd* parameters);

}  // namespace articap
