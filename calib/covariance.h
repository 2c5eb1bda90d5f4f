// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace articap {

// A Jacobian whose columns are first those of the cameras, then groups that no residual shares: the
// board's placements, the wand's instants. Compressed rows.
struct ArrowJacobian {
  int rows = 0;
  int camera_columns = 0;
  std::vector<int> group_sizes;  // columns of each group, in order, behind the cameras'
  std::vector<int> row_starts;   // rows + 1 entries
  std::vector<int> columns;
  std::vector<double> values;
};

// The covariance of the cameras' parameters for residuals of unit variance: the inverse of
// J'J's Schur complement, everything else being free too. Directions that the residuals do not
// determine have infinite variance: the parameters in them get an infinite diagonal entry.
Eigen::MatrixXd CameraCovariance(const ArrowJacobian& jacobian);

}  // namespace articap
