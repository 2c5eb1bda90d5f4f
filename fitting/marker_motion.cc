// SPDX-License-Identifier: MIT
#include "fitting/marker_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

Shape AverageOverFrames(const StageTracks& tracks, const std::vector<int>& frames,
                        const Shape& shape) {
  const auto num_markers = shape.points_mm.size();
  Shape mean{std::vector<Eigen::Vector3d>(num_markers, Eigen::Vector3d::Zero()),
             std::vector<double>(num_markers, 0), std::vector<int>(num_markers, 0)};
  std::vector<Eigen::Vector3d> squares(num_markers, Eigen::Vector3d::Zero());
  for (const int frame : frames) {
    const auto points = tracks.positions_mm(frame);
    std::vector<double> weights(num_markers, 0);
    int num_pairs = 0;
    for (std::size_t m = 0; m < num_markers; ++m) {
      if (!points[m].allFinite() || !shape.points_mm[m].allFinite()) continue;
      weights[m] = 1 / (shape.variances_mm2[m] + kStill_mm * kStill_mm);
      ++num_pairs;
    }
    if (num_pairs < 3) continue;
    const Rigid3d shape_from_frame = AlignRigid(points, shape.points_mm, weights);
    for (std::size_t m = 0; m < num_markers; ++m) {
      if (!points[m].allFinite()) continue;
      const Eigen::Vector3d moved = shape_from_frame * points[m];
      mean.points_mm[m] += moved;
      squares[m] += moved.cwiseAbs2();
      ++mean.num_seen[m];
    }
  }
  for (std::size_t m = 0; m < num_markers; ++m) {
    if (mean.num_seen[m] == 0) {
      mean.points_mm[m].setConstant(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    mean.points_mm[m] /= mean.num_seen[m];
    const Eigen::Vector3d variance = squares[m] / mean.num_seen[m] - mean.points_mm[m].cwiseAbs2();
    mean.variances_mm2[m] = std::max(0.0, variance.sum());
  }
  return mean;
}

}  // namespace

MarkerMotion MeasureMarkerMotion(const StageTracks& tracks, int max_frames) {
  MarkerMotion motion;
  if (tracks.num_frames() == 0 || tracks.num_markers() == 0) return motion;
  const std::vector<int> frames = SpreadFrames(tracks.num_frames(), max_frames);
  Shape shape = FirstShape(tracks, frames);
  for (int i = 0; i < kIterations; ++i) shape = AverageOverFrames(tracks, frames, shape);
  for (int m = 0; m < tracks.num_markers(); ++m) {
    const std::string& name = tracks.names()[m];
    if (2 * shape.num_seen[m] < static_cast<int>(frames.size()) || shape.num_seen[m] == 0)
      motion.left_out.push_back(name);
    else
      motion.markers.push_back({name, shape.points_mm[m], std::sqrt(shape.variances_mm2[m])});
  }
  return motion;
}

}  // namespace articap
