// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace articap {

// The assignment of rows to columns with the least sum of costs, in which every column serves one
// row at most and a row may stay without a column for `null_cost`. Costs of infinity mean: never.
// The column of every row; -1 for none.
// Shortest augmenting paths with potentials: R. Jonker, A. Volgenant, "A shortest augmenting path
// algorithm for dense and sparse linear assignment problems", Computing 38, 1987.
std::vector<int> Assign(const Eigen::MatrixXd& costs, double null_cost);

}  // namespace articap
