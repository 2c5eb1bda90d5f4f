// SPDX-License-Identifier: MIT
#include "fitting/reference_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/statistics.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A distance counts as that of a closed mouth up to its 5th percentile plus this part of its
// spread, or this many mm where it hardly varies.
constexpr double kClosedPart = 0.15;
constexpr double kClosedMargin_mm = 1.5;

// The shortest window that is averaged, frames.
constexpr int kShortestWindow = 8;

struct Spread {
  double low = 0, high = 0;  // 5th and 95th percentile
};

Spread SpreadOf(const std::vector<double>& values) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return std::isfinite(value); });
  if (sorted.empty()) return {};
  std::sort(sorted.begin(), sorted.end());
  const auto percentile = [&](double part) {
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  };
  return {percentile(0.05), percentile(0.95)};
}

// 0 at the low end of the spread, 1 at the high end; 1 where not known. A spread below half a
// millimetre is noise, not movement.
std::vector<double> OverSpread(std::vector<double> values) {
  const Spread spread = SpreadOf(values);
  const double range = std::max(0.5, spread.high - spread.low);
  for (double& value : values) value = std::isfinite(value) ? (value - spread.low) / range : 1;
  return values;
}

// Frames in which none of the distances is that of an open mouth.
std::vector<bool> ClosedFrames(const std::vector<std::vector<double>>& distances) {
  std::vector<bool> closed(distances.front().size(), true);
  for (const std::vector<double>& distance : distances) {
    const Spread spread = SpreadOf(distance);
    const double most =
        spread.low + std::max(kClosedMargin_mm, kClosedPart * (spread.high - spread.low));
    for (std::size_t frame = 0; frame < closed.size(); ++frame)
      if (distance[frame] > most) closed[frame] = false;
  }
  return closed;
}

// Root mean square distance of the face markers from their medians over the frames marked. Mouths
// are closed for many reasons (pressed lips, a jaw pushed forward); the relaxed one is the usual
// one.
std::vector<double> DistancesFromUsual(const HeadTracks& tracks, const MarkerSet& set,
                                       const std::vector<bool>& usual) {
  std::vector<double> squares(tracks.num_frames(), 0.0);
  std::vector<int> counts(tracks.num_frames(), 0);
  for (int marker = 0; marker < tracks.num_markers(); ++marker) {
    const MarkerRole* const role = set.Find(tracks.names()[marker]);
    if (role == nullptr || !role->face) continue;
    Eigen::Vector3d median;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (int frame = 0; frame < tracks.num_frames(); ++frame)
        if (usual[frame] && !tracks.is_missing(frame, marker))
          values.push_back(tracks.position_mm(frame, marker)[axis]);
      median[axis] = MedianOf(std::move(values));
    }
    if (!median.allFinite()) continue;
    for (int frame = 0; frame < tracks.num_frames(); ++frame)
      if (!tracks.is_missing(frame, marker)) {
        squares[frame] += (tracks.position_mm(frame, marker) - median).squaredNorm();
        ++counts[frame];
      }
  }
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    squares[frame] = counts[frame] == 0 ? kNaN : std::sqrt(squares[frame] / counts[frame]);
  return squares;
}

// How much the face moves from frame to frame: mean speed of the face markers, mm per frame.
std::vector<double> Speeds(const HeadTracks& tracks, const MarkerSet& set) {
  std::vector<double> speeds(tracks.num_frames(), kNaN);
  for (int frame = 1; frame < tracks.num_frames(); ++frame) {
    double sum = 0;
    int count = 0;
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      const MarkerRole* const role = set.Find(tracks.names()[marker]);
      if (role == nullptr || !role->face) continue;
      if (tracks.is_missing(frame, marker) || tracks.is_missing(frame - 1, marker)) continue;
      sum += (tracks.position_mm(frame, marker) - tracks.position_mm(frame - 1, marker)).norm();
      ++count;
    }
    if (count > 0) speeds[frame] = sum / count;
  }
  return speeds;
}

// Where the window of that length with the least sum of scores begins.
int BestWindow(const std::vector<double>& score, int length) {
  const int num_frames = static_cast<int>(score.size());
  double sum = 0;
  for (int frame = 0; frame < length; ++frame) sum += score[frame];
  double best = sum;
  int best_start = 0;
  for (int start = 1; start + length <= num_frames; ++start) {
    sum += score[start + length - 1] - score[start - 1];
    if (sum < best) {
      best = sum;
      best_start = start;
    }
  }
  return best_start;
}

bool HasAny(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

struct RobustMean {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double sd_mm = 0;
};

// Mean and standard deviation of the positions that lie within three times the median distance from
// the median: all of them but outliers, for normal noise in three dimensions goes further once in
// 10,000 samples.
RobustMean RobustMeanOf(const std::vector<Eigen::Vector3d>& positions) {
  Eigen::Vector3d median;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const Eigen::Vector3d& position : positions) coordinates.push_back(position[axis]);
    median[axis] = MedianOf(std::move(coordinates));
  }
  std::vector<double> distances;
  for (const Eigen::Vector3d& position : positions) distances.push_back((position - median).norm());
  const double most = 3 * MedianOf(distances);
  RobustMean mean;
  double sum_of_squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (distances[i] > most) continue;
    mean.position += positions[i] - median;
    sum_of_squares += distances[i] * distances[i];
    ++count;
  }
  mean.position /= count;
  mean.sd_mm = std::sqrt(std::max(0.0, sum_of_squares / count - mean.position.squaredNorm()));
  mean.position += median;
  return mean;
}

}  // namespace

std::vector<double> LandmarkDistances(const HeadTracks& tracks, const MarkerSet& set,
                                      const std::string& landmark_a,
                                      const std::string& landmark_b) {
  std::vector<double> distances(tracks.num_frames(), kNaN);
  const MarkerRole* const role_a = set.FindAtLandmark(landmark_a);
  const MarkerRole* const role_b = set.FindAtLandmark(landmark_b);
  if (role_a == nullptr || role_b == nullptr) return distances;
  const auto a = tracks.Find(role_a->name), b = tracks.Find(role_b->name);
  if (!a || !b) return distances;
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    if (!tracks.is_missing(frame, *a) && !tracks.is_missing(frame, *b))
      distances[frame] = (tracks.position_mm(frame, *a) - tracks.position_mm(frame, *b)).norm();
  return distances;
}

Result<FrameRange> ProposeReferenceFrames(const HeadTracks& tracks, const MarkerSet& set,
                                          int num_frames) {
  const std::vector<double> lips =
      LandmarkDistances(tracks, set, "upper_lip_center", "lower_lip_center");
  std::vector<double> jaw = LandmarkDistances(tracks, set, "chin", "nose_bridge");
  if (!HasAny(jaw)) jaw = LandmarkDistances(tracks, set, "chin", "nose_tip");
  if (!HasAny(lips) && !HasAny(jaw))
    return Fail(
        "no reference frames can be proposed: the marker map names no markers at the landmarks "
        "upper_lip_center and lower_lip_center, nor chin and nose_bridge; give the frames with "
        "closed lips and relaxed jaw yourself (--frames A:B; --reference A:B in fit)");

  const std::vector<bool> closed = ClosedFrames({lips, jaw});
  const std::vector<double> usual = OverSpread(DistancesFromUsual(tracks, set, closed));
  const std::vector<double> open = OverSpread(lips), drop = OverSpread(jaw);
  const std::vector<double> speed = OverSpread(Speeds(tracks, set));
  std::vector<double> score(tracks.num_frames());
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    score[frame] = 4 * usual[frame] + open[frame] + drop[frame] + 4 * speed[frame];
  // A window must be of a closed mouth nearly throughout; where none so long is, half as long will
  // do.
  int length = std::min(num_frames, tracks.num_frames());
  int start = BestWindow(score, length);
  const auto is_closed = [&] {
    const auto first = closed.begin() + start;
    return 10 * std::count(first, first + length, true) >= 9 * length;
  };
  while (!is_closed() && length > kShortestWindow) {
    length = std::max(kShortestWindow, length / 2);
    start = BestWindow(score, length);
  }
  const int first = tracks.first_frame() + start;
  return FrameRange{first, first + length - 1};
}

AveragedPose AverageFrames(const HeadTracks& tracks, const FrameRange& frames) {
  AveragedPose averaged;
  for (int marker = 0; marker < tracks.num_markers(); ++marker) {
    std::vector<Eigen::Vector3d> seen;
    for (int number = frames.first; number <= frames.last; ++number)
      if (const int frame = number - tracks.first_frame(); !tracks.is_missing(frame, marker))
        seen.push_back(tracks.position_mm(frame, marker));
    const std::string& name = tracks.names()[marker];
    if (seen.empty() || 2 * static_cast<int>(seen.size()) < frames.size()) {
      averaged.left_out.push_back(name);
      continue;
    }
    const RobustMean mean = RobustMeanOf(seen);
    averaged.pose.points.push_back({name, mean.position});
    averaged.largest_sd_mm = std::max(averaged.largest_sd_mm, mean.sd_mm);
  }
  return averaged;
}

}  // namespace articap
