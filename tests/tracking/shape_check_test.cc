// SPDX-License-Identifier: MIT
#include "tracking/shape_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/transforms.h"

namespace articap {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class CompareWithShapeTest : public testing::Test {
 protected:
  CompareWithShapeTest() {
    given_.points = {{"t1", {70, 3, -70}},     {"f1", {55, 12, -5}},  {"bridge", {0, 8, 12}},
                     {"f2", {-55, 12, -5}},    {"t2", {-70, 3, -70}}, {"eye1", {40, -6, -22}},
                     {"eye2", {-40, -6, -22}}, {"brow", {0, 26, 4}}};
    const Rigid3d own_from_given{Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitY())),
                                 {5, 6, 7}};
    for (const NamedPoint& point : given_.points) {
      names_.push_back(point.name);
      own_mm_.push_back(own_from_given * point.point_in_head_mm);
    }
  }

  Result<ShapeComparison> Compare() const { return CompareWithShape(names_, own_mm_, given_, 1.0); }
  std::string Message() const {
    const auto comparison = Compare();
    EXPECT_FALSE(comparison);
    return comparison ? "" : comparison.error().message;
  }
  void KeepFirst(std::size_t count) {
    names_.resize(count);
    own_mm_.resize(count);
  }

  HeadShape given_;
  std::vector<std::string> names_;
  std::vector<Eigen::Vector3d> own_mm_;
};

TEST_F(CompareWithShapeTest, ARigidMotionIsNoDifference) {
  const auto comparison = Compare();
  ASSERT_TRUE(comparison);
  EXPECT_THAT(comparison->warnings, IsEmpty());
  EXPECT_THAT(comparison->misplaced, IsEmpty());
  for (const double deviation_mm : comparison->deviation_mm) EXPECT_NEAR(deviation_mm, 0, 1e-9);
}

TEST_F(CompareWithShapeTest, OneOrTwoMisplacedAreNamed) {
  own_mm_[1].y() += 3;
  own_mm_[5].x() -= 4;
  const auto comparison = Compare();
  ASSERT_TRUE(comparison) << comparison.error().message;
  EXPECT_THAT(comparison->misplaced, testing::UnorderedElementsAre(1, 5));
  EXPECT_NEAR(comparison->deviation_mm[1], 3, 1e-6);
  EXPECT_NEAR(comparison->deviation_mm[5], 4, 1e-6);
  EXPECT_THAT(comparison->warnings, testing::UnorderedElementsAre(HasSubstr("'f1' lies 3.0 mm"),
                                                                  HasSubstr("'eye1' lies 4.0 mm")));
}

TEST_F(CompareWithShapeTest, ExchangedNamesAreToldFromMisplacedMarkers) {
  std::swap(own_mm_[1], own_mm_[3]);
  EXPECT_THAT(Message(), AllOf(HasSubstr("exchanged"), HasSubstr("'f1' is where 'f2' should be")));
  KeepFirst(5);
  EXPECT_THAT(Message(), AllOf(HasSubstr("exchanged"), HasSubstr("'f2' is where 'f1' should be")));
}

TEST_F(CompareWithShapeTest, MirroredDataAreNamed) {
  for (Eigen::Vector3d& point_mm : own_mm_) point_mm.z() *= -1;
  EXPECT_THAT(Message(), HasSubstr("--mirror"));
}

TEST_F(CompareWithShapeTest, AnotherUnitIsNamed) {
  for (Eigen::Vector3d& point_mm : own_mm_) point_mm /= 10;
  EXPECT_THAT(Message(), AllOf(HasSubstr("10 times as large"), HasSubstr("unit")));
}

TEST_F(CompareWithShapeTest, TwoGroupsThatMovedAgainstEachOtherAreNamed) {
  for (const std::size_t i : {5, 6, 7}) own_mm_[i] += Eigen::Vector3d(0, -6, 2);
  EXPECT_THAT(Message(), AllOf(HasSubstr("two groups"), HasSubstr("t1, f1, bridge, f2, t2 and"),
                               HasSubstr("brow")));
}

TEST_F(CompareWithShapeTest, AnotherSubjectIsRefused) {
  const double stretch[] = {1.15, 0.9, 1.2, 0.85, 1.1, 0.8, 1.25, 0.9};
  for (std::size_t i = 0; i < own_mm_.size(); ++i)
    own_mm_[i] += (stretch[i] - 1) * given_.points[i].point_in_head_mm +
                  Eigen::Vector3d(0, static_cast<double>(i), 0);
  EXPECT_THAT(Message(), HasSubstr("another subject"));
}

TEST_F(CompareWithShapeTest, ThreeInCommonAreNeeded) {
  names_[0] = names_[1] = names_[2] = "x";
  own_mm_[3].setConstant(std::numeric_limits<double>::quiet_NaN());
  ASSERT_TRUE(Compare());
  names_[4] = "x";
  own_mm_[5] = own_mm_[3];
  EXPECT_THAT(Message(), HasSubstr("only 2 of the references"));
}

}  // namespace
}  // namespace articap
