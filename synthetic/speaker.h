// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "core/binding.h"
#include "core/head_pose.h"
#include "core/marker_recording.h"
#include "core/marker_set.h"
#include "core/options.h"
#include "core/parameter_track.h"
#include "core/result.h"
#include "core/text_grid.h"
#include "core/virtual_marker.h"
#include "rig/face_rig.h"
#include "synthetic/head_motion.h"
#include "synthetic/speech.h"

namespace articap {

struct SyntheticTakeOptions {
  int seed = 1;
  SyntheticSpeechOptions speech;
  SyntheticHeadMotionOptions head;
  // Identity sliders of the speaker, "name=value"; sliders that are not named are random.
  std::vector<std::string> identity;
  double identity_spread = 0.3;  // SD of random sliders, as a fraction of their ranges
  double speaker_scale = 1;      // size of the speaker's head: mm of the speaker a mm of the rig
  double misplacement_mm = 0.5;  // how far beside its landmark a marker may be glued
  // The stage frame is the speaker's: origin where the middle of the head is on average, x to the
  // left, y up, z forward, as SyntheticCameras have it. Else that of a room with z up, in which the
  // speaker looks anywhere.
  bool speaker_ahead = false;
};
void VisitOptions(SyntheticTakeOptions& options, OptionVisitor& visit);

// A recording of somebody who never lived, with the truth about it. The head frame of the truth is
// the speaker's rig frame, scaled: x to the left, y up, z forward, origin between the ears.
struct SyntheticTake {
  MarkerRecording markers;  // stage frame; exact until AddNoise
  ParameterTrack truth;     // of the speaker's rig
  HeadPoseTrack true_pose;  // head_from_stage
  Sim3d rig_from_head;      // undoes speaker_scale
  std::string rig_name;
  std::vector<NamedValue> identity;
  std::vector<VirtualMarker> true_attachments;  // one a marker, on the speaker's own rig
  MarkerSet marker_set;
  TextGrid labels;
  std::vector<std::pair<std::string, std::string>> options;  // as used

  Eigen::VectorXd identity_values() const;
};

// A speaker with the given rig's shape and an identity of its own, wearing the markers of the set,
// says invented sentences while the head moves.
Result<SyntheticTake> SynthesizeTake(const FaceRig& rig, const MarkerSet& marker_set,
                                     const SyntheticTakeOptions& options);

}  // namespace articap
