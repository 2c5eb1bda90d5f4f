// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "calib/cost_functions/mirror_direction_cost.h"
#include "core/camera.h"
#include "core/dots.h"
#include "core/result.h"

namespace articap {

// Of the picture; kByRegion: where the mirror's region is drawn.
enum class MirrorSide : std::uint8_t { kByRegion, kLeft, kRight };

// A band of the picture from top to bottom, px.
struct PictureBand {
  double from_px = 0;
  double to_px = 0;

  double width_px() const { return to_px - from_px; }
};

// The widest band between dots that is as good as free of them all the time: between the face and
// its reflection. Refused where none is clearly the widest.
Result<PictureBand> BandBesideMirror(const DotVideo& video);

// The dots of a frame, from the middle of the picture, px.
struct SplitFrame {
  std::vector<Eigen::Vector2d> direct_px, mirrored_px;
  std::vector<const Dot*> direct;  // the same ones
};
// At most `most` frames, evenly spread over those that show two dots or more both ways, by the
// regions of the array's one camera and mirror.
std::vector<SplitFrame> SplitFrames(const DotVideo& video, const CameraArray& array, int most);

// A dot and its reflection.
struct MatchedDot {
  int frame = 0;  // of the split ones
  int direct = 0;
  int mirrored = 0;
};

using NominalParameters = std::array<double, kNumNominal>;

// Dots that are each other's nearest, as far as they lie in one plane with the mirror's normal to
// `gate_px`. `side` as for NominalNormal().
std::vector<MatchedDot> MatchMirrored(std::span<const SplitFrame> frames,
                                      const NominalParameters& parameters, double side,
                                      double gate_px);

}  // namespace articap
