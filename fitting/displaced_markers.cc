// SPDX-License-Identifier: MIT
#include "fitting/displaced_markers.h"

#include <algorithm>

#include "core/statistics.h"

namespace articap {
namespace {

// Below this, a displacement is no worse than what gluing by eye repeats.
constexpr double kLeastDistanceMm = 2;
// Larger than this many times the median marker's: not the fit as a whole, but this marker.
constexpr double kTimesMedian = 3;
// Length of the mean residual over the mean length: 1 for a constant residual, 0 for noise.
constexpr double kLeastSteadiness = 0.8;

struct MeanResidual {
  double vector_mm = 0;  // length of the mean vector
  double length_mm = 0;  // mean of the lengths
};

MeanResidual MeanResidualOf(const ShapeFit& fit, int marker) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double lengths_mm = 0;
  int count = 0;
  for (int frame = 0; frame < fit.measured.num_frames(); ++frame) {
    if (fit.measured.is_missing(frame, marker) || fit.virtual_markers.is_missing(frame, marker))
      continue;
    const Eigen::Vector3d residual =
        fit.measured.position_mm(frame, marker) - fit.virtual_markers.position_mm(frame, marker);
    sum += residual;
    lengths_mm += residual.norm();
    ++count;
  }
  if (count == 0) return {};
  return {sum.norm() / count, lengths_mm / count};
}

}  // namespace

std::vector<DisplacedMarker> FindDisplacedMarkers(const ShapeFit& fit) {
  std::vector<MeanResidual> residuals;
  std::vector<double> lengths_mm;
  for (int marker = 0; marker < fit.measured.num_markers(); ++marker) {
    residuals.push_back(MeanResidualOf(fit, marker));
    lengths_mm.push_back(residuals.back().length_mm);
  }
  if (lengths_mm.empty()) return {};
  const double least_mm =
      std::max(kLeastDistanceMm, kTimesMedian * MedianOf(std::move(lengths_mm)));
  std::vector<DisplacedMarker> displaced;
  for (int marker = 0; marker < fit.measured.num_markers(); ++marker) {
    const MeanResidual& residual = residuals[static_cast<std::size_t>(marker)];
    if (residual.vector_mm > least_mm && residual.vector_mm > kLeastSteadiness * residual.length_mm)
      displaced.push_back({fit.measured.names()[marker], residual.vector_mm});
  }
  return displaced;
}

}  // namespace articap
