// SPDX-License-Identifier: MIT
#include "core/transforms.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/matchers.h"

namespace articap {
namespace {

Eigen::Vector3d RandomPoint(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-100, 100);
  return {coordinate(random), coordinate(random), coordinate(random)};
}

Eigen::Quaterniond RandomRotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond{normal(random), normal(random), normal(random), normal(random)}
      .normalized();
}

template <class Transform>
Transform RandomTransform(std::mt19937& random);

template <>
Rigid3d RandomTransform(std::mt19937& random) {
  return {RandomRotation(random), RandomPoint(random)};
}

template <>
Sim3d RandomTransform(std::mt19937& random) {
  const double scale = std::uniform_real_distribution<double>(0.5, 2)(random);
  return {scale, RandomRotation(random), RandomPoint(random)};
}

// The laws that every group of transforms obeys.
template <class Transform>
class TransformLaws : public testing::Test {};
using TransformTypes = testing::Types<Rigid3d, Sim3d>;
TYPED_TEST_SUITE(TransformLaws, TransformTypes);

TYPED_TEST(TransformLaws, ProductActsAsOneAfterTheOther) {
  std::mt19937 random(1);
  const auto a_from_b = RandomTransform<TypeParam>(random);
  const auto b_from_c = RandomTransform<TypeParam>(random);
  const Eigen::Vector3d point_in_c = RandomPoint(random);
  EXPECT_THAT((a_from_b * b_from_c) * point_in_c,
              PointNear(a_from_b * (b_from_c * point_in_c), 1e-10));
}

TYPED_TEST(TransformLaws, InverseUndoes) {
  std::mt19937 random(2);
  const auto a_from_b = RandomTransform<TypeParam>(random);
  const Eigen::Vector3d point_in_b = RandomPoint(random);
  EXPECT_THAT(a_from_b.Inverse() * (a_from_b * point_in_b), PointNear(point_in_b, 1e-10));
  EXPECT_THAT((a_from_b * a_from_b.Inverse()) * point_in_b, PointNear(point_in_b, 1e-10));
}

TEST(Sim3dTest, SevenParametersRoundTrip) {
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    const Sim3d transform = RandomTransform<Sim3d>(random);
    EXPECT_THAT(Sim3d::FromParameters(transform.ToParameters()),
                Sim3dNear(transform, 1e-7, 1e-12, 1e-12));
  }
}

TEST(Sim3dTest, SevenParametersSurviveGimbalLock) {
  for (const double sign : {-1.0, 1.0}) {
    const Sim3d transform = Sim3d::FromParameters({1, 2, 3, 0.3, sign * std::acos(0.0), 0.4, 1.5});
    EXPECT_THAT(Sim3d::FromParameters(transform.ToParameters()),
                Sim3dNear(transform, 1e-7, 1e-12, 1e-12));
  }
}

}  // namespace
}  // namespace articap
