// SPDX-License-Identifier: MIT
// Clouds of unnamed markers from faces whose place is known, laid on the average head.
#include "fitting/icp_alignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <random>

#include "core/marker_set.h"
#include "fitting/face_surface.h"
#include "rig/default_head/default_head.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNoiseMm = 0.5;

const FaceRig& DefaultHead() {
  static const FaceRig rig = MakeDefaultHead().value();
  return rig;
}

// Deterministic on every platform, unlike std::normal_distribution.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }
  // Twelve uniform numbers less six: standard normal near enough for noise.
  double Normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += Uniform(0, 1);
    return sum;
  }
  Eigen::Vector3d NormalVector() { return {Normal(), Normal(), Normal()}; }

 private:
  std::mt19937 engine_;
};

FaceRig RandomPerson(Dice& dice) {
  const auto& sliders = DefaultHead().definition().identity_sliders;
  Eigen::VectorXd identity(static_cast<Eigen::Index>(sliders.size()));
  for (std::size_t i = 0; i < sliders.size(); ++i)
    identity[static_cast<Eigen::Index>(i)] = 0.5 * dice.Uniform(sliders[i].min, sliders[i].max);
  return DefaultHead().WithIdentity(identity);
}

// The thirty face markers of a set-up that follows the landmarks, with the radius of the markers.
std::vector<Eigen::Vector3d> LandmarkCloud(const FaceRig& person, Dice& dice) {
  const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml").value();
  const std::vector<Eigen::Vector3d> normals = VertexNormals(person.neutral_mesh());
  std::vector<Eigen::Vector3d> cloud;
  for (const MarkerRole& marker : set.markers) {
    if (!marker.face) continue;
    const int vertex = person.FindLandmark(marker.landmark).value();
    cloud.push_back(person.neutral_mesh().vertices[vertex] + marker.offset_mm * normals[vertex] +
                    kNoiseMm * dice.NormalVector());
  }
  return cloud;
}

// A person's markers anywhere in the room, up to 30 degrees off, in a size of their own.
struct Case {
  std::vector<Eigen::Vector3d> cloud_mm;
  Eigen::Quaterniond rig_from_cloud;
};

Case Displace(const std::vector<Eigen::Vector3d>& in_rig, Dice& dice) {
  const double angle = dice.Uniform(0, 30) * kDegree;
  const Eigen::Quaterniond cloud_from_rig(
      Eigen::AngleAxisd(angle, dice.NormalVector().normalized()));
  const Eigen::Vector3d place = 500 * dice.NormalVector();
  const double size = dice.Uniform(0.93, 1.07);
  Case result{{}, cloud_from_rig.conjugate()};
  for (const Eigen::Vector3d& point : in_rig)
    result.cloud_mm.push_back(size * (cloud_from_rig * point) + place);
  return result;
}

struct Errors {
  double median_deg = 0, worst_deg = 0;
};

template <class MakeCloud>
Errors MeasureErrors(int num_cases, unsigned seed, const IcpOptions& options,
                     MakeCloud make_cloud) {
  Dice dice(seed);
  std::vector<double> errors_deg;
  for (int i = 0; i < num_cases; ++i) {
    const FaceRig person = RandomPerson(dice);
    const Case placed = Displace(make_cloud(person, dice), dice);
    const auto alignment = AlignCloudToRig(placed.cloud_mm, DefaultHead(), options);
    EXPECT_TRUE(alignment) << alignment.error().message;
    if (!alignment) return {};
    errors_deg.push_back(alignment->rig_from_cloud.rotation.angularDistance(placed.rig_from_cloud) /
                         kDegree);
    EXPECT_LT(alignment->median_distance_mm, 4);
  }
  std::ranges::sort(errors_deg);
  std::printf("rotation errors: median %.2f, worst %.2f degrees of %d clouds\n",
              errors_deg[errors_deg.size() / 2], errors_deg.back(), num_cases);
  return {errors_deg[errors_deg.size() / 2], errors_deg.back()};
}

TEST(IcpAlignmentTest, LandmarkCloudsThirtyDegreesOffComeHome) {
  const Errors errors = MeasureErrors(8, 1, {}, LandmarkCloud);
  EXPECT_LT(errors.median_deg, 3);
  EXPECT_LT(errors.worst_deg, 5);
}

TEST(IcpAlignmentTest, SkinAloneFindsTheHeadToo) {
  IcpOptions options;
  options.use_landmarks = false;
  const Errors errors = MeasureErrors(5, 2, options, LandmarkCloud);
  EXPECT_LT(errors.median_deg, 5);
}

// Markers anywhere on the skin: nothing but its shape can help.
TEST(IcpAlignmentTest, MarkersAwayFromLandmarksAreAligned) {
  const auto scattered = [](const FaceRig& person, Dice& dice) {
    const std::vector<Eigen::Vector3d> skin = FaceSurface::Create(person)->Sample(3);
    std::vector<Eigen::Vector3d> cloud;
    while (cloud.size() < 40) {
      const auto index =
          static_cast<std::size_t>(dice.Uniform(0, 0.999999) * static_cast<double>(skin.size()));
      // The front of the face, where people glue markers: not the temples, not the ears.
      if (skin[index].z() > 40) cloud.push_back(skin[index] + kNoiseMm * dice.NormalVector());
    }
    return cloud;
  };
  const Errors errors = MeasureErrors(5, 3, {}, scattered);
  EXPECT_LT(errors.median_deg, 4);
}

TEST(IcpAlignmentTest, RefusesWhatIsNoFace) {
  const std::vector<Eigen::Vector3d> few(5, Eigen::Vector3d::Ones());
  const auto too_few = AlignCloudToRig(few, DefaultHead());
  ASSERT_FALSE(too_few);
  EXPECT_THAT(too_few.error().message, HasSubstr("5 markers are too few"));

  Dice dice(4);
  std::vector<Eigen::Vector3d> metres = LandmarkCloud(DefaultHead(), dice);
  for (Eigen::Vector3d& point : metres) point /= 1000;
  const auto tiny = AlignCloudToRig(metres, DefaultHead());
  ASSERT_FALSE(tiny);
  EXPECT_THAT(tiny.error().message, HasSubstr("check the unit of length"));
}

}  // namespace
}  // namespace articap
