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
  std::vector<int> row_views;  // which view's residual each row is; -1: no view's
  int views = 0;
};

struct ArrowCovariance {
  // Of the cameras' parameters for residuals of unit variance: the inverse of J'J's Schur
  // complement, everything else being free too. Directions that the residuals do not determine have
  // infinite variance: the parameters in them get an infinite diagonal entry.
  Eigen::MatrixXd cameras;
  // Of each view, how many of its residuals are left to tell its noise: their number less the trace
  // of J (J'J)^-1 J' over its rows. With those of no view they add up to the degrees of freedom.
  std::vector<double> redundancies;
};
ArrowCovariance CovarianceOf(const ArrowJacobian& jacobian);

}  // namespace articap
