// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/point_cloud.h"
#include "core/transforms.h"
#include "tracking/label.h"

namespace articap {

// Where a marker is expected, in the frame of the template.
struct Expectation {
  Eigen::Vector3d position_mm;
  double sigma_mm;  // of a coordinate
};

// How unlikely it is, twice the negative log, that a point is what a marker shows, compared with
// its being false; and that the marker shows nothing.
struct LabelCosts {
  Eigen::MatrixXd costs;  // markers x points
  double null_cost;
};
// `pose_sigma_mm`: what the pose may be off, SD of a coordinate.
LabelCosts CostsOf(std::span<const Expectation> markers, std::span<const CloudPoint> cloud,
                   const Rigid3d& template_from_stage, double pose_sigma_mm,
                   const LabelOptions& options);

// Whether at most one of the two points can be right.
bool ClaimOneDot(const CloudPoint& a, const CloudPoint& b);

// By marker: its point, or -1. No two points of the result claim one dot.
std::vector<int> AssignPoints(const LabelCosts& costs, std::span<const CloudPoint> cloud);

// The sum of what the assignment costs; less is better.
double TotalCost(const LabelCosts& costs, const std::vector<int>& points);

// By marker: the least that any other explanation costs more, as a difference of log-likelihood:
// the marker shows another point or none, or exchanges its point with another marker.
std::vector<float> MarginsOf(const LabelCosts& costs, const std::vector<int>& points);

// template_from_stage from the labelled points, each weighted by how well its place is known.
// Nothing from fewer than three points, or from points on a line.
std::optional<Rigid3d> PoseOf(std::span<const Expectation> markers,
                              std::span<const CloudPoint> cloud, const std::vector<int>& points);

}  // namespace articap
