// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/head_shape.h"
#include "core/result.h"

namespace articap {

// How the references of a take compare with the shape that all takes of the speaker share.
struct ShapeComparison {
  std::vector<double> deviation_mm;  // of each reference from its place in the given shape
  std::vector<int> misplaced;        // references that are better left out
  std::vector<std::string> warnings;
};

// Compares a take's own shape (points_mm, of `names`; NaN where not known) with a given one, up to
// a rigid motion. References off their places, fewer than half of all, are named in a warning:
// re-glued, or bent. Refused: fewer than three references in common; references exchanged,
// mirrored, in another unit; two groups that moved against one another (spectacles seated anew);
// another subject's shape. Deviations below `tolerance_mm` are no news.
Result<ShapeComparison> CompareWithShape(const std::vector<std::string>& names,
                                         const std::vector<Eigen::Vector3d>& points_mm,
                                         const HeadShape& given, double tolerance_mm);

}  // namespace articap
