// SPDX-License-Identifier: MIT
#include "synthetic/lip_gauge.h"

#include <array>
#include <limits>
#include <set>
#include <string_view>
#include <vector>

#include "core/check.h"

namespace articap {
namespace {

constexpr int kBisections = 48;      // from a whole range to double precision
constexpr double kMidlineMm = 1.5;   // vertices this near to the midplane count as the middle
constexpr double kTouchingMm = 0.1;  // lips this near touch

// Vertices of a region near the midplane.
std::vector<int> MiddleOf(const FaceRig& rig, std::string_view region_name) {
  std::set<int> vertices;
  const auto region = rig.FindRegion(region_name);
  const auto& triangles = rig.neutral_mesh().triangles;
  for (std::size_t i = 0; region && i < triangles.size(); ++i)
    if (rig.definition().triangle_region[i] == *region)
      for (const int vertex : triangles[i])
        if (std::abs(rig.neutral_mesh().vertices[vertex].x()) < kMidlineMm) vertices.insert(vertex);
  return {vertices.begin(), vertices.end()};
}

struct Seam {
  int upper, lower;
};

// Where the lips meet: the nearest two vertices of upper and lower lip, and of those that touch
// the foremost.
std::optional<Seam> FindSeam(const FaceRig& rig) {
  const std::vector<Eigen::Vector3d>& points = rig.neutral_mesh().vertices;
  double least_gap_mm = std::numeric_limits<double>::infinity();
  double foremost_mm = -std::numeric_limits<double>::infinity();
  std::optional<Seam> seam;
  for (const int upper : MiddleOf(rig, "upper_lip"))
    for (const int lower : MiddleOf(rig, "lower_lip")) {
      if (upper == lower) continue;
      const double gap_mm = std::max(kTouchingMm, (points[upper] - points[lower]).norm());
      const double front_mm = points[upper].z();
      if (gap_mm > least_gap_mm || (gap_mm == least_gap_mm && front_mm <= foremost_mm)) continue;
      least_gap_mm = gap_mm;
      foremost_mm = front_mm;
      seam = Seam{upper, lower};
    }
  return seam;
}

// A virtual marker at a vertex that has triangles.
VirtualMarker AtVertex(const FaceRig& rig, int vertex) {
  for (const Eigen::Vector3i& triangle : rig.neutral_mesh().triangles)
    for (int corner = 0; corner < 3; ++corner)
      if (triangle[corner] == vertex)
        return {"", {vertex, triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]}, 0, 0, 0};
  ARTICAP_CHECK(false);
  return {};
}

}  // namespace

std::optional<LipGauge> LipGauge::Create(const FaceRig& rig) {
  const auto seam = FindSeam(rig);
  if (!seam) return std::nullopt;
  return LipGauge(rig, AtVertex(rig, seam->upper), AtVertex(rig, seam->lower));
}

LipGauge::LipGauge(const FaceRig& rig, const VirtualMarker& upper, const VirtualMarker& lower)
    : evaluator_(rig, std::array{upper, lower}),
      ranges_(rig.definition().parameters),
      lower_lip_(rig.FindParameter("lower_lip_depression")),
      jaw_(rig.FindParameter("jaw_rotation")) {
  neutral_gap_mm_ = OpeningMm(Eigen::VectorXd::Zero(rig.num_parameters()));
}

double LipGauge::OpeningMm(const Eigen::VectorXd& parameters) const {
  const auto pose =
      evaluator_.PoseOf({parameters.data(), static_cast<std::size_t>(parameters.size())});
  return (evaluator_.Position(pose, 0) - evaluator_.Position(pose, 1)).y() - neutral_gap_mm_;
}

void LipGauge::SetOpening(double opening_mm, Eigen::VectorXd* parameters) const {
  if (lower_lip_) {
    const RigParameter& range = ranges_[*lower_lip_];
    SetOpeningBy(*lower_lip_, range.min, range.max, opening_mm, parameters);
  }
  constexpr double kReachedMm = 1e-6;
  if (jaw_ && std::abs(OpeningMm(*parameters) - opening_mm) > kReachedMm)
    SetOpeningBy(*jaw_, 0, ranges_[*jaw_].max, opening_mm, parameters);
}

void LipGauge::SetOpeningBy(int parameter, double low, double high, double opening_mm,
                            Eigen::VectorXd* parameters) const {
  double& value = (*parameters)[parameter];
  for (int i = 0; i < kBisections; ++i) {
    value = 0.5 * (low + high);
    (OpeningMm(*parameters) < opening_mm ? low : high) = value;
  }
}

}  // namespace articap
