// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <tuple>
#include <vector>

#include "core/tracks.h"

namespace articap {

// A run of frames in which a marker is missing.
struct Gap {
  int marker = 0;
  int first = 0;   // frame
  int length = 0;  // frames
};

// All gaps of a take, the shortest first; of one length, by frame and marker. Markers that are
// never seen have none.
std::vector<Gap> FindGaps(const StageTracks& tracks);

// How far the samples of a take may be relied upon: those that were there, those that were filled
// (less the longer their gap), and those that are not known.
class Knowledge {
 public:
  explicit Knowledge(const StageTracks& tracks);

  void SetFilled(const Gap& gap);
  // Over all of the frames first ... last - 1: there, or filled in a gap of at most `longest_fill`.
  bool IsKnown(int marker, int first, int last, int longest_fill) const;
  bool IsKnown(int marker, int frame) const { return gap_lengths_(frame, marker) < kUnknown; }
  double PartKnown(int marker) const;

  int num_frames() const { return static_cast<int>(gap_lengths_.rows()); }
  int num_markers() const { return static_cast<int>(gap_lengths_.cols()); }

 private:
  static constexpr int kUnknown = 1 << 30;
  Eigen::ArrayXXi gap_lengths_;  // frames x markers; 0 where there
};

// A gap and the frames beside it that say where it begins and ends: `before` and `after`, 0 or a
// power of two each (so that few shapes need be learnt), at most kMostContext.
struct GapShape {
  static constexpr int kMostContext = 4;

  int length = 0;
  int before = 0;
  int after = 0;

  int num_context() const { return before + after; }
  bool operator==(const GapShape&) const = default;
  bool operator<(const GapShape& other) const {
    return std::tie(length, before, after) < std::tie(other.length, other.before, other.after);
  }
};
// As much as is known beside the gap.
GapShape ShapeOf(const Gap& gap, const Knowledge& knowledge);

// What is filled in gaps of at most this length serves as known to one of `length`.
inline int LongestFillFor(int length) { return length / 2; }

// Places in a take where a gap of one shape can be cut, to learn from: what surrounds it is known,
// and so is what is in it.
struct GapWindows {
  static constexpr int kMost = 300;

  GapShape shape;
  std::vector<int> firsts;                                   // first frame of the gap
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> known;  // windows x markers

  int size() const { return static_cast<int>(firsts.size()); }
  int begin(int window) const { return firsts[window] - shape.before; }
  int end(int window) const { return firsts[window] + shape.length + shape.after; }
};
// Spread evenly over the take.
GapWindows MakeWindows(const Knowledge& knowledge, const GapShape& shape);

// The three columns of each marker.
std::vector<int> ColumnsOf(const std::vector<int>& markers);

// The frames beside a gap, `before` rows and then `after`, of series that have a row a frame.
Eigen::MatrixXd ContextOf(const Eigen::MatrixXd& series, int first, const GapShape& shape);

}  // namespace articap
