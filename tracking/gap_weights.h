// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tracking/gap_windows.h"

namespace articap {

// Interpolation over a gap: each sample in it is a weighted sum of the samples beside it. The
// weights of each frame sum to one, so that it does not matter where the origin is.
struct GapWeights {
  Eigen::MatrixXd weights;  // frames of the gap x frames beside it
  // How the error grows with the distance from the edges: its RMS in each frame of the gap over
  // that of the whole gap. Empty where nothing was there to learn from.
  Eigen::VectorXd profile;
};

// The straight line between the frames next to the gap; the nearest frame where a side is missing.
Eigen::MatrixXd LinearWeights(const GapShape& shape);

// Cubic Hermite interpolation with the slopes of the last two frames on either side; linear where
// a side has one frame alone, constant where it has none.
GapWeights CubicWeights(const GapShape& shape);

// Least squares over windows in which the series, three columns a marker, are known: the best
// linear interpolation for movement like this. On quick and clean movement it comes out as a
// polynomial of high degree, on noisy movement as an average over the frames on either side, over
// long gaps as a straight line. Every column counts the same, whatever its scale. A slight ridge
// pulls towards linear interpolation. With fewer than kFewestSamplesAFrame samples for each of the
// frames beside the gap: CubicWeights.
//
// `column_markers` are those of the windows that each three columns belong to.
GapWeights LearnWeights(const GapWindows& windows, const Eigen::MatrixXd& series,
                        const std::vector<int>& column_markers);
inline constexpr int kFewestSamplesAFrame = 4;

}  // namespace articap
