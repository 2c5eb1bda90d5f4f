// SPDX-License-Identifier: MIT
#include "calib/view_screening.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace articap {
namespace {

double Median(std::vector<double> values) {
  ARTICAP_CHECK(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The median of the distance of two Gaussian coordinates (Rayleigh's) over their sigma.
const double kRayleighMedian = std::sqrt(2 * std::log(2.0));

// No view is bad that fits so well, however well the others do.
constexpr double kGood_px = 0.1;

}  // namespace

double MedianOf(const ResidualLists& residuals_px) {
  std::vector<double> distances;
  for (const auto& residuals : residuals_px)
    for (const Eigen::Vector2d& residual : residuals) distances.push_back(residual.norm());
  return Median(std::move(distances));
}

double RobustSigmaOf(const ResidualLists& residuals_px) {
  return MedianOf(residuals_px) / kRayleighMedian;
}

std::vector<BadSighting> ScreenSightings(const AdjustedNetwork& adjusted) {
  std::vector<double> rms_px;
  for (const auto& residuals : adjusted.residuals_px) rms_px.push_back(RmsOf(residuals));
  const double median = Median(rms_px);
  std::vector<double> deviations;
  for (double rms : rms_px) deviations.push_back(std::abs(rms - median));
  const double spread = 1.4826 * Median(std::move(deviations));
  const double limit = std::max({kGood_px, 3 * median, median + 6 * spread});
  const double sigma_px = RobustSigmaOf(adjusted.residuals_px);
  std::vector<BadSighting> bad;
  for (int i = 0; i < static_cast<int>(rms_px.size()); ++i)
    if (!(rms_px[i] <= limit))
      bad.push_back(
          {i, fmt::format("{:.2f} px RMS where the others have {:.2f}: {}", rms_px[i], median,
                          DisplacedCorners(adjusted.network.sightings[i].corners,
                                           adjusted.residuals_px[i], sigma_px))});
  return bad;
}

std::string DisplacedCorners(const std::vector<int>& corners,
                             const std::vector<Eigen::Vector2d>& residuals_px, double sigma_px) {
  constexpr std::size_t kMostNamed = 8;
  std::vector<std::pair<double, int>> displaced;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (residuals_px[i].norm() > 6 * sigma_px)
      displaced.emplace_back(residuals_px[i].norm(), corners[i]);
  if (displaced.empty() || 2 * displaced.size() > corners.size())
    return "the whole board is off; is it flat, and was it still?";
  std::sort(displaced.rbegin(), displaced.rend());
  std::string text;
  for (std::size_t i = 0; i < std::min(kMostNamed, displaced.size()); ++i)
    text += fmt::format("{}corner {} by {:.1f} px", i == 0 ? "" : ", ", displaced[i].second,
                        displaced[i].first);
  if (displaced.size() > kMostNamed)
    text += fmt::format(" and {} more", displaced.size() - kMostNamed);
  return text;
}

}  // namespace articap
