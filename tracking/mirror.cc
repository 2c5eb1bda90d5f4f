// SPDX-License-Identifier: MIT
#include "core/check.h"
#include "tracking/stabilize.h"

namespace articap {

StageTracks MirrorTracks(const StageTracks& tracks, int axis) {
  ARTICAP_CHECK(axis >= 0 && axis < 3);
  StageTracks mirrored = tracks;
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      if (tracks.is_missing(frame, marker)) continue;
      Eigen::Vector3d point_mm = tracks.position_mm(frame, marker);
      point_mm[axis] = -point_mm[axis];
      mirrored.Set(frame, marker, point_mm, tracks.state(frame, marker),
                   tracks.sigma_mm(frame, marker));
    }
  return mirrored;
}

}  // namespace articap
