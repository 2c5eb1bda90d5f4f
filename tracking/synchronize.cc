// SPDX-License-Identifier: MIT
#include "tracking/synchronize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/check.h"
#include "core/statistics.h"

namespace articap {
namespace {

// Shifts below this part of a frame are none: a dot that is fast makes 0.05 px in them.
constexpr double kNoShift_frames = 0.005;

// By dot of a picture: the same dot of the next one, or -1. Both must be nearest to one another,
// and nearer than half of the way to the next dot.
std::vector<int> LinkDots(const std::vector<Dot>& from, const std::vector<Dot>& to) {
  constexpr double kFarthest_px = 40;
  const auto nearest = [](const std::vector<Dot>& dots, const Eigen::Vector2d& point, int except) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < static_cast<int>(dots.size()); ++i) {
      const double distance = (dots[i].center_px - point).norm();
      if (i == except || distance >= least) continue;
      least = distance;
      best = i;
    }
    return std::pair(best, least);
  };
  std::vector<int> links(from.size(), -1);
  for (int i = 0; i < static_cast<int>(from.size()); ++i) {
    const auto [match, distance] = nearest(to, from[i].center_px, -1);
    if (match < 0 || distance > kFarthest_px) continue;
    const double spacing = nearest(from, from[i].center_px, i).second;
    if (distance < spacing / 2 && nearest(from, to[match].center_px, -1).first == i)
      links[i] = match;
  }
  return links;
}

// A dot with the time at which it was seen.
struct TimedDot {
  double time_s;
  const Dot* dot;
};

// Lagrange's polynomial through the samples, at a time.
Dot Interpolate(const std::vector<TimedDot>& samples, double time_s) {
  Dot result = *samples[0].dot;
  result.center_px.setZero();
  result.covariance_px2.setZero();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double weight = 1;
    for (std::size_t k = 0; k < samples.size(); ++k)
      if (k != i) weight *= (time_s - samples[k].time_s) / (samples[i].time_s - samples[k].time_s);
    result.center_px += weight * samples[i].dot->center_px;
    result.covariance_px2 += weight * weight * samples[i].dot->covariance_px2;
  }
  return result;
}

// One camera's video, asked for its dots at any time.
class CameraDots {
 public:
  CameraDots(const DotVideo& video, double offset_s, double row_time_s)
      : video_(video), row_time_s_(row_time_s) {
    for (const DotPicture& picture : video.pictures)
      times_s_.push_back(SecondsOf(picture.time) + offset_s);
    for (std::size_t i = 0; i + 1 < video.pictures.size(); ++i)
      links_.push_back(LinkDots(video.pictures[i].dots, video.pictures[i + 1].dots));
    MeasureSpeed();
  }

  const std::vector<double>& times_s() const { return times_s_; }

  // `shift_s` grows to the largest that was bridged.
  std::vector<Dot> At(double time_s, double& shift_s) const {
    std::vector<Dot> dots;
    const std::optional<int> nearest = NearestPicture(time_s);
    if (!nearest) return dots;
    for (int i = 0; i < static_cast<int>(video_.pictures[*nearest].dots.size()); ++i)
      dots.push_back(DotAt(*nearest, i, time_s, shift_s));
    return dots;
  }

 private:
  double TimeOf_s(int picture, const Dot& dot) const {
    return times_s_[picture] + row_time_s_ * (dot.center_px.y() - (video_.height - 1) / 2.0);
  }

  // No farther than a frame away: what was not filmed is not seen.
  std::optional<int> NearestPicture(double time_s) const {
    const auto after = std::lower_bound(times_s_.begin(), times_s_.end(), time_s);
    int best = -1;
    for (const auto at : {after, after == times_s_.begin() ? after : after - 1}) {
      if (at == times_s_.end()) continue;
      const int picture = static_cast<int>(at - times_s_.begin());
      if (best < 0 || std::abs(*at - time_s) < std::abs(times_s_[best] - time_s)) best = picture;
    }
    if (best < 0 || std::abs(times_s_[best] - time_s) * video_.rate_hz > 1) return std::nullopt;
    return best;
  }

  Dot DotAt(int picture, int index, double time_s, double& shift_s) const {
    const Dot& dot = video_.pictures[picture].dots[index];
    const double shift = time_s - TimeOf_s(picture, dot);
    if (std::abs(shift) * video_.rate_hz < kNoShift_frames) return dot;
    shift_s = std::max(shift_s, std::abs(shift));
    const std::vector<TimedDot> samples = SamplesAround(picture, index, shift > 0);
    if (samples.size() > 1) return Interpolate(samples, time_s);
    Dot uncertain = dot;
    uncertain.covariance_px2 += std::pow(speed_px_s_ * shift, 2) * Eigen::Matrix2d::Identity();
    return uncertain;
  }

  // The dot, one neighbour in time on the side that it was left behind, and two on the other.
  std::vector<TimedDot> SamplesAround(int picture, int index, bool forwards) const {
    std::vector<TimedDot> samples = {Sample(picture, index)};
    const int before = forwards ? 1 : 2, after = forwards ? 2 : 1;
    int at = index;
    for (int step = 0; step < after && picture + step < static_cast<int>(links_.size()); ++step) {
      at = links_[picture + step][at];
      if (at < 0) break;
      samples.push_back(Sample(picture + step + 1, at));
    }
    at = index;
    for (int step = 1; step <= before && picture - step >= 0; ++step) {
      const std::vector<int>& links = links_[picture - step];
      const auto found = std::find(links.begin(), links.end(), at);
      if (found == links.end()) break;
      at = static_cast<int>(found - links.begin());
      samples.push_back(Sample(picture - step, at));
    }
    return samples;
  }
  TimedDot Sample(int picture, int index) const {
    const Dot& dot = video_.pictures[picture].dots[index];
    return {TimeOf_s(picture, dot), &dot};
  }

  void MeasureSpeed() {
    std::vector<double> speeds_px_s;
    for (std::size_t picture = 0; picture < links_.size(); ++picture)
      for (std::size_t i = 0; i < links_[picture].size(); ++i)
        if (links_[picture][i] >= 0)
          speeds_px_s.push_back((video_.pictures[picture + 1].dots[links_[picture][i]].center_px -
                                 video_.pictures[picture].dots[i].center_px)
                                    .norm() *
                                video_.rate_hz);
    if (!speeds_px_s.empty()) speed_px_s_ = MedianOf(std::move(speeds_px_s));
  }

  const DotVideo& video_;
  double row_time_s_;
  std::vector<double> times_s_;          // of the pictures, on the array's clock
  std::vector<std::vector<int>> links_;  // of each picture's dots to the next one's
  double speed_px_s_ = 0;                // the median
};

// The first camera's frames, or a grid of its rate.
std::vector<double> InstantsOf(const DotVideo& video, const std::vector<double>& times_s) {
  if (video.constant_rate || times_s.empty()) return times_s;
  std::vector<double> grid;
  const auto count =
      static_cast<int>((times_s.back() - times_s.front()) * video.rate_hz + 1e-6) + 1;
  for (int i = 0; i < count; ++i) grid.push_back(times_s.front() + i / video.rate_hz);
  return grid;
}

}  // namespace

void VisitOptions(SynchronizeOptions& options, OptionVisitor& visit) {
  visit("row_time_us", options.row_time_us,
        "from one row of a rolling shutter to the next; microseconds");
}

Result<void> CheckOptions(const SynchronizeOptions& options) {
  return RequireNotNegative({{"row_time_us", options.row_time_us}});
}

SynchronizedDots Synchronize(const CameraArray& array, const std::vector<DotVideo>& videos,
                             const SynchronizeOptions& options) {
  ARTICAP_CHECK_EQ(videos.size(), array.cameras.size());
  std::vector<CameraDots> cameras;
  cameras.reserve(videos.size());
  for (std::size_t camera = 0; camera < videos.size(); ++camera)
    cameras.emplace_back(videos[camera], array.cameras[camera].time_offset_s,
                         options.row_time_us * 1e-6);
  SynchronizedDots result;
  result.rate_hz = videos[0].rate_hz;
  const std::vector<double> instants_s = InstantsOf(videos[0], cameras[0].times_s());
  if (!instants_s.empty()) result.start = SessionTimeFromSeconds(instants_s.front());
  for (const double time_s : instants_s) {
    result.instants.emplace_back();
    for (const CameraDots& camera : cameras)
      result.instants.back().push_back(camera.At(time_s, result.largest_shift_s));
  }
  return result;
}

}  // namespace articap
