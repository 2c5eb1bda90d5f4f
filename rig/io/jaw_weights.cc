// SPDX-License-Identifier: MIT
#include "rig/io/jaw_weights.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace articap {
namespace {

// Less than this moves nothing that could be seen.
constexpr double kSmallestWeight = 1e-3;

// Laplacian smoothing over the mesh's edges.
void SmoothOnce(const TriangleMesh& mesh, const std::vector<JawBond>& bonds,
                std::vector<double>& weights) {
  std::vector<double> sum(weights.size(), 0);
  std::vector<int> count(weights.size(), 0);
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      for (const int other : {triangle[(k + 1) % 3], triangle[(k + 2) % 3]}) {
        sum[triangle[k]] += weights[other];
        ++count[triangle[k]];
      }
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (bonds[i] == JawBond::kFree && count[i] > 0)
      weights[i] = 0.5 * weights[i] + 0.5 * sum[i] / count[i];
}

}  // namespace

std::vector<double> JawWeights(const ImportRecipe::Jaw& jaw, const TriangleMesh& mesh,
                               const std::vector<Eigen::Vector3d>& opening_mm,
                               const std::vector<JawBond>& bonds) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(jaw.angle_rad, Eigen::Vector3d::UnitX()).toRotationMatrix() -
      Eigen::Matrix3d::Identity();
  std::vector<Eigen::Vector3d> ways_mm;
  double longest_mm = 0;
  for (std::size_t i = 0; i < opening_mm.size(); ++i) {
    ways_mm.emplace_back(turn * (mesh.vertices[i] - jaw.pivot_mm));
    if (!opening_mm[i].isZero(0)) longest_mm = std::max(longest_mm, ways_mm.back().norm());
  }
  const double soft2 = jaw.soft_mm * jaw.soft_mm;
  const double scale = longest_mm > 0 ? 1 + soft2 / (longest_mm * longest_mm) : 1;
  std::vector<double> weights;
  for (std::size_t i = 0; i < opening_mm.size(); ++i) {
    const double share = scale * opening_mm[i].dot(ways_mm[i]) / (ways_mm[i].squaredNorm() + soft2);
    weights.push_back(bonds[i] == JawBond::kRigid   ? 1
                      : bonds[i] == JawBond::kFixed ? 0
                                                    : std::clamp(share, 0.0, 1.0));
  }
  for (int round = 0; round < jaw.smoothing_rounds; ++round) SmoothOnce(mesh, bonds, weights);
  for (double& weight : weights)
    if (weight < kSmallestWeight) weight = 0;
  return weights;
}

}  // namespace articap
