// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "tracking/pixel_reader.h"
#include "tracking/simd_level.h"

namespace articap {

// Pixels of a row that stand out, from begin_x up to, but without, end_x.
struct DotRun {
  int y = 0;
  int begin_x = 0;
  int end_x = 0;
  int peak_x = 0;      // the brightest
  float surround = 0;  // what that one stands out from
  float contrast = 0;  // by this
};

struct DotScanOptions {
  int step_y = 1;      // every so many rows are read
  int distance_x = 1;  // to what a pixel is compared with
  int distance_y = 1;  // a multiple of step_y
  double margin = 0;   // by which it has to be brighter, part of the full range
  // And by this many standard deviations of the noise of what it is compared with.
  double margin_sigma = 0;
  PixelNoise noise;
  int most_runs = 1000;
};

// Finds what is brighter than at least three of the pixels at a distance to its left, right, above
// and below; outside the picture all is dark. A dot in the open is brighter than all four; one of
// them may be lost to a neighbour. On an edge two at least are as bright, on a slope one is
// brighter and two alike, and within something large all are: such a threshold follows any
// background, and needs no memory of pictures or of rows further away.
class DotScanner {
 public:
  explicit DotScanner(SimdLevel level = BestSimdLevel()) : level_(level) {}

  SimdLevel level() const { return level_; }
  // Runs from top to bottom, from left to right. The picture's rows are read once each. What hangs
  // together only by pixels below half of its contrast is separate runs, so that a dot does not
  // become one with a shimmer beside it. False: there are more than options.most_runs; those found
  // last are missing.
  bool Scan(const PixelReader& reader, const DotScanOptions& options, std::vector<DotRun>& runs);

 private:
  template <class Integer>
  bool ScanRows(const PixelReader& reader, const DotScanOptions& options,
                std::vector<DotRun>& runs);
  static bool Cut(const PixelReader& reader, const DotScanOptions& options, const DotRun& run,
                  std::vector<DotRun>& runs);

  SimdLevel level_;
  std::vector<DotRun> marked_;       // as the comparison leaves them
  std::vector<std::uint16_t> rows_;  // the last ones that are still compared with
};

}  // namespace articap
