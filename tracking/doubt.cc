// SPDX-License-Identifier: MIT
#include "tracking/doubt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "core/statistics.h"

namespace articap {
namespace {

// Times as bad as where looking begins, as a score.
double ScoreOf(double times) { return 1 + std::log2(times); }

double MedianResidual_px(const TakeReview& review) {
  std::vector<double> residuals_px;
  for (const MarkerReview& marker : review.markers)
    for (const float residual_px : marker.residuals_px)
      if (std::isfinite(residual_px)) residuals_px.push_back(residual_px);
  return MedianOf(std::move(residuals_px));
}

void AddResiduals(const TakeReview& review, const DoubtLimits& limits, std::vector<Doubt>& doubts) {
  const double usual_px = MedianResidual_px(review);
  for (std::size_t m = 0; m < review.markers.size(); ++m)
    for (int frame = 0; frame < review.num_frames; ++frame) {
      const double residual_px = review.markers[m].residuals_px[frame];
      if (!(residual_px > limits.residual * usual_px)) continue;
      doubts.push_back(
          {.kind = DoubtKind::kResidual,
           .frame = frame,
           .first = frame,
           .last = frame,
           .marker = static_cast<int>(m),
           .score = ScoreOf(residual_px / (limits.residual * usual_px)),
           .why = fmt::format("views disagree by {:.2f} px, usual {:.2f}", residual_px, usual_px)});
    }
}

void AddMargins(const TakeReview& review, const DoubtLimits& limits, std::vector<Doubt>& doubts) {
  for (std::size_t m = 0; m < review.markers.size(); ++m)
    for (int frame = 0; frame < review.num_frames; ++frame) {
      const double margin = review.markers[m].margins[frame];
      if (!(margin < limits.margin)) continue;
      doubts.push_back(
          {.kind = DoubtKind::kMargin,
           .frame = frame,
           .first = frame,
           .last = frame,
           .marker = static_cast<int>(m),
           .score = 1 + (limits.margin - margin) / limits.margin,
           .why = fmt::format("another label is nearly as likely, margin {:.1f}", margin)});
    }
}

bool IsUnseen(SampleOrigin origin) {
  return origin == SampleOrigin::kFilled || origin == SampleOrigin::kGap;
}

void AddFills(const TakeReview& review, const DoubtLimits& limits, std::vector<Doubt>& doubts) {
  for (std::size_t m = 0; m < review.markers.size(); ++m) {
    const std::vector<SampleOrigin>& origins = review.markers[m].origins;
    for (int first = 0; first < review.num_frames; ++first) {
      if (!IsUnseen(origins[first])) continue;
      int last = first;
      while (last + 1 < review.num_frames && IsUnseen(origins[last + 1])) ++last;
      const double unseen_s = (last - first + 1) / review.rate_hz;
      const int middle = (first + last) / 2;
      if (unseen_s > limits.unseen_s)
        doubts.push_back(
            {.kind = DoubtKind::kFill,
             .frame = middle,
             .first = first,
             .last = last,
             .marker = static_cast<int>(m),
             .score = ScoreOf(unseen_s / limits.unseen_s),
             .why = fmt::format("unseen for {:.2f} s, {}", unseen_s,
                                origins[middle] == SampleOrigin::kFilled ? "filled" : "a gap")});
      first = last;
    }
  }
}

// Where a marker was last seen before a frame, and where it is there; within the head.
struct Step {
  int marker;
  Eigen::Vector3d before_mm, now_mm;
};

std::optional<Eigen::Vector3d> PlaceInHead(const TakeReview& review, const Labelling& labelling,
                                           const StageTracks& tracks, int frame, int marker) {
  if (IsUnseen(review.markers[marker].origins[frame])) return std::nullopt;
  return *labelling.frames[frame].template_from_stage * tracks.position_mm(frame, marker);
}

// Of two that both moved: how much nearer to where they were they are if they exchange names, in
// squares of their distance; at most 2.
double GainOfExchange(const Step& a, const Step& b, double least_mm) {
  const double kept_mm2 =
      (a.now_mm - a.before_mm).squaredNorm() + (b.now_mm - b.before_mm).squaredNorm();
  const double exchanged_mm2 =
      (a.now_mm - b.before_mm).squaredNorm() + (b.now_mm - a.before_mm).squaredNorm();
  const double apart_mm2 = (a.before_mm - b.before_mm).squaredNorm();
  if (apart_mm2 < least_mm * least_mm) return 0;
  return std::min(2.0, (kept_mm2 - exchanged_mm2) / apart_mm2);
}

void AddSwapsAt(int frame, const std::vector<Step>& steps, const TakeReview& review,
                const DoubtLimits& limits, std::vector<Doubt>& doubts) {
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (std::size_t k = i + 1; k < steps.size(); ++k) {
      const double gain = GainOfExchange(steps[i], steps[k], limits.least_swap_mm);
      if (!(gain > 0)) continue;
      doubts.push_back(
          {.kind = DoubtKind::kSwap,
           .frame = frame,
           .first = frame,
           .last = frame,
           .marker = steps[i].marker,
           .other = steps[k].marker,
           .score = 1 + gain,
           .why = fmt::format("exchanged with {}?", review.markers[steps[k].marker].name)});
    }
}

void AddSwaps(const TakeReview& review, const Labelling& labelling, const StageTracks& tracks,
              const DoubtLimits& limits, std::vector<Doubt>& doubts) {
  struct Seen {
    int frame = -1;
    Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();
  };
  std::vector<Seen> last(review.markers.size());
  for (int frame = 0; frame < review.num_frames; ++frame) {
    std::vector<Step> steps;
    for (int m = 0; m < static_cast<int>(review.markers.size()); ++m) {
      const auto place_mm = PlaceInHead(review, labelling, tracks, frame, m);
      if (!place_mm) continue;
      if (last[m].frame >= 0 && frame - last[m].frame <= limits.swap_s * review.rate_hz)
        steps.push_back({m, last[m].place_mm, *place_mm});
      last[m] = {frame, *place_mm};
    }
    AddSwapsAt(frame, steps, review, limits, doubts);
  }
}

// Doubts of one kind about one marker in frames that nearly touch become one, the worst of them.
std::vector<Doubt> Merged(std::vector<Doubt> doubts, int touching_frames) {
  const auto subject = [](const Doubt& doubt) {
    return std::tuple(doubt.kind, doubt.marker, doubt.other);
  };
  std::sort(doubts.begin(), doubts.end(), [&](const Doubt& a, const Doubt& b) {
    return std::pair(subject(a), a.first) < std::pair(subject(b), b.first);
  });
  std::vector<Doubt> merged;
  for (const Doubt& doubt : doubts) {
    if (merged.empty() || subject(merged.back()) != subject(doubt) ||
        doubt.first - merged.back().last > touching_frames) {
      merged.push_back(doubt);
      continue;
    }
    const int first = merged.back().first, last = std::max(merged.back().last, doubt.last);
    if (doubt.score > merged.back().score) merged.back() = doubt;
    merged.back().first = first;
    merged.back().last = last;
  }
  return merged;
}

}  // namespace

std::vector<Doubt> DoubtsOf(const TakeReview& review, const Labelling& labelling,
                            const StageTracks& tracks, const DoubtLimits& limits) {
  std::vector<Doubt> doubts;
  AddSwaps(review, labelling, tracks, limits, doubts);
  AddMargins(review, limits, doubts);
  AddResiduals(review, limits, doubts);
  AddFills(review, limits, doubts);
  constexpr double kTouching_s = 0.1;
  doubts = Merged(std::move(doubts),
                  std::max(1, static_cast<int>(std::lround(kTouching_s * review.rate_hz))));
  std::stable_sort(doubts.begin(), doubts.end(),
                   [](const Doubt& a, const Doubt& b) { return a.score > b.score; });
  return doubts;
}

std::vector<Doubt> SpreadFirst(const std::vector<Doubt>& doubts, int count, int num_frames) {
  std::map<int, int> in_part;
  std::vector<std::pair<int, std::size_t>> ranked;  // within its part of the take, index
  for (std::size_t i = 0; i < doubts.size(); ++i)
    ranked.emplace_back(in_part[doubts[i].frame * count / std::max(1, num_frames)]++, i);
  std::sort(ranked.begin(), ranked.end());
  const auto end_of_chosen = ranked.begin() + std::min(count, static_cast<int>(ranked.size()));
  const auto came_before = [](const auto& a, const auto& b) { return a.second < b.second; };
  std::sort(ranked.begin(), end_of_chosen, came_before);
  std::sort(end_of_chosen, ranked.end(), came_before);
  std::vector<Doubt> spread;
  for (const auto& [rank, index] : ranked) spread.push_back(doubts[index]);
  return spread;
}

}  // namespace articap
