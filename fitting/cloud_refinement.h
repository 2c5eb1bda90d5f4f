// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/transforms.h"
#include "fitting/face_surface.h"

namespace articap {

// How far the markers of an unknown layout on an unknown face lie from what the rig leads one to
// expect.
struct CloudModel {
  double surface_sd_mm = 2;   // beside the rig's skin: another face, the radius of a marker
  double landmark_sd_mm = 4;  // beside the nearest landmark
  double scale_sd = 0.15;  // natural logarithm: heads differ by 5 %, what rigs take for one by more
};

struct CloudFit {
  Sim3d rig_from_cloud;
  double cost = 0;  // see RefineCloudAlignment; without unit
};

// Minimises over the similarity T, from a start near by (Levenberg and Marquardt on iteratively
// reweighted squares),
//   sum_i log(1 + d_i^2 / surface_sd^2) [+ sum_i log(1 + l_i^2 / landmark_sd^2)] +
//   (ln s / scale_sd)^2,
// d_i the distance of T p_i to the surface, l_i that to the nearest landmark. The logarithm
// (Cauchy's loss) lets markers that sit off the skin, or at no landmark, have next to no say; the
// scale's prior keeps the cloud from shrinking into a dimple. `at_landmarks`: with the second sum.
CloudFit RefineCloudAlignment(const FaceSurface& surface, std::span<const Eigen::Vector3d> cloud_mm,
                              const Sim3d& start, const CloudModel& model, bool at_landmarks);

}  // namespace articap
