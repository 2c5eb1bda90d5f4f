// SPDX-License-Identifier: MIT
#include "tracking/take_review.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/statistics.h"

namespace articap {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

SampleOrigin OriginOf(const CloudPoint* point, SampleState state) {
  if (state == SampleState::kMissing) return SampleOrigin::kGap;
  if (!point) return SampleOrigin::kFilled;
  if (point->sights.empty() && state == SampleState::kFilled) return SampleOrigin::kFilled;
  return point->sights.size() == 1 ? SampleOrigin::kOneView : SampleOrigin::kMeasured;
}

double RmsOf(const std::vector<float>& values) {
  double sum = 0;
  int count = 0;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    sum += static_cast<double>(value) * value;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNaN;
}

// By frame: mean square of the second differences of the coordinates there; NaN at the edges of
// what is measured.
std::vector<double> SquaredSecondDifferences(const StageTracks& tracks, int marker,
                                             const std::vector<SampleOrigin>& origins) {
  std::vector<double> squares_mm2(origins.size(), kNaN);
  for (std::size_t k = 1; k + 1 < origins.size(); ++k) {
    const auto is_measured = [&](std::size_t frame) {
      return origins[frame] == SampleOrigin::kMeasured;
    };
    if (!is_measured(k - 1) || !is_measured(k) || !is_measured(k + 1)) continue;
    const auto frame = static_cast<int>(k);
    squares_mm2[k] = (tracks.position_mm(frame - 1, marker) -
                      2 * tracks.position_mm(frame, marker) + tracks.position_mm(frame + 1, marker))
                         .squaredNorm() /
                     3;
  }
  return squares_mm2;
}

double JitterAtRest_mm(const StageTracks& tracks, int marker,
                       const std::vector<SampleOrigin>& origins) {
  constexpr double kVarianceOfSecondDifferences = 6;
  const std::vector<double> squares_mm2 = SquaredSecondDifferences(tracks, marker, origins);
  const int second = std::max(3, static_cast<int>(std::lround(tracks.rate_hz())));
  double least_mm2 = std::numeric_limits<double>::infinity(), sum_mm2 = 0;
  int in_a_row = 0;
  for (std::size_t k = 0; k < squares_mm2.size(); ++k) {
    if (std::isnan(squares_mm2[k])) {
      in_a_row = 0;
      sum_mm2 = 0;
      continue;
    }
    sum_mm2 += squares_mm2[k];
    if (++in_a_row > second) sum_mm2 -= squares_mm2[k - static_cast<std::size_t>(second)];
    if (in_a_row >= second) least_mm2 = std::min(least_mm2, std::max(0.0, sum_mm2) / second);
  }
  return std::isinf(least_mm2) ? kNaN : std::sqrt(least_mm2 / kVarianceOfSecondDifferences);
}

void CountGaps(const PointClouds& clouds, const Labelling& labelling, int marker,
               MarkerReview& review) {
  int gap = 0;
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    gap = LabelledPoint(clouds, labelling, frame, marker) ? 0 : gap + 1;
    if (gap == 1) ++review.gaps;
    review.longest_gap = std::max(review.longest_gap, gap);
  }
}

void SummarizeMargins(MarkerReview& review) {
  std::vector<double> known;
  review.lowest_margin = kNaN;
  for (std::size_t frame = 0; frame < review.margins.size(); ++frame) {
    const float margin = review.margins[frame];
    if (std::isnan(margin)) continue;
    known.push_back(margin);
    if (review.lowest_margin_frame >= 0 && !(margin < review.lowest_margin)) continue;
    review.lowest_margin = margin;
    review.lowest_margin_frame = static_cast<int>(frame);
  }
  review.median_margin = MedianOf(std::move(known));
}

MarkerReview ReviewMarker(const PointClouds& clouds, const Labelling& labelling,
                          const StageTracks& tracks, int marker, const CameraArray& array) {
  MarkerReview review;
  review.name = tracks.names()[marker];
  review.seen_by_view.assign(array.views().size(), 0);
  std::vector<float> residuals_mm;
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    const CloudPoint* point = LabelledPoint(clouds, labelling, frame, marker);
    review.origins.push_back(OriginOf(point, tracks.state(frame, marker)));
    review.margins.push_back(point ? labelling.frames[frame].margins[marker] : kNaN);
    const bool has_residual = point && point->sights.size() > 1;
    review.residuals_px.push_back(has_residual ? static_cast<float>(point->residual_px) : kNaN);
    residuals_mm.push_back(has_residual ? static_cast<float>(point->residual_mm) : kNaN);
    if (!point) continue;
    for (const DotSight& sight : point->sights)
      review.seen_by_view[array.IndexOf(sight.view)] += 1.0 / clouds.num_frames();
  }
  review.filled = static_cast<int>(
      std::count(review.origins.begin(), review.origins.end(), SampleOrigin::kFilled));
  CountGaps(clouds, labelling, marker, review);
  SummarizeMargins(review);
  review.residual_rms_px = RmsOf(review.residuals_px);
  review.residual_rms_mm = RmsOf(residuals_mm);
  review.jitter_at_rest_mm = JitterAtRest_mm(tracks, marker, review.origins);
  return review;
}

void Count(double coordinate_px, SubPixelHistogram::Axis& axis) {
  const double phase = coordinate_px + 0.5 - std::floor(coordinate_px + 0.5);
  ++axis.counts[std::min(SubPixelHistogram::kBins - 1,
                         static_cast<int>(phase * SubPixelHistogram::kBins))];
}

std::vector<SubPixelHistogram> SubPixelOf(
    const PointClouds& clouds, const Labelling& labelling, const CameraArray& array,
    const std::vector<std::vector<std::vector<Dot>>>& instants) {
  std::vector<SubPixelHistogram> histograms(array.views().size());
  for (int frame = 0; frame < clouds.num_frames(); ++frame)
    for (std::size_t m = 0; m < labelling.frames[frame].points.size(); ++m) {
      const CloudPoint* point = LabelledPoint(clouds, labelling, frame, static_cast<int>(m));
      if (!point) continue;
      for (const DotSight& sight : point->sights) {
        SubPixelHistogram& histogram = histograms[array.IndexOf(sight.view)];
        const Dot& dot = instants[frame][sight.view.camera][sight.dot];
        Count(dot.center_px.x(), histogram.x);
        Count(dot.center_px.y(), histogram.y);
        ++histogram.num_dots;
      }
    }
  return histograms;
}

double MeanOf(const std::vector<int>& counts) {
  double sum = 0;
  for (const int count : counts) sum += count;
  return sum / static_cast<double>(counts.size());
}

}  // namespace

double MarkerReview::ShareOf(SampleOrigin origin) const {
  if (origins.empty()) return 0;
  return static_cast<double>(std::count(origins.begin(), origins.end(), origin)) /
         static_cast<double>(origins.size());
}

double SubPixelHistogram::Axis::PeakToMean() const {
  return *std::max_element(counts.begin(), counts.end()) / MeanOf(counts);
}

double SubPixelHistogram::Axis::ChiSquare() const {
  const double expected = MeanOf(counts);
  double sum = 0;
  for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

TakeReview ReviewOf(const PointClouds& clouds, const Labelling& labelling,
                    const MarkerRecording& recording, const CameraArray& array,
                    const std::vector<std::vector<std::vector<Dot>>>& instants) {
  ARTICAP_CHECK_EQ(recording.tracks.num_frames(), clouds.num_frames());
  TakeReview review = {clouds.rate_hz, clouds.first_frame, clouds.num_frames(), {}, {}, {}};
  for (const View& view : array.views()) review.views.push_back(array.NameOf(view));
  for (int marker = 0; marker < recording.tracks.num_markers(); ++marker)
    review.markers.push_back(ReviewMarker(clouds, labelling, recording.tracks, marker, array));
  review.sub_pixel = SubPixelOf(clouds, labelling, array, instants);
  return review;
}

TakeReview ReviewOf(const PointClouds& clouds, const Labelling& labelling,
                    const MarkerRecording& recording) {
  return ReviewOf(clouds, labelling, recording, CameraArray{}, {});
}

}  // namespace articap
