// SPDX-License-Identifier: MIT
#include "tracking/head_axes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/landmarks.h"
#include "tests/support/matchers.h"
#include "tracking/anatomy.h"

namespace articap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

const Rigid3d kShapeFromFace{
    Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -1, 3).normalized())),
    {100, -50, 20}};

std::vector<PlacedLandmark> FaceWith(std::initializer_list<const char*> names) {
  std::vector<PlacedLandmark> face;
  for (const char* name : names)
    face.push_back(
        {std::string("m_") + name, name, kShapeFromFace * FindLandmark(name)->typical_mm});
  return face;
}

std::vector<PlacedLandmark> WholeFace() {
  std::vector<PlacedLandmark> face;
  for (const LandmarkInfo& info : AllLandmarks())
    face.push_back(
        {std::string(info.name), std::string(info.name), kShapeFromFace * info.typical_mm});
  return face;
}

const Eigen::Quaterniond kUnturned = Eigen::Quaterniond::Identity();

TEST(HeadAxesTest, ChinToBridgeIsUpExactly) {
  const auto face = FaceWith({"chin", "nose_bridge", "left_eye_outer", "right_eye_outer"});
  const auto axes = FindHeadAxes(face, std::nullopt, kUnturned, {0, 0, 0});
  ASSERT_TRUE(axes) << axes.error().message;
  const auto in_head = [&](int i) { return axes->head_from_shape * face[i].point_mm; };
  EXPECT_THAT(in_head(1), PointNear(Eigen::Vector3d::Zero(), 1e-9));
  EXPECT_NEAR(in_head(0).x(), 0, 1e-9);
  EXPECT_NEAR(in_head(0).z(), 0, 1e-9);
  EXPECT_LT(in_head(0).y(), 0);
  EXPECT_NEAR(in_head(2).z(), in_head(3).z(), 1e-9);
  EXPECT_GT(in_head(2).x(), 0);
  EXPECT_LT(in_head(2).z(), 0) << "the eyes lie behind the bridge of the nose";
}

TEST(HeadAxesTest, SubstitutesServeInOrder) {
  const auto axes =
      FindHeadAxes(FaceWith({"menton", "brow_center", "left_mouth_corner", "right_mouth_corner"}),
                   std::nullopt, kUnturned, {1, 2, 3});
  ASSERT_TRUE(axes);
  EXPECT_EQ(axes->axes,
            "y from m_menton to m_brow_center, x from m_right_mouth_corner to m_left_mouth_corner");
  EXPECT_EQ(axes->origin, "centroid of the references");
  EXPECT_THAT(axes->head_from_shape * Eigen::Vector3d(1, 2, 3),
              PointNear(Eigen::Vector3d::Zero(), 1e-9));
}

TEST(HeadAxesTest, NothingToGoByIsAnErrorThatSaysWhatToAdd) {
  for (const auto& face : {FaceWith({}), FaceWith({"chin", "nose_bridge"}),
                           FaceWith({"nose_bridge", "left_eye_outer", "right_eye_outer"})}) {
    const auto axes = FindHeadAxes(face, std::nullopt, kUnturned, {0, 0, 0});
    ASSERT_FALSE(axes);
    EXPECT_THAT(axes.error().message, HasSubstr("--left +x --up +y --forward +z"));
    EXPECT_TRUE(FindHeadAxes(face, DeclaredAxes{}, kUnturned, {0, 0, 0}));
  }
}

TEST(HeadAxesTest, ImpossibleFacesAreRefused) {
  auto face = FaceWith({"chin", "nose_bridge", "left_eye_outer", "right_eye_outer"});
  face[2].point_mm = face[3].point_mm + 0.9 * (face[1].point_mm - face[0].point_mm);
  const auto axes = FindHeadAxes(face, std::nullopt, kUnturned, {0, 0, 0});
  ASSERT_FALSE(axes);
  EXPECT_THAT(axes.error().message, HasSubstr("which no face is"));
}

TEST(AnatomyTest, AFaceIsNotMirroredAndItsMirrorImageIs) {
  std::vector<PlacedLandmark> face = WholeFace();
  EXPECT_FALSE(CheckAnatomy(face).is_mirrored);
  EXPECT_THAT(CheckAnatomy(face).exchanged, IsEmpty());
  EXPECT_NEAR(CheckAnatomy(face).tilt_rad, 2, 1e-6);
  for (PlacedLandmark& landmark : face) landmark.point_mm.y() *= -1;
  EXPECT_TRUE(CheckAnatomy(face).is_mirrored);
  EXPECT_THAT(CheckAnatomy(face).exchanged, IsEmpty());
}

TEST(AnatomyTest, ExchangedPairsAreFound) {
  std::vector<PlacedLandmark> face = WholeFace();
  const auto point_of = [&](const char* name) -> Eigen::Vector3d& {
    return std::ranges::find(face, name, &PlacedLandmark::landmark)->point_mm;
  };
  std::swap(point_of("left_eye_outer"), point_of("right_eye_outer"));
  std::swap(point_of("nose_left"), point_of("nose_right"));
  const AnatomyFindings findings = CheckAnatomy(face);
  EXPECT_FALSE(findings.is_mirrored);
  EXPECT_THAT(findings.exchanged,
              testing::UnorderedElementsAre(Pair("left_eye_outer", "right_eye_outer"),
                                            Pair("nose_left", "nose_right")));
}

TEST(AnatomyTest, AFewMarkersSayNothing) {
  EXPECT_EQ(CheckAnatomy(FaceWith({"chin", "nose_tip", "nose_bridge"})).tilt_rad, 0);
  auto five = FaceWith({"chin", "nose_tip", "nose_bridge", "left_eye_outer", "right_eye_outer"});
  for (PlacedLandmark& landmark : five) landmark.point_mm.y() *= -1;
  EXPECT_FALSE(CheckAnatomy(five).is_mirrored);
}

}  // namespace
}  // namespace articap
