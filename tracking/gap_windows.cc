// SPDX-License-Identifier: MIT
#include "tracking/gap_windows.h"

#include <algorithm>
#include <bit>

#include "core/check.h"
#include "tracking/rigidity.h"

namespace articap {

std::vector<Gap> FindGaps(const StageTracks& tracks) {
  std::vector<Gap> gaps;
  for (int marker = 0; marker < tracks.num_markers(); ++marker)
    for (int frame = 0; frame < tracks.num_frames(); ++frame) {
      if (!tracks.is_missing(frame, marker)) continue;
      Gap gap{marker, frame, 0};
      while (frame < tracks.num_frames() && tracks.is_missing(frame, marker)) ++frame;
      gap.length = frame - gap.first;
      if (gap.length < tracks.num_frames()) gaps.push_back(gap);
    }
  std::ranges::sort(gaps, [](const Gap& a, const Gap& b) {
    return std::tie(a.length, a.first, a.marker) < std::tie(b.length, b.first, b.marker);
  });
  return gaps;
}

Knowledge::Knowledge(const StageTracks& tracks)
    : gap_lengths_(tracks.num_frames(), tracks.num_markers()) {
  for (int marker = 0; marker < tracks.num_markers(); ++marker)
    for (int frame = 0; frame < tracks.num_frames(); ++frame)
      gap_lengths_(frame, marker) = tracks.is_missing(frame, marker) ? kUnknown : 0;
}

void Knowledge::SetFilled(const Gap& gap) {
  gap_lengths_.col(gap.marker).segment(gap.first, gap.length) = gap.length;
}

bool Knowledge::IsKnown(int marker, int first, int last, int longest_fill) const {
  return (gap_lengths_.col(marker).segment(first, last - first) <= longest_fill).all();
}

double Knowledge::PartKnown(int marker) const {
  return static_cast<double>((gap_lengths_.col(marker) < kUnknown).count()) /
         std::max(1, num_frames());
}

GapShape ShapeOf(const Gap& gap, const Knowledge& knowledge) {
  const int end = gap.first + gap.length;
  int before = 0;
  while (before < std::min(GapShape::kMostContext, gap.first) &&
         knowledge.IsKnown(gap.marker, gap.first - before - 1))
    ++before;
  int after = 0;
  while (after < std::min(GapShape::kMostContext, knowledge.num_frames() - end) &&
         knowledge.IsKnown(gap.marker, end + after))
    ++after;
  const auto rounded = [](int count) {
    return static_cast<int>(std::bit_floor(static_cast<unsigned>(count)));
  };
  return {gap.length, rounded(before), rounded(after)};
}

GapWindows MakeWindows(const Knowledge& knowledge, const GapShape& shape) {
  GapWindows windows{shape, {}, {}};
  const int num_places = knowledge.num_frames() - shape.length - shape.num_context() + 1;
  if (num_places <= 0) return windows;
  for (const int place : SpreadFrames(num_places, GapWindows::kMost))
    windows.firsts.push_back(place + shape.before);
  windows.known.resize(windows.size(), knowledge.num_markers());
  for (int window = 0; window < windows.size(); ++window)
    for (int marker = 0; marker < knowledge.num_markers(); ++marker)
      windows.known(window, marker) = knowledge.IsKnown(
          marker, windows.begin(window), windows.end(window), LongestFillFor(shape.length));
  return windows;
}

std::vector<int> ColumnsOf(const std::vector<int>& markers) {
  std::vector<int> columns;
  for (const int marker : markers)
    for (int i = 0; i < 3; ++i) columns.push_back(3 * marker + i);
  return columns;
}

Eigen::MatrixXd ContextOf(const Eigen::MatrixXd& series, int first, const GapShape& shape) {
  ARTICAP_CHECK_GE(first, shape.before);
  Eigen::MatrixXd context(shape.num_context(), series.cols());
  context.topRows(shape.before) = series.middleRows(first - shape.before, shape.before);
  context.bottomRows(shape.after) = series.middleRows(first + shape.length, shape.after);
  return context;
}

}  // namespace articap
