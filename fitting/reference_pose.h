// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "core/binding.h"
#include "core/head_shape.h"
#include "core/marker_set.h"
#include "core/result.h"
#include "core/tracks.h"

namespace articap {

// Distance between two markers of a set, by their landmarks, in every frame: NaN where one is
// missing.
std::vector<double> LandmarkDistances(const HeadTracks& tracks, const MarkerSet& set,
                                      const std::string& landmark_a, const std::string& landmark_b);

// The window of frames, `num_frames` long, or shorter where the take is or the mouth is not closed
// so long, that looks most like Beskow's reference pose: lips closed, jaw relaxed, face at rest.
// Lips: distance of upper_lip_center to lower_lip_center; jaw: chin to nose_bridge or nose_tip;
// relaxed: near to where the face markers usually are while lips and jaw are closed. Fails where
// the set has none of these landmarks.
Result<FrameRange> ProposeReferenceFrames(const HeadTracks& tracks, const MarkerSet& set,
                                          int num_frames);

// Every marker's mean position over the frames in which it was seen, mm, head frame. Markers seen
// in less than half of the frames are left out and named.
struct AveragedPose {
  HeadShape pose;
  std::vector<std::string> left_out;
  double largest_sd_mm = 0;  // of the markers' positions over the frames: was the face at rest?
};
AveragedPose AverageFrames(const HeadTracks& tracks, const FrameRange& frames);

}  // namespace articap
