// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/head_pose.h"
#include "core/head_shape.h"
#include "core/marker_set.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"
#include "core/tracks.h"

namespace articap {

enum class ModeChoice : std::uint8_t { kFromMap, kRigid, kTranslation, kNone };

struct StabilizeOptions {
  // How the head is factored out; the marker map says, unless this does.
  ModeChoice mode = ModeChoice::kFromMap;
  // Names of the reference markers, instead of those with the role head in the map.
  std::vector<std::string> head;
  // Axes of the data ("+x", "-z", ...), instead of those that the map declares: all three or none.
  std::string left;
  std::string up;
  std::string forward;
  // A frame's pose is not known where the references seen leave an angle of the head more uncertain
  // than this. 1.5 degrees are 3 mm at the chin.
  double max_rotation_sigma_deg = 1.5;
  // Frames whose references fit their shape worse than this (RMS) are marked.
  double max_residual_mm = 2;
  // A reference this many standard deviations from its place is an outlier of its frame. With noise
  // alone, one in a thousand lies beyond 4.
  double outlier_sigmas = 4;
  // Smooth the movement of the head as far as cross-validation finds it to be noise? See
  // tracking/pose_smoothing.h. Mode rigid only.
  bool smooth_pose = true;
  // Half of the amplitude remains at this frequency; 0: cross-validation chooses.
  double pose_cutoff_hz = 0;
  // May samples that gap filling made serve as references?
  bool use_filled = false;
  // At most this many frames, spread evenly over the take, make the reference shape.
  int shape_frames = 2000;
  // A given shape's references further from their places than this are named.
  double shape_tolerance_mm = 1;
  // References whose distance from still markers on other parts of the head changes by more than
  // this (10th to 90th percentile) are named as not rigid.
  double max_reference_motion_mm = 2.5;
  // Look for a better set of references, and propose it?
  bool propose = true;
  // Refuse data that look mirrored, or whose axes and names contradict the anatomy of a face?
  bool check_anatomy = true;
};
void VisitOptions(StabilizeOptions& options, OptionVisitor& visit);

// The marker map with what the options say instead of it: how, by which references, and the axes.
Result<MarkerSet> ChosenSet(const MarkerSet& set, const StabilizeOptions& options);

struct Stabilized {
  HeadPoseTrack head_pose;
  HeadTracks tracks;
  HeadShape head_shape;  // the references in the head frame; empty for the modes without
};

// Factors the movement of the head out of a take.
//  rigid        three or more references; every frame from all that are seen, robustly weighted
//               (tracking/frame_aligner.h). Their shape is estimated over the take (generalised
//               Procrustes), or given: its frame is then the head frame. Points of a given shape
//               that are no references, but sit on the skull or the nose by the map, are witnesses
//               by which spectacles that were re-seated on the face are found.
//  translation  one reference is the origin of the head frame; the rotation is declared identity,
//               but for the declared axes.
//  none         the data are in a head frame; only the declared axes are applied, as a constant
//               rotation.
// Frames with fewer than three references, or with references too near to a line, have no pose and
// no head tracks. See tracking/head_axes.h for the head's axes and its origin.
Result<StageResult<Stabilized>> Stabilize(const StageTracks& tracks, const MarkerSet& set,
                                          const std::optional<HeadShape>& given_shape,
                                          const StabilizeOptions& options = {});

// The mirror image: one coordinate (0: x) changes its sign. For data that were filmed through a
// mirror or written in a left-handed system, which no rotation makes a face of. Where the stage's
// axes are declared, they are those of the mirrored data.
StageTracks MirrorTracks(const StageTracks& tracks, int axis = 0);

}  // namespace articap
