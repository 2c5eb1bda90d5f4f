// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/transforms.h"
#include "synthetic/studio.h"

namespace articap {

// Two bright balls on a thin dark rod. The wand frame: origin in the middle, x along the rod.
struct Wand {
  double length_mm = 200;  // from centre to centre
  double ball_radius_mm = 7;
  double rod_radius_mm = 1;

  std::array<Eigen::Vector3d, 2> CentersAt(const Rigid3d& stage_from_wand) const;
};

// The balls shine back at the camera, the rest of the room is nearly dark: how cameras with rings
// of infrared lamps see it.
Scene WandScene(const Studio& studio, const Wand& wand, const Rigid3d& stage_from_wand);

// The centres of the two balls in every view.
std::vector<ViewTruth> TruthOfWand(const Studio& studio, const Wand& wand,
                                   const Rigid3d& stage_from_wand);

// How somebody waves a wand around: through a box about a point of the stage, in all attitudes,
// smoothly. A function of time, so that cameras may look at different times.
class WandPath {
 public:
  explicit WandPath(std::uint64_t seed,
                    const Eigen::Vector3d& reach_mm = Eigen::Vector3d(70, 45, 80));

  Rigid3d StageFromWandAt(double time_s) const;

 private:
  struct Swing {
    double frequency_hz = 0;
    double phase_rad = 0;

    double At(double time_s) const;  // -1 to 1
  };

  Eigen::Vector3d reach_mm_;
  std::array<Swing, 6> swings_;  // for each axis of the place, and of the attitude
};

}  // namespace articap
