// SPDX-License-Identifier: MIT
#include "tracking/label_votes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tracking/label_assignment.h"

namespace articap {
namespace {

struct TrackletSample {
  int frame = 0;
  int point = 0;
};
using Tracklet = std::vector<TrackletSample>;

// Places of a frame's points within the head; far away for what a single view sees, whose place is
// not known.
std::vector<Eigen::Vector3d> PlacesOf(const PointClouds& clouds,
                                      const std::vector<LabelledFrame>& frames, int frame) {
  std::vector<Eigen::Vector3d> places;
  for (const CloudPoint& point : clouds.frames[frame])
    places.push_back(point.sights.size() == 1
                         ? Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())
                         : *frames[frame].template_from_stage * point.position_in_stage_mm);
  return places;
}

// The nearest of `places`, if it is near and no other is nearly as near; -1 otherwise.
int ClearlyNearest(const std::vector<Eigen::Vector3d>& places, const Eigen::Vector3d& place) {
  constexpr double kNear_mm = 10;
  constexpr double kClearly = 3;  // times nearer than the next
  int nearest = -1;
  double least_mm = kNear_mm, next_mm = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(places.size()); ++i) {
    const double distance_mm = (places[i] - place).norm();
    if (distance_mm < least_mm) {
      next_mm = nearest < 0 ? next_mm : least_mm;
      least_mm = distance_mm;
      nearest = i;
    } else {
      next_mm = std::min(next_mm, distance_mm);
    }
  }
  return next_mm > kClearly * least_mm ? nearest : -1;
}

// Neighbours in time that choose one another go on in one tracklet.
std::vector<Tracklet> MakeTracklets(const PointClouds& clouds,
                                    const std::vector<LabelledFrame>& frames) {
  std::vector<Tracklet> tracklets;
  std::vector<Eigen::Vector3d> before;
  std::vector<int> tracklet_of_before;
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    std::vector<Eigen::Vector3d> now;
    if (frames[frame].template_from_stage) now = PlacesOf(clouds, frames, frame);
    std::vector<int> tracklet_of_now(now.size(), -1);
    for (int i = 0; i < static_cast<int>(now.size()); ++i) {
      const int earlier = ClearlyNearest(before, now[i]);
      if (earlier >= 0 && ClearlyNearest(now, before[earlier]) == i) {
        tracklet_of_now[i] = tracklet_of_before[earlier];
      } else {
        tracklet_of_now[i] = static_cast<int>(tracklets.size());
        tracklets.emplace_back();
      }
      tracklets[tracklet_of_now[i]].push_back({frame, i});
    }
    before = std::move(now);
    tracklet_of_before = std::move(tracklet_of_now);
  }
  return tracklets;
}

// The label of a point in a frame; -1 for none.
int LabelOf(const LabelledFrame& frame, int point) {
  const auto found = std::find(frame.points.begin(), frame.points.end(), point);
  return found == frame.points.end() ? -1 : static_cast<int>(found - frame.points.begin());
}

// The label that a tracklet's samples agree on; -1 where they do not, or have none.
int VoteOf(const Tracklet& tracklet, const std::vector<LabelledFrame>& frames) {
  constexpr double kMostOfAMargin = 10;  // beyond which surer is not better
  constexpr double kMajority = 0.7;
  std::map<int, double> votes;
  double total = 0;
  for (const TrackletSample& sample : tracklet) {
    const int label = LabelOf(frames[sample.frame], sample.point);
    if (label < 0) continue;
    const double weight =
        std::clamp<double>(frames[sample.frame].margins[label], 0.1, kMostOfAMargin);
    votes[label] += weight;
    total += weight;
  }
  for (const auto& [label, weight] : votes)
    if (weight > kMajority * total) return label;
  return -1;
}

// Gives the points of a frame the labels they want. Of two that want the same, or that claim one
// dot, the one that changes nothing is right. How many samples changed.
int Relabel(const std::vector<CloudPoint>& cloud, const std::vector<int>& wanted,
            LabelledFrame& frame) {
  const std::vector<int> before = frame.points;
  std::fill(frame.points.begin(), frame.points.end(), -1);
  const auto is_taken = [&](int point) {
    return std::any_of(frame.points.begin(), frame.points.end(), [&](int other) {
      return other >= 0 && ClaimOneDot(cloud[other], cloud[point]);
    });
  };
  int changed = 0;
  for (const bool keeps : {true, false})
    for (int point = 0; point < static_cast<int>(wanted.size()); ++point) {
      const int label = wanted[point];
      if (label < 0 || (before[label] == point) != keeps) continue;
      if (frame.points[label] >= 0 || is_taken(point)) continue;
      frame.points[label] = point;
      if (!keeps) ++changed;
    }
  return changed;
}

}  // namespace

int RepairByVotes(const PointClouds& clouds, std::vector<LabelledFrame>& frames) {
  constexpr std::size_t kFewestSamples = 5;
  // By frame and point: what it is to be called.
  std::vector<std::vector<int>> wanted;
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    wanted.emplace_back(clouds.frames[frame].size(), -1);
    for (int m = 0; m < static_cast<int>(frames[frame].points.size()); ++m)
      if (frames[frame].points[m] >= 0) wanted.back()[frames[frame].points[m]] = m;
  }
  for (const Tracklet& tracklet : MakeTracklets(clouds, frames)) {
    const int vote = tracklet.size() < kFewestSamples ? -1 : VoteOf(tracklet, frames);
    if (vote < 0) continue;
    for (const TrackletSample& sample : tracklet) wanted[sample.frame][sample.point] = vote;
  }
  int repaired = 0;
  for (int frame = 0; frame < clouds.num_frames(); ++frame)
    repaired += Relabel(clouds.frames[frame], wanted[frame], frames[frame]);
  return repaired;
}

}  // namespace articap
