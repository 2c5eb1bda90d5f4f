// SPDX-License-Identifier: MIT
#include "fitting/spikes.h"

#include <algorithm>
#include <tuple>

namespace articap {
namespace {

constexpr double kLongestGap_s = 0.1;

// One marker's samples in the order of time, shrinking as spikes are taken out.
class MarkerCourse {
 public:
  MarkerCourse(const RigTracks& tracks, int marker, const SpikeLimits& limits)
      : tracks_(tracks), marker_(marker), limits_(limits) {
    for (int frame = 0; frame < tracks.num_frames(); ++frame)
      if (!tracks.is_missing(frame, marker)) seen_.push_back(frame);
  }

  // Takes out the spikes that are worse than their neighbours; returns their frames.
  std::vector<int> TakeOutWorst() {
    std::vector<double> excess(seen_.size(), 0.0);
    for (std::size_t i = 1; i + 1 < seen_.size(); ++i) excess[i] = ExcessOf(i);
    std::vector<int> spikes, kept;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const bool is_worst =
          excess[i] > 1 && excess[i] >= excess[i - 1] && excess[i] > excess[i + 1];
      (is_worst ? spikes : kept).push_back(seen_[i]);
    }
    seen_ = std::move(kept);
    return spikes;
  }

 private:
  // Distance from the line between the neighbours, over what is allowed; 0 where not judged.
  double ExcessOf(std::size_t i) const {
    const double before_s = (seen_[i] - seen_[i - 1]) / tracks_.rate_hz();
    const double after_s = (seen_[i + 1] - seen_[i]) / tracks_.rate_hz();
    if (before_s > kLongestGap_s || after_s > kLongestGap_s) return 0;
    const double part = before_s / (before_s + after_s);
    const Eigen::Vector3d expected = (1 - part) * tracks_.position_mm(seen_[i - 1], marker_) +
                                     part * tracks_.position_mm(seen_[i + 1], marker_);
    const double allowed_mm =
        limits_.noise_mm + 0.5 * limits_.max_acceleration_mm_s2 * before_s * after_s;
    return (tracks_.position_mm(seen_[i], marker_) - expected).norm() / allowed_mm;
  }

  const RigTracks& tracks_;
  int marker_;
  SpikeLimits limits_;
  std::vector<int> seen_;
};

}  // namespace

std::vector<Spike> FindSpikes(const RigTracks& tracks, const SpikeLimits& limits) {
  std::vector<Spike> spikes;
  for (int marker = 0; marker < tracks.num_markers(); ++marker) {
    MarkerCourse course(tracks, marker, limits);
    for (auto frames = course.TakeOutWorst(); !frames.empty(); frames = course.TakeOutWorst())
      for (const int frame : frames) spikes.push_back({frame, marker});
  }
  std::sort(spikes.begin(), spikes.end(), [](const Spike& a, const Spike& b) {
    return std::tie(a.frame, a.marker) < std::tie(b.frame, b.marker);
  });
  return spikes;
}

}  // namespace articap
