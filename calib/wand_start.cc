// SPDX-License-Identifier: MIT
#include "calib/wand_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "calib/camera_tree.h"
#include "calib/epipolar.h"
#include "calib/instants.h"
#include "core/statistics.h"
#include "core/triangulation.h"

namespace articap {
namespace {

// What each camera shows of an instant: the picture's index.
using InstantPictures = std::map<int, int>;  // camera -> picture
struct TimedPictures {
  double time_s = 0;
  InstantPictures pictures;
};

std::vector<TimedPictures> SharedOf(std::map<std::int64_t, TimedPictures>&& instants) {
  std::vector<TimedPictures> shared;
  for (auto& [number, at] : instants)
    if (at.pictures.size() >= 2) shared.push_back(std::move(at));
  return shared;
}

std::vector<TimedPictures> GroupByNumber(const std::vector<WandVideo>& videos) {
  std::map<std::int64_t, TimedPictures> instants;
  for (int camera = 0; camera < static_cast<int>(videos.size()); ++camera)
    for (int i = 0; i < static_cast<int>(videos[camera].pictures.size()); ++i) {
      const WandPicture& picture = videos[camera].pictures[i];
      if (picture.points_px.size() != 2) continue;
      TimedPictures& at = instants[picture.time.time_since_epoch().count()];
      at.time_s = SecondsOf(picture.time);
      at.pictures.try_emplace(camera, i);
    }
  return SharedOf(std::move(instants));
}

// Of the pictures with two markers; of a camera that takes several in one interval the nearest.
std::vector<TimedPictures> GroupByTime(const std::vector<WandVideo>& videos) {
  std::vector<std::vector<SessionTime>> times;
  std::vector<std::vector<int>> pictures;
  for (const WandVideo& video : videos) {
    times.emplace_back();
    pictures.emplace_back();
    for (int i = 0; i < static_cast<int>(video.pictures.size()); ++i)
      if (video.pictures[i].points_px.size() == 2) {
        times.back().push_back(video.pictures[i].time);
        pictures.back().push_back(i);
      }
  }
  std::map<std::int64_t, TimedPictures> instants;
  for (const auto& [key, instant] : InstantsByTime(times)) {
    TimedPictures& at = instants[instant.number];
    at.time_s = instant.time_s;
    const std::vector<WandPicture>& of_camera = videos[key.camera].pictures;
    const int picture = pictures[key.camera][key.sighting];
    const auto kept = at.pictures.try_emplace(key.camera, picture).first;
    if (std::abs(SecondsOf(of_camera[picture].time) - at.time_s) <
        std::abs(SecondsOf(of_camera[kept->second].time) - at.time_s))
      kept->second = picture;
  }
  return SharedOf(std::move(instants));
}

std::vector<TimedPictures> GroupByInstant(const std::vector<WandVideo>& videos) {
  return videos.front().has_times ? GroupByTime(videos) : GroupByNumber(videos);
}

class WandStart {
 public:
  WandStart(const std::vector<WandVideo>& videos, double length_mm)
      : videos_(videos), length_mm_(length_mm), instants_(GroupByInstant(videos)) {
    for (const WandVideo& video : videos)
      array_.cameras.push_back(
          {.name = video.camera, .width = video.width, .height = video.height, .lens = video.lens});
  }

  Result<WandNetwork> Run() {
    RelatePairs();
    if (const auto placed = PlaceCameras(); !placed) return tl::unexpected(placed.error());
    return BuildNetwork();
  }

 private:
  struct Edge {
    CameraPair pair;
    int views = 0;
  };

  const std::vector<Eigen::Vector2d>& PointsOf(int camera, const TimedPictures& instant) const {
    return videos_[camera].pictures[instant.pictures.at(camera)].points_px;
  }

  std::optional<std::array<Eigen::Vector3d, 2>> RaysOf(int camera,
                                                       const TimedPictures& instant) const {
    const auto& points = PointsOf(camera, instant);
    const auto a = Unproject(videos_[camera].lens, points[0]);
    const auto b = Unproject(videos_[camera].lens, points[1]);
    if (!a || !b) return std::nullopt;
    return std::array{*a, *b};
  }

  // How far the wand's middle moves in a camera's picture until the next instant, px.
  double SpeedOf_px(int camera, std::size_t index) const {
    if (index + 1 >= instants_.size() || !instants_[index + 1].pictures.contains(camera))
      return HUGE_VAL;
    const auto& now = PointsOf(camera, instants_[index]);
    const auto& next = PointsOf(camera, instants_[index + 1]);
    return (now[0] + now[1] - next[0] - next[1]).norm() / 2;
  }

  // Of the instants that both see, those in which the wand moves least, as the cameras may not be
  // synchronous.
  std::vector<std::size_t> SlowInstants(int first, int second) const {
    constexpr std::size_t kMost = 300;
    std::vector<std::pair<double, std::size_t>> by_speed;
    for (std::size_t i = 0; i < instants_.size(); ++i)
      if (instants_[i].pictures.contains(first) && instants_[i].pictures.contains(second))
        by_speed.emplace_back(SpeedOf_px(first, i), i);
    std::sort(by_speed.begin(), by_speed.end());
    by_speed.resize(
        std::min({kMost, by_speed.size(), std::max<std::size_t>(30, by_speed.size() / 2)}));
    std::vector<std::size_t> slow;
    for (const auto& [speed, index] : by_speed) slow.push_back(index);
    return slow;
  }

  // What a marker may be off its epipolar line comes of how far the wand moves between the two
  // cameras' exposures: the least that at least half of the views are within.
  std::optional<RelativePose> RelativePoseOf(const std::vector<PointPairView>& views,
                                             double focal_px) const {
    for (double rough_px : {3.0, 6.0, 12.0, 24.0}) {
      auto pose = FindRelativePose(views, rough_px / focal_px);
      if (pose && 2 * static_cast<std::size_t>(pose->num_inliers) >= views.size()) return pose;
    }
    return std::nullopt;
  }

  void RelatePairs() {
    const int count = static_cast<int>(videos_.size());
    for (int first = 0; first < count; ++first)
      for (int second = first + 1; second < count; ++second) {
        std::vector<PointPairView> views;
        for (std::size_t index : SlowInstants(first, second)) {
          const auto a = RaysOf(first, instants_[index]);
          const auto b = RaysOf(second, instants_[index]);
          if (a && b) views.push_back({*a, *b});
        }
        const double focal_px = (videos_[first].lens.fx_px + videos_[second].lens.fx_px) / 2;
        auto pose = RelativePoseOf(views, focal_px);
        if (!pose) continue;
        if (const auto scale = ScaleOf(views, *pose)) {
          pose->second_from_first.translation_mm *= *scale;
          edges_.push_back({{first, second, pose->second_from_first}, pose->num_inliers});
        }
      }
    std::stable_sort(edges_.begin(), edges_.end(),
                     [](const Edge& a, const Edge& b) { return a.views > b.views; });
  }

  // The median of what makes the wand as long as it is.
  std::optional<double> ScaleOf(const std::vector<PointPairView>& views,
                                const RelativePose& pose) const {
    CameraArray pair;
    pair.cameras.resize(2);
    for (Camera& camera : pair.cameras) camera.lens = {1, 1, 0, 0, {}};
    pair.cameras[1].cam_from_stage = pose.second_from_first;
    std::vector<double> scales;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (!pose.inlier[i]) continue;
      std::array<std::optional<TriangulatedPoint>, 2> ends;
      for (int end = 0; end < 2; ++end)
        ends[end] = Triangulate(
            pair, {{{0, -1}, views[i].first[end].head<2>()},
                   {{1, -1}, views[i].second[pose.swapped[i] ? 1 - end : end].head<2>()}});
      if (ends[0] && ends[1])
        scales.push_back(length_mm_ /
                         (ends[0]->point_in_stage_mm - ends[1]->point_in_stage_mm).norm());
    }
    if (scales.empty()) return std::nullopt;
    return MedianOf(std::move(scales));
  }

  Result<void> PlaceCameras() {
    std::vector<CameraPair> pairs;
    for (const Edge& edge : edges_) pairs.push_back(edge.pair);
    const std::vector<bool> placed = PlaceByPairs(pairs, array_.cameras);
    for (std::size_t i = 0; i < placed.size(); ++i)
      if (!placed[i])
        return Fail(fmt::format(
            "{}: cannot be linked with {}: they never see the wand together often enough, or their "
            "lenses or clocks are off by more than half a frame; wave the wand where both see it",
            videos_[i].camera, videos_[0].camera));
    return {};
  }

  // The ends of the wand by all cameras that see it: the first of them says which is which, the
  // others follow as their rays meet best.
  std::optional<WandInstant> PlaceWand(const TimedPictures& instant,
                                       std::vector<WandSighting>& sightings) const {
    std::array<std::vector<Sight>, 2> sights;
    std::optional<std::array<TriangulatedPoint, 2>> best;
    for (const auto& [camera, picture] : instant.pictures) {
      const auto& points = PointsOf(camera, instant);
      bool swapped = false;
      if (!sights[0].empty()) {
        std::array<std::optional<std::array<TriangulatedPoint, 2>>, 2> ways = {
            Meet(sights, camera, points[0], points[1]), Meet(sights, camera, points[1], points[0])};
        swapped = CostOf(ways[1]) < CostOf(ways[0]);
        best = ways[swapped ? 1 : 0];
        if (!best) return std::nullopt;
      }
      const WandPicture& seen = videos_[camera].pictures[picture];
      WandSighting& sighting = sightings.emplace_back();
      sighting.camera = camera;
      sighting.time_s = SecondsOf(seen.time);
      for (int end = 0; end < 2; ++end) {
        sighting.ends_px[end] = points[swapped ? 1 - end : end];
        sights[end].push_back({{camera, -1}, sighting.ends_px[end]});
      }
    }
    if (!best) return std::nullopt;
    return WandInstant{instant.time_s,
                       {(*best)[0].point_in_stage_mm, (*best)[1].point_in_stage_mm}};
  }

  std::optional<std::array<TriangulatedPoint, 2>> Meet(
      const std::array<std::vector<Sight>, 2>& sights, int camera, const Eigen::Vector2d& one,
      const Eigen::Vector2d& other) const {
    std::array<std::vector<Sight>, 2> more = sights;
    more[0].push_back({{camera, -1}, one});
    more[1].push_back({{camera, -1}, other});
    const auto a = Triangulate(array_, more[0]);
    const auto b = Triangulate(array_, more[1]);
    if (!a || !b) return std::nullopt;
    return std::array{*a, *b};
  }

  static double CostOf(const std::optional<std::array<TriangulatedPoint, 2>>& ends) {
    return ends ? std::hypot((*ends)[0].rms_px, (*ends)[1].rms_px) : HUGE_VAL;
  }

  WandNetwork BuildNetwork() const {
    WandNetwork network;
    network.array = array_;
    network.length_mm = length_mm_;
    for (const TimedPictures& at : instants_) {
      std::vector<WandSighting> sightings;
      auto instant = PlaceWand(at, sightings);
      if (!instant) continue;
      const double found_mm = (instant->ends_mm[0] - instant->ends_mm[1]).norm();
      // Other bright spots make other lengths.
      if (found_mm < 0.7 * length_mm_ || found_mm > 1.4 * length_mm_) continue;
      if (!network.instants.empty()) FollowEnds(network.instants.back(), *instant, sightings);
      for (WandSighting& sighting : sightings) {
        sighting.instant = static_cast<int>(network.instants.size());
        network.sightings.push_back(sighting);
      }
      network.instants.push_back(*instant);
    }
    return network;
  }

  static void FollowEnds(const WandInstant& before, WandInstant& now,
                         std::vector<WandSighting>& sightings) {
    const auto distance = [&](int first) {
      return (before.ends_mm[0] - now.ends_mm[first]).norm() +
             (before.ends_mm[1] - now.ends_mm[1 - first]).norm();
    };
    if (distance(0) <= distance(1)) return;
    std::swap(now.ends_mm[0], now.ends_mm[1]);
    for (WandSighting& sighting : sightings) std::swap(sighting.ends_px[0], sighting.ends_px[1]);
  }

  const std::vector<WandVideo>& videos_;
  double length_mm_;
  std::vector<TimedPictures> instants_;
  CameraArray array_;
  std::vector<Edge> edges_;
};

}  // namespace

Result<WandNetwork> StartWandNetwork(const std::vector<WandVideo>& videos, double length_mm) {
  return WandStart(videos, length_mm).Run();
}

void KeepSharedInstants(WandNetwork& network) {
  std::vector<int> views(network.instants.size(), 0);
  for (const WandSighting& sighting : network.sightings) ++views[sighting.instant];
  std::vector<int> now(network.instants.size(), -1);
  WandNetwork kept = network;
  kept.instants.clear();
  kept.sightings.clear();
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i] >= 2) {
      now[i] = static_cast<int>(kept.instants.size());
      kept.instants.push_back(network.instants[i]);
    }
  for (WandSighting sighting : network.sightings)
    if (now[sighting.instant] >= 0) {
      sighting.instant = now[sighting.instant];
      kept.sightings.push_back(sighting);
    }
  network = std::move(kept);
}

}  // namespace articap
