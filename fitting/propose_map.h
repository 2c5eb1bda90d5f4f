// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/marker_set.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"
#include "core/tracks.h"
#include "rig/face_rig.h"

namespace articap {

struct ProposeMapOptions {
  // Of the stage frame, "+y", "-x", ...; up empty: both +y and +z are tried; forward (where the
  // speaker looks, to some 35 degrees) empty: every heading is tried.
  std::string up;
  std::string forward;
  // A marker this near to a landmark, once the rig's identity is fitted, sits at it; somewhat
  // farther off it sits beside it. mm of the rig.
  double landmark_reach_mm = 10;
};
void VisitOptions(ProposeMapOptions& options, OptionVisitor& visit);

// A marker map for a take whose marker names say nothing: their shape with the mouth shut is laid
// on the rig's face (AlignCloudToRig), each marker gets the nearest landmark that no nearer marker
// takes, or only the region of the skin it lies on, and roles by where it sits and how much it
// moves. What it cannot tell is whether the recording is mirrored: faces look the same in a mirror.
Result<StageResult<MarkerSet>> ProposeMap(const StageTracks& reference, const std::string& name,
                                          const FaceRig& rig, const ProposeMapOptions& options);

// The proposed map as TOML, under comments that ask for a check and say what each marker's place
// rests on.
std::string WriteMapProposal(const StageResult<MarkerSet>& proposal);

}  // namespace articap
