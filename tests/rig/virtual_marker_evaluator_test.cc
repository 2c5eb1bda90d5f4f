// SPDX-License-Identifier: MIT
#include "rig/virtual_marker_evaluator.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/rig/toy_rig.h"
#include "tests/support/matchers.h"

namespace articap {
namespace {

// A marker on every seventh triangle, corners rotated, some without a height, the border included.
std::vector<VirtualMarker> ScatterMarkers(const FaceRig& rig, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<VirtualMarker> markers;
  const auto& triangles = rig.neutral_mesh().triangles;
  for (std::size_t i = 0; i < triangles.size(); i += 7) {
    const Eigen::Vector3i t = triangles[i];
    const int turn = static_cast<int>(i % 3);
    const double s = unit(random), t_weight = (1 - s) * unit(random);
    markers.push_back({"m" + std::to_string(i),
                       {t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]},
                       s,
                       t_weight,
                       i % 5 == 0 ? 0 : 6 * unit(random) - 1});
  }
  return markers;
}

std::vector<double> RandomPose(const FaceRig& rig, std::mt19937& random) {
  std::vector<double> pose;
  for (const RigParameter& parameter : rig.definition().parameters)
    pose.push_back(std::uniform_real_distribution(parameter.min, parameter.max)(random));
  return pose;
}

// The definition of core/virtual_marker.h, evaluated on the whole mesh.
Eigen::Vector3d ByDefinition(const FaceRig& rig, const VirtualMarker& marker,
                             const std::vector<double>& pose) {
  const TriangleMesh posed{
      rig.Evaluate(Eigen::Map<const Eigen::VectorXd>(pose.data(), rig.num_parameters())),
      rig.neutral_mesh().triangles};
  const Eigen::Vector3d& v1 = posed.vertices[marker.triangle[0]];
  return v1 + marker.s * (posed.vertices[marker.triangle[1]] - v1) +
         marker.t * (posed.vertices[marker.triangle[2]] - v1) +
         marker.u_mm * VertexNormals(posed)[marker.triangle[0]];
}

TEST(VirtualMarkerEvaluatorTest, AgreesWithTheDefinitionOnTheWholeMesh) {
  std::mt19937 random(7);
  const FaceRig rig = MakeToyRig().WithIdentity(Eigen::VectorXd::Constant(1, 0.7));
  const auto markers = ScatterMarkers(rig, random);
  const VirtualMarkerEvaluator evaluator(rig, markers);
  for (int trial = 0; trial < 5; ++trial) {
    const auto pose = RandomPose(rig, random);
    const Eigen::Matrix3Xd positions = evaluator.Positions(pose);
    for (std::size_t i = 0; i < markers.size(); ++i)
      ASSERT_THAT(positions.col(static_cast<int>(i)),
                  PointNear(ByDefinition(rig, markers[i], pose), 1e-10))
          << markers[i].name;
  }
}

TEST(VirtualMarkerEvaluatorTest, JacobianIsTheDerivative) {
  std::mt19937 random(8);
  const FaceRig rig = MakeToyRig();
  const VirtualMarkerEvaluator evaluator(rig, ScatterMarkers(rig, random));
  for (int trial = 0; trial < 5; ++trial) {
    const auto pose = RandomPose(rig, random);
    const Eigen::MatrixXd jacobian = evaluator.DenseJacobian(pose);
    for (int k = 0; k < rig.num_parameters(); ++k) {
      // Central differences: truncation (h^2) and rounding (1e-14 / h) both stay below 1e-7.
      const double h = 1e-5;
      auto ahead = pose, behind = pose;
      ahead[k] += h;
      behind[k] -= h;
      const Eigen::Matrix3Xd difference =
          (evaluator.Positions(ahead) - evaluator.Positions(behind)) / (2 * h);
      const Eigen::Map<const Eigen::VectorXd> expected(difference.data(), difference.size());
      ASSERT_LT((jacobian.col(k) - expected).lpNorm<Eigen::Infinity>(),
                1e-7 * std::max(1.0, expected.lpNorm<Eigen::Infinity>()))
          << rig.definition().parameters[k].name;
    }
  }
}

// One evaluator and one skinned joint could not carry it.
TEST(FaceRigTest, AParameterOfTheJawDisplacesNothingBesides) {
  RigDefinition definition = MakeToyRig().definition();
  ASSERT_TRUE(definition.jaw.has_value());
  definition.transforms.push_back({.parameter = definition.jaw->rotation_parameter,
                                   .weight_map = 0,
                                   .vector = Eigen::Vector3d::UnitX()});
  const auto rig = FaceRig::Create(definition);
  ASSERT_FALSE(rig);
  EXPECT_NE(rig.error().message.find("the jaw's"), std::string::npos) << rig.error().message;
}

}  // namespace
}  // namespace articap
