// SPDX-License-Identifier: MIT
#include "core/dots.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace articap {

double Dot::diameter_px() const { return 2 * std::pow(shape_px2.determinant(), 0.25); }

double Dot::roundness() const {
  // Eigenvalues of a symmetric 2 x 2 matrix, from its trace and determinant.
  const double mean = shape_px2.trace() / 2;
  const double apart = std::sqrt(std::max(0.0, mean * mean - shape_px2.determinant()));
  return std::sqrt((mean - apart) / (mean + apart));
}

}  // namespace articap
