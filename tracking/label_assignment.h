// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "core/transforms.h"
#include "tracking/label.h"
#include "tracking/marker_place.h"
#include "tracking/pose_estimate.h"

namespace articap {

// Where the template expects its markers while nothing else is known.
std::vector<MarkerPlace> HomesOf(const MarkerTemplate& marker_template);

// How unlikely it is, twice the negative log, that a point is what a marker shows, compared with
// its being false and with the marker's showing nothing: markers x points.
using LabelCosts = Eigen::MatrixXd;
struct MarkerPriors {
  double seen = 0.9;              // LabelOptions
  double seen_by_one_view = 0.1;  // part of what is seen
};
struct LabelPriors {
  MarkerPriors usual;
  double false_points = 2;                 // LabelOptions
  double false_pairs = 2;                  // of these, what two views see: rays meet by chance
  std::vector<MarkerPriors> markers = {};  // each by itself; empty: all are as usual
  // Part of a marker's frames in which it has moved four times as far as its place's covariance
  // says: lips are calm, and then they are quick.
  double sudden = 0;

  const MarkerPriors& Of(int marker) const { return markers.empty() ? usual : markers[marker]; }
};
LabelCosts CostsOf(std::span<const MarkerPlace> markers, std::span<const CloudPoint> cloud,
                   const PoseEstimate& pose, const LabelPriors& priors);

// Whether at most one of the two points can be right.
bool ClaimOneDot(const CloudPoint& a, const CloudPoint& b);

// By marker: its point, or -1. No two points of the result claim one dot.
std::vector<int> AssignPoints(const LabelCosts& costs, std::span<const CloudPoint> cloud);

// The sum of what the assignment costs; less is better.
double TotalCost(const LabelCosts& costs, const std::vector<int>& points);

// By marker: the least that any other explanation costs more, as a difference of log-likelihood:
// the marker shows another point, of other dots, or none, or exchanges its point with another
// marker.
std::vector<float> MarginsOf(const LabelCosts& costs, std::span<const CloudPoint> cloud,
                             const std::vector<int>& points);

// What is known of a marker's place in the template's frame once its point is known: what a single
// view sees is only somewhere on a ray, and where on it is still as expected. The gain of Kalman's
// filter.
MarkerPlace PlaceOf(const MarkerPlace& marker, const CloudPoint& point,
                    const Rigid3d& template_from_stage);

// Forgets labels of single sights that something else would explain nearly as well: such a dot is
// easily a neighbour's, or false, where the marker itself is hidden.
void DropDoubtful(std::span<const CloudPoint> cloud, LabelledFrame& labelled);
// Makes the places, where markers were expected, those where they are.
void AddPlaces(std::span<const CloudPoint> cloud, LabelledFrame& labelled);

}  // namespace articap
