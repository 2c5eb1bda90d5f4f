// SPDX-License-Identifier: MIT
#include "fitting/marker_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/alignment.h"

namespace articap {
namespace {

constexpr int kIterations = 15;
// Movement below this is noise, mm: markers that are stiller than that weigh the same.
constexpr double kStill_mm = 0.3;

std::vector<int> SpreadFrames(int num_frames, int max_frames) {
  std::vector<int> frames;
  const int count = std::min(num_frames, max_frames);
  for (int i = 0; i < count; ++i)
    frames.push_back(static_cast<int>(static_cast<long long>(i) * num_frames / count));
  return frames;
}

// The shape that frames are aligned to, marker by marker of the tracks.
struct Shape {
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<double> variances_mm2;
  std::vector<int> num_seen;
};

// The frame that shows most markers.
Shape FirstShape(const StageTracks& tracks, const std::vector<int>& frames) {
  int best = frames.front(), most = -1;
  for (const int frame : frames) {
    const auto states = tracks.states(frame);
    const int seen =
        tracks.num_markers() - static_cast<int>(std::ranges::count(states, SampleState::kMissing));
    if (seen > most) {
      most = seen;
      best = frame;
    }
  }
  Shape shape;
  const auto points = tracks.positions_mm(best);
  shape.points_mm.assign(points.begin(), points.end());
  shape.variances_mm2.assign(points.size(), 0);
  return shape;
}

// The transform that lays a frame on a shape; nothing where they share less than three markers.
std::optional<Rigid3d> ShapeFromFrame(std::span<const Eigen::Vector3d> points, const Shape& shape) {
  std::vector<double> weights(points.size(), 0);
  int num_pairs = 0;
  for (std::size_t m = 0; m < points.size(); ++m) {
    if (!points[m].allFinite() || !shape.points_mm[m].allFinite()) continue;
    weights[m] = 1 / (shape.variances_mm2[m] + kStill_mm * kStill_mm);
    ++num_pairs;
  }
  if (num_pairs < 3) return std::nullopt;
  return AlignRigid(points, shape.points_mm, weights);
}

Shape AverageOverFrames(const StageTracks& tracks, const std::vector<int>& frames,
                        const Shape& shape) {
  const auto num_markers = shape.points_mm.size();
  Shape mean{std::vector<Eigen::Vector3d>(num_markers, Eigen::Vector3d::Zero()),
             std::vector<double>(num_markers, 0), std::vector<int>(num_markers, 0)};
  for (const int frame : frames) {
    const auto points = tracks.positions_mm(frame);
    const auto shape_from_frame = ShapeFromFrame(points, shape);
    if (!shape_from_frame) continue;
    for (std::size_t m = 0; m < num_markers; ++m) {
      if (!points[m].allFinite()) continue;
      // Welford's update: the squares stay small wherever the stage's origin is.
      const Eigen::Vector3d moved = *shape_from_frame * points[m];
      const Eigen::Vector3d step = moved - mean.points_mm[m];
      mean.points_mm[m] += step / ++mean.num_seen[m];
      mean.variances_mm2[m] += step.dot(moved - mean.points_mm[m]);
    }
  }
  for (std::size_t m = 0; m < num_markers; ++m) {
    if (mean.num_seen[m] == 0)
      mean.points_mm[m].setConstant(std::numeric_limits<double>::quiet_NaN());
    else
      mean.variances_mm2[m] /= mean.num_seen[m];
  }
  return mean;
}

// How much farther from one another than in the mean shape the markers of a frame lie, mm.
double SpreadOfFrame(std::span<const Eigen::Vector3d> points, const Shape& mean) {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), mean_center = Eigen::Vector3d::Zero();
  int num_seen = 0;
  const auto is_seen = [&](std::size_t m) {
    return points[m].allFinite() && mean.points_mm[m].allFinite();
  };
  for (std::size_t m = 0; m < points.size(); ++m) {
    if (!is_seen(m)) continue;
    center += points[m];
    mean_center += mean.points_mm[m];
    ++num_seen;
  }
  if (num_seen == 0) return std::numeric_limits<double>::infinity();
  center /= num_seen;
  mean_center /= num_seen;
  double spread_mm = 0;
  for (std::size_t m = 0; m < points.size(); ++m)
    if (is_seen(m))
      spread_mm +=
          ((points[m] - center).norm() - (mean.points_mm[m] - mean_center).norm()) / num_seen;
  return spread_mm;
}

// The frames with the mouth shut: a fifth of all.
std::vector<int> CompactFrames(const StageTracks& tracks, const std::vector<int>& frames,
                               const Shape& mean) {
  std::vector<std::pair<double, int>> by_spread;
  for (const int frame : frames)
    by_spread.emplace_back(SpreadOfFrame(tracks.positions_mm(frame), mean), frame);
  std::ranges::sort(by_spread);
  by_spread.resize(std::max<std::size_t>(1, by_spread.size() / 5));
  std::vector<int> compact;
  for (const auto& [spread_mm, frame] : by_spread) compact.push_back(frame);
  return compact;
}

}  // namespace

MarkerMotion MeasureMarkerMotion(const StageTracks& tracks, int max_frames) {
  MarkerMotion motion;
  if (tracks.num_frames() == 0 || tracks.num_markers() == 0) return motion;
  const std::vector<int> frames = SpreadFrames(tracks.num_frames(), max_frames);
  Shape shape = FirstShape(tracks, frames);
  for (int i = 0; i < kIterations; ++i) shape = AverageOverFrames(tracks, frames, shape);
  const Shape shut = AverageOverFrames(tracks, CompactFrames(tracks, frames, shape), shape);
  for (int m = 0; m < tracks.num_markers(); ++m) {
    const std::string& name = tracks.names()[m];
    if (2 * shape.num_seen[m] < static_cast<int>(frames.size()) || shape.num_seen[m] == 0)
      motion.left_out.push_back(name);
    else
      motion.markers.push_back({name, shut.num_seen[m] > 0 ? shut.points_mm[m] : shape.points_mm[m],
                                std::sqrt(shape.variances_mm2[m])});
  }
  return motion;
}

}  // namespace articap
