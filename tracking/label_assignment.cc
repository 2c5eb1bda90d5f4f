// SPDX-License-Identifier: MIT
#include "tracking/label_assignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "tracking/assignment.h"

namespace articap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Beyond this many standard deviations a point is no candidate, whatever else there is.
constexpr double kFarthest_sigmas = 8;
// Of two labelled points that claim one dot, the dearer: marker index, or -1.
int FindContradiction(const LabelCosts& costs, std::span<const CloudPoint> cloud,
                      const std::vector<int>& points) {
  const int num_markers = static_cast<int>(points.size());
  for (int first = 0; first < num_markers; ++first) {
    if (points[first] < 0) continue;
    for (int second = first + 1; second < num_markers; ++second)
      if (points[second] >= 0 && ClaimOneDot(cloud[points[first]], cloud[points[second]]))
        return costs(first, points[first]) > costs(second, points[second]) ? first : second;
  }
  return -1;
}

// Of showing something, and to so many views, over showing nothing.
double PriorCost(const MarkerPriors& prior, bool by_one_view) {
  const double views = by_one_view ? prior.seen_by_one_view : 1 - prior.seen_by_one_view;
  return -2 * std::log(prior.seen * views / (1 - prior.seen));
}

struct Surprise {
  double squared_sigmas = 0;
  double cost = 0;  // twice the negative log of a normal density
};
Surprise SurpriseOf(const Eigen::Vector3d& apart, const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
  const double squared_sigmas = factor.matrixL().solve(apart).squaredNorm();
  const double log_determinant =
      2 * Eigen::Matrix3d(factor.matrixL()).diagonal().array().log().sum();
  return {squared_sigmas, squared_sigmas + log_determinant + 3 * std::log(2 * std::numbers::pi)};
}

constexpr double kSuddenVariance = 16;  // of a usual movement

// That a marker is so far from its place; nothing where it is too far, whatever else there is.
std::optional<double> CostOfMove(const Eigen::Vector3d& apart, const Eigen::Matrix3d& of_point,
                                 const Eigen::Matrix3d& of_place, double sudden) {
  const Eigen::Matrix3d usual = of_point + of_place;
  const Eigen::Matrix3d wide = sudden > 0 ? of_point + kSuddenVariance * of_place : usual;
  // The trace is no less than the variance in any direction.
  if (apart.squaredNorm() > kFarthest_sigmas * kFarthest_sigmas * wide.trace()) return std::nullopt;
  constexpr double kOrdinary = 6;  // squared sigmas: so near, nothing sudden has happened
  const Surprise expected = SurpriseOf(apart, usual);
  if (!(sudden > 0) || expected.squared_sigmas < kOrdinary) return expected.cost;
  const Surprise other = SurpriseOf(apart, wide);
  // Of the sum of both densities, from the greater one.
  const double first = expected.cost - 2 * std::log(1 - sudden);
  const double second = other.cost - 2 * std::log(sudden);
  const double least = std::min(first, second);
  return least - 2 * std::log1p(std::exp((least - std::max(first, second)) / 2));
}

// Whether two points of different views may well be one marker, of which a view shows too little to
// tell its middle: then they are no rivals.
bool MayBeOne(const CloudPoint& a, const CloudPoint& b) {
  for (const DotSight& sight : a.sights)
    for (const DotSight& other : b.sights)
      if (sight.view == other.view) return false;
  constexpr double kHidden_mm = 1, kSigmas = 3;
  const Eigen::Matrix3d covariance = CovarianceOf_mm2(a) + CovarianceOf_mm2(b) +
                                     kHidden_mm * kHidden_mm * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d apart = a.position_in_stage_mm - b.position_in_stage_mm;
  return !a.sights.empty() && !b.sights.empty() &&
         apart.dot(covariance.llt().solve(apart)) < kSigmas * kSigmas;
}

}  // namespace

std::vector<MarkerPlace> HomesOf(const MarkerTemplate& marker_template) {
  std::vector<MarkerPlace> homes;
  for (const TemplateMarker& marker : marker_template.markers)
    homes.push_back({marker.position_mm, marker.covariance_mm2()});
  return homes;
}

bool ClaimOneDot(const CloudPoint& a, const CloudPoint& b) {
  for (const DotSight& sight : a.sights)
    for (const DotSight& other : b.sights)
      if (sight.view.camera == other.view.camera && sight.dot == other.dot) return true;
  return false;
}

LabelCosts CostsOf(std::span<const MarkerPlace> markers, std::span<const CloudPoint> cloud,
                   const PoseEstimate& pose, const LabelPriors& priors) {
  LabelCosts costs;
  costs.setConstant(static_cast<int>(markers.size()), static_cast<int>(cloud.size()), kInfinity);
  for (int p = 0; p < static_cast<int>(cloud.size()); ++p) {
    const Eigen::Vector3d position = pose.template_from_stage * cloud[p].position_in_stage_mm;
    const std::size_t sights = cloud[p].sights.size();
    const double false_per_mm3 =
        std::max(sights == 2 ? priors.false_pairs : priors.false_points, 1e-3) / std::pow(300, 3);
    const Eigen::Matrix3d of_point = CovarianceInTemplate_mm2(cloud[p], pose.template_from_stage) +
                                     pose.CovarianceAt_mm2(position);
    for (int m = 0; m < static_cast<int>(markers.size()); ++m) {
      const auto cost = CostOfMove(position - markers[m].position_mm, of_point,
                                   markers[m].covariance_mm2, priors.sudden);
      if (cost)
        costs(m, p) = *cost + 2 * std::log(false_per_mm3) + PriorCost(priors.Of(m), sights == 1);
    }
  }
  return costs;
}

std::vector<int> AssignPoints(const LabelCosts& costs, std::span<const CloudPoint> cloud) {
  LabelCosts allowed = costs;
  while (true) {
    std::vector<int> points = Assign(allowed, 0);
    const int refused = FindContradiction(allowed, cloud, points);
    if (refused < 0) return points;
    allowed(refused, points[refused]) = kInfinity;
  }
}

double TotalCost(const LabelCosts& costs, const std::vector<int>& points) {
  double total = 0;
  for (int m = 0; m < static_cast<int>(points.size()); ++m)
    if (points[m] >= 0) total += costs(m, points[m]);
  return total;
}

std::vector<float> MarginsOf(const LabelCosts& costs, std::span<const CloudPoint> cloud,
                             const std::vector<int>& points) {
  // A point of dots that labelled points explain is no alternative.
  std::vector<char> explained(cloud.size(), 0);
  for (std::size_t p = 0; p < cloud.size(); ++p)
    explained[p] = std::any_of(points.begin(), points.end(), [&](int point) {
      return point >= 0 && (point == static_cast<int>(p) || ClaimOneDot(cloud[point], cloud[p]));
    });
  std::vector<float> margins(points.size(), std::numeric_limits<float>::quiet_NaN());
  for (int m = 0; m < static_cast<int>(points.size()); ++m) {
    if (points[m] < 0) continue;
    const double own = costs(m, points[m]);
    double least = -own;
    for (int p = 0; p < costs.cols(); ++p)
      if (!explained[p] && !MayBeOne(cloud[points[m]], cloud[p]))
        least = std::min(least, costs(m, p) - own);
    for (int other = 0; other < static_cast<int>(points.size()); ++other) {
      if (other == m) continue;
      const double before = points[other] < 0 ? 0 : costs(other, points[other]);
      const double after =
          costs(other, points[m]) + (points[other] < 0 ? 0 : costs(m, points[other]));
      least = std::min(least, after - before - own);
    }
    margins[m] = static_cast<float>(least / 2);
  }
  return margins;
}

MarkerPlace PlaceOf(const MarkerPlace& marker, const CloudPoint& point,
                    const Rigid3d& template_from_stage) {
  const Eigen::Matrix3d& expected = marker.covariance_mm2;
  // expected (expected + measured)^-1, both symmetric.
  const Eigen::Matrix3d gain = (expected + CovarianceInTemplate_mm2(point, template_from_stage))
                                   .llt()
                                   .solve(expected)
                                   .transpose();
  const Eigen::Vector3d apart =
      template_from_stage * point.position_in_stage_mm - marker.position_mm;
  return {marker.position_mm + gain * apart, expected - gain * expected};
}

void DropDoubtful(std::span<const CloudPoint> cloud, LabelledFrame& labelled) {
  constexpr float kLeastMargin = 2;
  for (std::size_t m = 0; m < labelled.points.size(); ++m)
    if (labelled.points[m] >= 0 && cloud[labelled.points[m]].sights.size() == 1 &&
        !(labelled.margins[m] > kLeastMargin)) {
      labelled.points[m] = -1;
      labelled.margins[m] = std::numeric_limits<float>::quiet_NaN();
    }
}

void AddPlaces(std::span<const CloudPoint> cloud, LabelledFrame& labelled) {
  if (!labelled.template_from_stage) return;
  for (std::size_t m = 0; m < labelled.points.size(); ++m)
    if (labelled.points[m] >= 0)
      labelled.places[m] =
          PlaceOf(labelled.places[m], cloud[labelled.points[m]], *labelled.template_from_stage);
}

}  // namespace articap
