// SPDX-License-Identifier: MIT
#include "tracking/stabilize.h"

namespace articap {

void VisitOptions(StabilizeOptions& options, OptionVisitor& visit) {
  visit.Enumeration("mode", options.mode, {"map", "rigid", "translation", "none"},
                    "how the head is factored out; map: as the marker map says");
  visit("head", options.head, "names of the reference markers, instead of the map's");
  visit("left", options.left, "axis of the data that points to the speaker's left, e.g. +x");
  visit("up", options.up, "axis of the data that points up, e.g. +y");
  visit("forward", options.forward, "axis of the data that the speaker looks along, e.g. +z");
  visit("max_rotation_sigma_deg", options.max_rotation_sigma_deg,
        "the pose of a frame is not known where its references determine an angle worse than this");
  visit("max_residual_mm", options.max_residual_mm,
        "frames whose references fit worse than this (RMS) are marked");
  visit("outlier_sigmas", options.outlier_sigmas,
        "a reference this many standard deviations from its place is an outlier of its frame");
  visit("smooth_pose", options.smooth_pose,
        "smooth the movement of the head as far as cross-validation finds it to be noise");
  visit("pose_cutoff_hz", options.pose_cutoff_hz,
        "smooth it to half of the amplitude at this frequency; 0: cross-validation chooses; Hz");
  visit("use_filled", options.use_filled, "may filled samples serve as references?");
  visit("shape_frames", options.shape_frames,
        "at most this many frames, spread over the take, make the reference shape");
  visit("shape_tolerance_mm", options.shape_tolerance_mm,
        "references further than this from their place in a given shape are named");
  visit("max_reference_motion_mm", options.max_reference_motion_mm,
        "references whose distance from other parts of the head changes more than this are named");
  visit("propose", options.propose, "look for a better set of references");
  visit("check_anatomy", options.check_anatomy,
        "refuse data that look mirrored, or contradict the anatomy of a face");
}

}  // namespace articap
