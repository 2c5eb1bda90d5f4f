// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/transforms.h"

namespace articap {

// Two points that two cameras see at the same instant, as rays (z = 1); which is which in the
// second camera is not known.
struct PointPairView {
  std::array<Eigen::Vector3d, 2> first;
  std::array<Eigen::Vector3d, 2> second;
};

struct RelativePose {
  Rigid3d second_from_first;  // the translation has length 1
  std::vector<bool> swapped;  // of each view: the second camera's points are the other way round
  std::vector<bool> inlier;
  int num_inliers = 0;
};

// The relative pose of two cameras from such views: essential matrices of four views in all their
// pairings (the eight-point algorithm), judged by the views that fit within `tolerance` (distance
// to the epipolar line in the plane z = 1), then of all that fit. Deterministic. Nothing with fewer
// than eight views, or none that fit. R. Hartley, "In defense of the eight-point algorithm", PAMI
// 19(6), 1997.
std::optional<RelativePose> FindRelativePose(const std::vector<PointPairView>& views,
                                             double tolerance);

}  // namespace articap
