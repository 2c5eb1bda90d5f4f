// SPDX-License-Identifier: MIT
#include "calib/view_screening.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "calib/robust.h"
#include "core/statistics.h"

namespace articap {
namespace {

// No view is bad that fits so well, however well the others do.
constexpr double kGood_px = 0.1;

// A view with fewer sightings is judged by all views': its own median would be one of the bad.
constexpr std::size_t kFewestOfView = 5;

struct Usual {
  double median_px = 0;
  double limit_px = 0;
  double sigma_px = 0;  // of one coordinate of a corner
};

Usual UsualOf(const std::vector<double>& rms_px, const ResidualLists& residuals_px) {
  const double median = MedianOf(rms_px);
  std::vector<double> deviations;
  for (double rms : rms_px) deviations.push_back(std::abs(rms - median));
  const double spread = 1.4826 * MedianOf(std::move(deviations));
  return {median, std::max({kGood_px, 3 * median, median + 6 * spread}),
          RobustSigmaOf(residuals_px)};
}

struct ViewResiduals {
  std::vector<double> rms_px;
  ResidualLists residuals_px;
};

std::vector<double> DistancesOf(const ResidualLists& residuals_px) {
  std::vector<double> distances;
  for (const auto& residuals : residuals_px)
    for (const Eigen::Vector2d& residual : residuals) distances.push_back(residual.norm());
  return distances;
}

}  // namespace

double MedianOf(const ResidualLists& residuals_px) { return MedianOf(DistancesOf(residuals_px)); }

double RobustSigmaOf(const ResidualLists& residuals_px) {
  return RobustSigmaOf(DistancesOf(residuals_px));
}

std::vector<BadSighting> ScreenSightings(const AdjustedNetwork& adjusted) {
  const auto& sightings = adjusted.network.sightings;
  const CameraArray& array = adjusted.network.array;
  std::map<int, ViewResiduals> of_views;
  std::vector<double> all_px;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    all_px.push_back(RmsOf(adjusted.residuals_px[i]));
    ViewResiduals& view = of_views[array.IndexOf(sightings[i].view)];
    view.rms_px.push_back(all_px.back());
    view.residuals_px.push_back(adjusted.residuals_px[i]);
  }
  std::map<int, Usual> usual_of_views;
  for (const auto& [view, own] : of_views)
    usual_of_views[view] = own.rms_px.size() < kFewestOfView
                               ? UsualOf(all_px, adjusted.residuals_px)
                               : UsualOf(own.rms_px, own.residuals_px);
  std::vector<BadSighting> bad;
  for (int i = 0; i < static_cast<int>(sightings.size()); ++i) {
    const Usual& usual = usual_of_views.at(array.IndexOf(sightings[i].view));
    if (!(all_px[i] <= usual.limit_px))
      bad.push_back({i, fmt::format("{:.2f} px RMS where the others have {:.2f}: {}", all_px[i],
                                    usual.median_px,
                                    DisplacedCorners(sightings[i].corners, adjusted.residuals_px[i],
                                                     usual.sigma_px))});
  }
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
