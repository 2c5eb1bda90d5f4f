// SPDX-License-Identifier: MIT
#include "rig/default_head/weights.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <utility>

#include "core/check.h"
#include "rig/default_head/curve.h"

namespace articap::default_head {
namespace {

using Eigen::Vector3d;

// What is left of a lip's weight on the rings of the mouth bag behind the seam.
constexpr double kBagDecay[] = {1.0, 0.95, 0.85, 0.4, 0.1, 0, 0};

// From 1 to 0; of all smooth steps the cubic one's slope is mildest, so that skin between a moving
// lip and a resting chin is squeezed least.
double Decay(double distance) {
  const double u = std::clamp(distance, 0.0, 1.0);
  return 1 - u * u * (3 - 2 * u);
}

// Jaw weights along the closed lips. Their difference is how the mouth opens: an ellipse-like slit
// between corners that go half way.
double OpeningShape(double fraction) {
  return std::pow(std::max(1 - std::pow(fraction, 2.2), 0.0), 0.8);
}

// Where the skin is bone to the mandible or to the skull; nothing where it stretches between.
std::optional<double> BoundJawWeight(double section, double level) {
  if (level < 1.0 || level > 9.3 || section > 4.75) return 0;
  if (section < 1.1 && level > 7.95) return 0;
  if (section > 3.3 && level > 8.2) return 0;
  // An ellipse: corners of the bound region would crease the skin.
  if (std::hypot(section / 1.75, (level - 4.6) / 0.85) < 1) return 1;
  return std::nullopt;
}

// Half cotangents of a triangle's angles, opposite to each corner; not below a small positive
// value, so that the harmonic function keeps between its bounds.
std::array<double, 3> CotanWeights(const HalfMesh& half, const Eigen::Vector3i& corners) {
  std::array<double, 3> weights;
  for (int i = 0; i < 3; ++i) {
    const Vector3d& apex = half.position(corners[i]);
    const Vector3d a = half.position(corners[(i + 1) % 3]) - apex;
    const Vector3d b = half.position(corners[(i + 2) % 3]) - apex;
    weights[i] = std::max(0.5 * a.dot(b) / std::max(a.cross(b).norm(), 1e-9), 0.02);
  }
  return weights;
}

// Stiffness of a membrane against that of a plate, 1/mm^2: over some 30 mm they are alike. The
// plate keeps creases away from the bound places, the membrane overshoots.
constexpr double kTension = 1.0 / (30.0 * 30.0);

void FillHarmonic(const HalfMesh& half, const std::vector<bool>& in_domain,
                  std::vector<std::optional<double>>& values) {
  std::vector<int> unknown(values.size(), -1);
  int size = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (in_domain[i] && !values[i]) unknown[i] = size++;
  const int num_values = static_cast<int>(values.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd area = Eigen::VectorXd::Zero(num_values);
  for (const HalfMesh::Triangle& triangle : half.triangles) {
    const Eigen::Vector3i& v = triangle.corners;
    if (!in_domain[v[0]] || !in_domain[v[1]] || !in_domain[v[2]]) continue;
    const std::array<double, 3> weights = CotanWeights(half, v);
    const double third = (half.position(v[1]) - half.position(v[0]))
                             .cross(half.position(v[2]) - half.position(v[0]))
                             .norm() /
                         6;
    for (int i = 0; i < 3; ++i) {
      const int a = v[(i + 1) % 3], b = v[(i + 2) % 3];
      entries.emplace_back(a, b, -weights[i]);
      entries.emplace_back(b, a, -weights[i]);
      entries.emplace_back(a, a, weights[i]);
      entries.emplace_back(b, b, weights[i]);
      area[v[i]] += third;
    }
  }
  Eigen::SparseMatrix<double> laplacian(num_values, num_values);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd inverse_area =
      area.unaryExpr([](double a) { return a > 0 ? 1 / std::max(a, 0.5) : 0; });
  const Eigen::SparseMatrix<double> bending =
      Eigen::SparseMatrix<double>(laplacian.transpose()) * inverse_area.asDiagonal() * laplacian +
      kTension * laplacian;
  std::vector<Eigen::Triplet<double>> free_entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  for (int column = 0; column < num_values; ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(bending, column); it; ++it) {
      const int row = unknown[it.row()];
      if (row < 0) continue;
      if (unknown[column] >= 0)
        free_entries.emplace_back(row, unknown[column], it.value());
      else if (values[column])
        right[row] -= it.value() * *values[column];
    }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(free_entries.begin(), free_entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  ARTICAP_CHECK(solver.info() == Eigen::Success);
  const Eigen::VectorXd solution = solver.solve(right);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (unknown[i] >= 0) values[i] = std::clamp(solution[unknown[i]], 0.0, 1.0);
}

double CarriedJawWeight(const HalfMesh::Vertex& vertex) {
  switch (vertex.carrier) {
    case Carrier::kMandible:
      return 1;
    case Carrier::kTongue:  // its root hangs from the skull too
      return 0.7 + 0.28 * SmoothStep(45, 75, vertex.position.z());
    case Carrier::kSkin:
    case Carrier::kSkull:
      break;
  }
  return 0;
}

}  // namespace

LipDistances::LipDistances(const HalfMesh& half, const Skin& skin)
    : skin_(skin), edges_(skin.layout.nodes.size()), on_border_(skin.layout.nodes.size(), false) {
  const int size = static_cast<int>(edges_.size());
  const auto connect = [&](int a, int b) {
    const double length = (half.position(a) - half.position(b)).norm();
    edges_[a].push_back({b, length});
    edges_[b].push_back({a, length});
  };
  // Edges, and across each edge the other diagonal of its two triangles.
  std::map<std::pair<int, int>, int> apex_of_edge;
  for (const HalfMesh::Triangle& triangle : half.triangles)
    for (int i = 0; i < 3; ++i) {
      const int a = triangle.corners[i], b = triangle.corners[(i + 1) % 3];
      const int apex = triangle.corners[(i + 2) % 3];
      if (a >= size || b >= size || apex >= size) continue;
      const auto [other, is_new] = apex_of_edge.try_emplace(std::minmax(a, b), apex);
      if (is_new)
        connect(a, b);
      else
        connect(apex, other->second);
    }
  for (const int vertex : skin.mouth_rings[skin.border_ring]) on_border_[vertex] = true;
}

std::vector<LipDistances::Nearest> LipDistances::FromBorder(bool upper, bool lower) const {
  std::vector<Nearest> nearest(edges_.size(), {std::numeric_limits<double>::infinity(), 0});
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const std::vector<int>& border = skin_.mouth_rings[skin_.border_ring];
  for (int k = 0; k < skin_.num_mouth_columns(); ++k) {
    const bool corner = k == skin_.layout.mouth_corner;
    if (!corner && !(skin_.IsUpper(k) ? upper : lower)) continue;
    nearest[border[k]] = {0, k};
    queue.emplace(0, border[k]);
  }
  while (!queue.empty()) {
    const auto [distance, vertex] = queue.top();
    queue.pop();
    if (distance > nearest[vertex].distance_mm) continue;
    for (const Edge& edge : edges_[vertex]) {
      const double through = distance + edge.length_mm;
      if (through >= nearest[edge.to].distance_mm) continue;
      nearest[edge.to] = {through, nearest[vertex].column};
      queue.emplace(through, edge.to);
    }
  }
  return nearest;
}

void LipDistances::Smooth(std::vector<double>& values) const {
  constexpr int kPasses = 6;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<double> next = values;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (on_border_[i] || edges_[i].empty()) continue;
      double sum = 0, total = 0;
      for (const Edge& edge : edges_[i]) {
        sum += values[edge.to] / edge.length_mm;
        total += 1 / edge.length_mm;
      }
      next[i] = 0.5 * values[i] + 0.5 * sum / total;
    }
    values = std::move(next);
  }
}

std::vector<double> LipWeights(const LipWeightSpec& spec, const LipDistances& distances,
                               const HalfMesh& half, const Skin& skin) {
  const Curve along(spec.along);
  const auto at_column = [&](int k) {
    const bool corner = k == skin.layout.mouth_corner;
    if (!corner && !(skin.IsUpper(k) ? spec.on_upper : spec.on_lower)) return 0.0;
    return along(skin.MouthFraction(k));
  };
  std::vector<double> on_layout;
  for (const LipDistances::Nearest& nearest : distances.FromBorder(spec.on_upper, spec.on_lower))
    on_layout.push_back(at_column(nearest.column) * Decay(nearest.distance_mm / spec.reach_mm));
  // The border of the other lip does not move, whatever the way round the corner.
  const std::vector<int>& border = skin.mouth_rings[skin.border_ring];
  for (int k = 0; k < skin.num_mouth_columns(); ++k) on_layout[border[k]] = at_column(k);
  distances.Smooth(on_layout);
  // Smoothing has spread crumbs; what is not moved shall be still.
  constexpr double kCrumb = 0.002;
  for (double& weight : on_layout) weight = std::max(weight - kCrumb, 0.0) / (1 - kCrumb);

  std::vector<double> weights(half.vertices.size(), 0);
  std::copy(on_layout.begin(), on_layout.end(), weights.begin());
  const int num_rings = static_cast<int>(skin.mouth_rings.size());
  for (int ring = skin.border_ring; ring < num_rings; ++ring) {
    const double decay = ring <= skin.seam_ring ? 1 : kBagDecay[ring - skin.seam_ring - 1];
    for (int k = 0; k < skin.num_mouth_columns(); ++k)
      weights[skin.mouth_rings[ring][k]] = decay * at_column(k);
  }
  return weights;
}

std::vector<double> JawWeights(const HalfMesh& half, const Skin& skin) {
  const SkinLayout& layout = skin.layout;
  std::vector<std::optional<double>> values(half.vertices.size());
  std::vector<bool> in_domain(half.vertices.size(), false);
  for (std::size_t i = 0; i < layout.nodes.size(); ++i) {
    in_domain[i] = true;
    values[i] = BoundJawWeight(layout.nodes[i].x(), layout.nodes[i].y());
  }
  const int num_rings = static_cast<int>(skin.mouth_rings.size());
  for (int ring = skin.border_ring + 1; ring < num_rings; ++ring) {
    // The bag's back hangs between skull and jaw.
    const int behind = ring - skin.seam_ring;
    const double hang = SmoothStep(3, num_rings - 1 - skin.seam_ring, behind);
    for (int k = 0; k < skin.num_mouth_columns(); ++k) {
      const int vertex = skin.mouth_rings[ring][k];
      in_domain[vertex] = ring <= skin.seam_ring;
      if (behind < 0) continue;
      const double shape = 0.5 * OpeningShape(skin.MouthFraction(k));
      const double seam = skin.IsUpper(k) ? 0.5 - shape : 0.5 + shape;
      values[vertex] = seam + hang * (0.4 - seam);
    }
  }
  FillHarmonic(half, in_domain, values);
  std::vector<double> weights(half.vertices.size());
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = values[i] ? *values[i] : CarriedJawWeight(half.vertices[i]);
  return weights;
}

}  // namespace articap::default_head
