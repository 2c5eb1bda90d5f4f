// SPDX-License-Identifier: MIT
#include "apps/mirror_regions.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "calib/mirror_matching.h"
#include "core/view_regions.h"

namespace articap {
namespace {

// Dots of some frames that two views see as one marker, over as many as could be: all on the side
// with fewer of them.
double ShareOfMet(const CameraArray& array, const DotVideo& video,
                  const ReconstructOptions& options) {
  constexpr std::size_t kFrames = 40;
  ReconstructOptions used = options;
  constexpr double kWide_px = 1.5;
  used.match_px = options.match_px.value_or(kWide_px);
  const Reconstructor reconstruct(array, used);
  double met = 0, could_meet = 0;
  for (std::size_t i = 0; i < video.pictures.size(); i += video.pictures.size() / kFrames + 1) {
    const std::vector<Dot>& dots = video.pictures[i].dots;
    std::set<int> direct;
    for (const CloudPoint& point : reconstruct(std::vector<std::vector<Dot>>{dots}))
      for (const DotSight& sight : point.sights)
        if (sight.view.mirror < 0) direct.insert(sight.dot);
    met += static_cast<double>(direct.size());
    const auto mirrored = std::count_if(dots.begin(), dots.end(), [&](const Dot& dot) {
      return array.MayShow({0, 0}, dot.center_px);
    });
    could_meet +=
        static_cast<double>(std::min<std::ptrdiff_t>(mirrored, std::ssize(dots) - mirrored));
  }
  return could_meet > 0 ? met / could_meet : 0;
}

}  // namespace

std::vector<std::string> RegionsByDots(const CameraArray& array, const DotVideo& video,
                                       const ReconstructOptions& options) {
  constexpr double kLeastShare = 0.6;
  if (array.cameras.size() != 1 || array.mirrors.size() != 1) return {};
  if (array.cameras[0].region || array.mirrors[0].region) return {};
  const Eigen::Vector3d normal =
      array.cameras[0].cam_from_stage.rotation * array.mirrors[0].normal_in_stage;
  // Above or below the face it leaves no band beside.
  if (std::abs(normal.x()) < std::abs(normal.y())) return {};
  const Result<PictureBand> band = BandBesideMirror(video);
  if (!band) return {};
  const int from = static_cast<int>(std::ceil(band->from_px));
  const int to = static_cast<int>(std::floor(band->to_px));
  PictureRegion before = {0, 0, to, video.height};
  PictureRegion behind = {from, 0, video.width - from, video.height};
  if (normal.x() < 0) std::swap(before, behind);
  std::vector<std::string> regions = {array.NameOf({0, -1}) + "=" + FormatPictureRegion(before),
                                      array.NameOf({0, 0}) + "=" + FormatPictureRegion(behind)};
  CameraArray tried = array;
  if (!SetViewRegions(regions, tried) || ShareOfMet(tried, video, options) < kLeastShare) return {};
  return regions;
}

}  // namespace articap
