// SPDX-License-Identifier: MIT
#include "calib/mirror_matching.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/statistics.h"

namespace articap {
namespace {

// The bands between dots that hold one in few of the frames at most, the widest first.
std::vector<PictureBand> FreeBands(const DotVideo& video, double step_px) {
  constexpr double kFew = 0.1;  // of the frames
  std::vector<int> dots(static_cast<std::size_t>(video.width / step_px) + 1, 0);
  for (const DotPicture& picture : video.pictures)
    for (const Dot& dot : picture.dots) {
      const double bin =
          std::clamp(dot.center_px.x() / step_px, 0.0, static_cast<double>(dots.size()) - 1);
      ++dots[static_cast<std::size_t>(bin)];
    }
  const double few = kFew * static_cast<double>(video.pictures.size());
  std::vector<PictureBand> bands;
  int last = -1;  // bin with dots
  for (int bin = 0; bin < static_cast<int>(dots.size()); ++bin) {
    if (dots[bin] <= few) continue;
    if (last >= 0 && bin > last + 1) bands.push_back({(last + 1) * step_px, bin * step_px});
    last = bin;
  }
  std::sort(bands.begin(), bands.end(),
            [](const PictureBand& a, const PictureBand& b) { return a.width_px() > b.width_px(); });
  return bands;
}

// 0 where there are no dots.
double MedianDiameter_px(const DotVideo& video) {
  std::vector<double> diameters_px;
  for (const DotPicture& picture : video.pictures)
    for (const Dot& dot : picture.dots) diameters_px.push_back(dot.diameter_px());
  return diameters_px.empty() ? 0 : MedianOf(std::move(diameters_px));
}

Eigen::Vector3d RayOf(const Eigen::Vector2d& from_middle_px, double focal_px) {
  return (from_middle_px / focal_px).homogeneous();
}

// By direct dot: the nearest mirrored one, and the other way round; -1 for none within the gate.
struct Nearest {
  std::vector<int> of_direct, of_mirrored;
};

Nearest NearestOf(const SplitFrame& frame, const Eigen::Vector3d& normal, double focal_px,
                  double gate_px) {
  Nearest nearest = {std::vector<int>(frame.direct_px.size(), -1),
                     std::vector<int>(frame.mirrored_px.size(), -1)};
  std::vector<double> of_direct_px(frame.direct_px.size(), gate_px);
  std::vector<double> of_mirrored_px(frame.mirrored_px.size(), gate_px);
  for (int i = 0; i < static_cast<int>(frame.direct_px.size()); ++i)
    for (int k = 0; k < static_cast<int>(frame.mirrored_px.size()); ++k) {
      const double distance_px = std::abs(
          SampsonDistance_px<double>(RayOf(frame.direct_px[i], focal_px),
                                     RayOf(frame.mirrored_px[k], focal_px), normal, focal_px));
      if (distance_px < of_direct_px[i]) {
        of_direct_px[i] = distance_px;
        nearest.of_direct[i] = k;
      }
      if (distance_px < of_mirrored_px[k]) {
        of_mirrored_px[k] = distance_px;
        nearest.of_mirrored[k] = i;
      }
    }
  return nearest;
}

}  // namespace

Result<PictureBand> BandBesideMirror(const DotVideo& video) {
  constexpr double kLeastDiameters = 3, kClearly = 1.5;
  const double diameter_px = MedianDiameter_px(video);
  const std::vector<PictureBand> bands =
      diameter_px > 0 ? FreeBands(video, diameter_px) : std::vector<PictureBand>();
  const double widest_px = bands.empty() ? 0 : bands[0].width_px();
  const double next_px = bands.size() < 2 ? 0 : bands[1].width_px();
  if (bands.empty() || widest_px < kLeastDiameters * diameter_px || widest_px < kClearly * next_px)
    return Fail(fmt::format(
        "the dots do not show where the face ends and the mirror begins: the widest free bands "
        "between them are {:.0f} and {:.0f} px; is there a mirror in the picture, and are its dots "
        "found?",
        widest_px, next_px));
  return bands[0];
}

std::vector<SplitFrame> SplitFrames(const DotVideo& video, const CameraArray& array, int most) {
  const Eigen::Vector2d middle_px((video.width - 1) / 2.0, (video.height - 1) / 2.0);
  std::vector<SplitFrame> all;
  for (const DotPicture& picture : video.pictures) {
    SplitFrame frame;
    for (const Dot& dot : picture.dots) {
      if (array.MayShow({0, 0}, dot.center_px)) {
        frame.mirrored_px.emplace_back(dot.center_px - middle_px);
      } else if (array.MayShow({0, -1}, dot.center_px)) {
        frame.direct_px.emplace_back(dot.center_px - middle_px);
        frame.direct.push_back(&dot);
      }
    }
    if (frame.direct_px.size() >= 2 && frame.mirrored_px.size() >= 2)
      all.push_back(std::move(frame));
  }
  std::vector<SplitFrame> frames;
  const std::size_t step = all.size() / static_cast<std::size_t>(most) + 1;
  for (std::size_t i = 0; i < all.size(); i += step) frames.push_back(std::move(all[i]));
  return frames;
}

std::vector<MatchedDot> MatchMirrored(std::span<const SplitFrame> frames,
                                      const NominalParameters& parameters, double side,
                                      double gate_px) {
  const Eigen::Vector3d normal = NominalNormal(parameters.data(), side);
  const double focal_px = std::exp(parameters[kLogFocal]);
  std::vector<MatchedDot> matched;
  for (int f = 0; f < static_cast<int>(frames.size()); ++f) {
    const Nearest nearest = NearestOf(frames[f], normal, focal_px, gate_px);
    for (int i = 0; i < static_cast<int>(nearest.of_direct.size()); ++i) {
      const int k = nearest.of_direct[i];
      if (k >= 0 && nearest.of_mirrored[k] == i) matched.push_back({f, i, k});
    }
  }
  return matched;
}

}  // namespace articap
