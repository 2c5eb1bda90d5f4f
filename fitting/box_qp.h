// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace articap {

// minimise g^T x + 1/2 x^T H x  subject to  lower <= x <= upper, for small dense positive definite
// H; lower <= 0 <= upper. An active-set method: free variables that leave the box are fixed at it,
// fixed ones whose gradient points inwards are freed, until neither happens. A variable with lower
// == upper stays at 0. Returns a feasible x with a non-positive objective; 0 where H is not
// definite by rounding.
Eigen::VectorXd SolveBoxQp(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace articap
