// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

// A dot of the face in one picture, directly and in the mirror.
struct DotPair {
  std::int64_t frame = 0;
  std::string marker;
  Eigen::Vector2d direct_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d mirrored_px = Eigen::Vector2d::Zero();
};

// CSV with the columns frame, marker, x_px, y_px, mirror_x_px, mirror_y_px. Rows that lack a view
// are passed over. Refused, with the line: what is no number, a dot that is there twice.
Result<std::vector<DotPair>> ParseDotPairs(const std::string& text, const std::string& source_name);
Result<std::vector<DotPair>> ReadDotPairs(const std::filesystem::path& path);

struct MirrorDotsOptions {
  // The distance between two of the dots, which stays the same, e.g. on spectacles.
  std::string length_from;
  std::string length_to;
  double length_mm = 0;
  double length_sigma_mm = 0.5;     // how well a ruler tells it
  double focal_sigma_percent = 3;   // how well the lens is known
  double max_normal_sigma_deg = 1;  // not usable beyond
};
void VisitOptions(MirrorDotsOptions& options, OptionVisitor& visit);

struct DotMirror {
  CameraArray array;  // one camera, one mirror; the stage frame is the camera's
  int pairs = 0;
  // Of a dot's two views from the line on which one says that the other is; px.
  double epipolar_sigma_px = 0;
  // The known length as it comes out, over the frames that show both of its dots.
  double length_sd_mm = 0;
  int lengths = 0;
};

// A plane mirror without any board, from dots seen directly and in it, one known length, and a lens
// that is known at least roughly. A dot, its image and the direction of the mirror's normal lie in
// one plane with the camera, which gives the normal; the length gives the scale. The standard
// deviations hold what the dots, the length and the lens leave open. Refused: too few dots, dots
// that do not determine the normal, a length between dots that are never seen together.
Result<StageResult<DotMirror>> CalibrateMirrorFromDots(const Camera& camera,
                                                       const std::vector<DotPair>& dots,
                                                       const MirrorDotsOptions& options);

}  // namespace articap
