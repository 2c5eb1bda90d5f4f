// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>
#include <set>

#include "rig/head_size.h"
#include "rig/io/import.h"
#include "rig/io/makehuman_target.h"
#include "tests/support/matchers.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;

constexpr const char* kTarget = "# a target\n\n3 0 .5 -.25\n0 1e-3 0 +2 # the nose\r\n";

std::string Gzip(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

TEST(MakeHumanTarget, TextAndGzipAreTheSame) {
  for (const std::string& bytes : {std::string(kTarget), Gzip(kTarget)}) {
    const auto field = ParseMakeHumanTarget(bytes, 4, "nose.target");
    ASSERT_TRUE(field) << field.error().message;
    ASSERT_THAT(field->vertices, testing::ElementsAre(3, 0));
    EXPECT_THAT(field->displacements_mm[0], PointNear(Eigen::Vector3d(0, 0.5, -0.25), 0));
    EXPECT_THAT(field->displacements_mm[1], PointNear(Eigen::Vector3d(0.001, 0, 2), 0));
  }
}

TEST(MakeHumanTarget, FaultsAreNamedWithTheirLine) {
  const auto message = [](const std::string& bytes) {
    const auto field = ParseMakeHumanTarget(bytes, 4, "nose.target");
    return field ? "fine" : field.error().message;
  };
  EXPECT_THAT(message("# x\n4 0 0 0\n"), HasSubstr("nose.target, line 2: vertex '4'"));
  EXPECT_THAT(message("-1 0 0 0\n"), HasSubstr("vertex '-1'"));
  EXPECT_THAT(message("1 0 0\n"), HasSubstr("3 fields"));
  EXPECT_THAT(message("1 0 nan 0\n"), HasSubstr("'nan'"));
  EXPECT_THAT(message("1 0 0 0\n1 0 0 0\n"), HasSubstr("twice"));
  const std::string packed = Gzip(kTarget);
  EXPECT_THAT(message(packed.substr(0, packed.size() / 2)), HasSubstr("gzip"));
  EXPECT_THAT(message(Gzip(std::string(17 << 20, ' '))), HasSubstr("larger than 16 MB"));
}

class MakeHumanHead : public testing::Test {
 protected:
  static StageResult<FaceRig> Import(const ImportOptions& options = {}) {
    auto imported = ImportRig(TestDataPath("makehuman/base.obj"), std::nullopt, options);
    EXPECT_TRUE(imported) << imported.error().message;
    return std::move(*imported);
  }
  static Eigen::Vector3d At(const FaceRig& rig, const std::string& landmark,
                            const Eigen::VectorXd& parameters) {
    return rig.Evaluate(parameters)[rig.FindLandmark(landmark).value()];
  }
  // How a landmark moves when one parameter goes from 0 to a value.
  static Eigen::Vector3d Motion(const FaceRig& rig, const std::string& landmark,
                                const std::string& parameter, double value) {
    Eigen::VectorXd parameters = Eigen::VectorXd::Zero(rig.num_parameters());
    const Eigen::Vector3d neutral = At(rig, landmark, parameters);
    parameters[rig.FindParameter(parameter).value()] = value;
    return At(rig, landmark, parameters) - neutral;
  }
};

TEST_F(MakeHumanHead, HasTheRigFrameAndTheSizeOfAHead) {
  ARTICAP_NEEDS_TEST_DATA("makehuman/base.obj");
  const FaceRig rig = Import().output;
  EXPECT_NEAR(MeasureHead(rig).height_mm, 231, 2);
  const Eigen::VectorXd neutral = Eigen::VectorXd::Zero(rig.num_parameters());
  const Eigen::Vector3d left = At(rig, "left_tragion", neutral);
  EXPECT_THAT(0.5 * (left + At(rig, "right_tragion", neutral)),
              PointNear(Eigen::Vector3d(0, 0, 0), 1e-9));
  EXPECT_NEAR(left.x(), 72, 1);
  EXPECT_GT(At(rig, "nose_tip", neutral).z(), 95);
  EXPECT_GT(At(rig, "crown", neutral).y(), 120);
}

TEST_F(MakeHumanHead, IsSymmetricInItsLandmarksAndParameters) {
  ARTICAP_NEEDS_TEST_DATA("makehuman/base.obj");
  const FaceRig rig = Import().output;
  const Eigen::VectorXd neutral = Eigen::VectorXd::Zero(rig.num_parameters());
  const Eigen::Vector3d mirror(-1, 1, 1);
  int pairs = 0;
  for (const Landmark& landmark : rig.definition().landmarks) {
    std::string other = landmark.name;
    const auto at = other.find("left");
    if (at == std::string::npos) continue;
    other.replace(at, 4, "right");
    ++pairs;
    EXPECT_THAT(At(rig, other, neutral),
                PointNear(At(rig, landmark.name, neutral).cwiseProduct(mirror), 1e-6))
        << landmark.name;
  }
  EXPECT_EQ(pairs, 19);
  // What the left stretch does on the left, the right one does on the right, and nothing beyond.
  const Eigen::Vector3d left = Motion(rig, "left_mouth_corner", "left_mouth_corner_stretch", 1);
  EXPECT_THAT(Motion(rig, "right_mouth_corner", "right_mouth_corner_stretch", 1),
              PointNear(left.cwiseProduct(mirror), 1e-6));
  EXPECT_GT(left.x(), 2);
  EXPECT_THAT(Motion(rig, "right_mouth_corner", "left_mouth_corner_stretch", 1),
              PointNear(Eigen::Vector3d(0, 0, 0), 1e-9));
}

TEST_F(MakeHumanHead, ParametersDoWhatTheirNamesSay) {
  ARTICAP_NEEDS_TEST_DATA("makehuman/base.obj");
  const auto [rig, report] = Import();
  EXPECT_TRUE(report.warnings.empty());
  for (const std::string_view name : kArticulatoryParameters)
    EXPECT_TRUE(rig.FindParameter(name)) << name;
  EXPECT_LT(Motion(rig, "chin", "jaw_rotation", 0.2).y(), -12);
  EXPECT_NEAR(Motion(rig, "lower_incisor", "jaw_rotation", 0.2).norm(), 0.2 * 89, 2);
  EXPECT_THAT(Motion(rig, "upper_incisor", "jaw_rotation", 0.2),
              PointNear(Eigen::Vector3d(0, 0, 0), 0));
  EXPECT_LT(Motion(rig, "nose_tip", "jaw_rotation", 0.2).norm(), 0.5);
  EXPECT_NEAR(Motion(rig, "lower_incisor", "jaw_thrust", 5).z(), 5, 1e-9);
  EXPECT_GT(Motion(rig, "chin", "jaw_shift", 5).x(), 4);
  EXPECT_LT(Motion(rig, "left_mouth_corner", "lip_rounding", 1).x(), -5);
  EXPECT_GT(Motion(rig, "upper_lip_center", "lip_rounding", 1).z(), 4);
  EXPECT_LT(Motion(rig, "upper_lip_center", "upper_lip_retraction", 1).z(), -3);
  EXPECT_GT(Motion(rig, "upper_lip_center", "upper_lip_raise", 1).y(), 3);
  EXPECT_LT(Motion(rig, "lower_lip_center", "upper_lip_raise", 1).norm(), 0.01);
  EXPECT_LT(Motion(rig, "lower_lip_center", "lower_lip_retraction", 1).z(), -3);
  EXPECT_LT(Motion(rig, "upper_lip_center", "lower_lip_retraction", 1).norm(), 0.01);
  EXPECT_LT(Motion(rig, "lower_lip_center", "lower_lip_depression", 1).y(), -7);
  EXPECT_LT(Motion(rig, "upper_lip_center", "lower_lip_depression", 1).norm(), 0.5);
}

TEST_F(MakeHumanHead, WithoutAJawJointItIsLinear) {
  ARTICAP_NEEDS_TEST_DATA("makehuman/base.obj");
  const auto [rig, report] = Import({.unit = "", .use_jaw_joint = false});
  EXPECT_FALSE(rig.definition().jaw);
  EXPECT_EQ(rig.num_parameters(), 8);
  EXPECT_THAT(report.warnings.front(), HasSubstr("jaw_thrust, jaw_shift"));
  const Eigen::Vector3d half = Motion(rig, "chin", "jaw_rotation", 0.5);
  EXPECT_THAT(Motion(rig, "chin", "jaw_rotation", 1.0), PointNear(2 * half, 1e-9));
  EXPECT_LT(half.y(), -8);
}

TEST_F(MakeHumanHead, LipRegionsMeetAtTheCornersAlone) {
  ARTICAP_NEEDS_TEST_DATA("makehuman/base.obj");
  const FaceRig rig = Import().output;
  const RigDefinition& definition = rig.definition();
  const auto vertices_of = [&](const char* region) {
    std::set<int> vertices;
    const int index = rig.FindRegion(region).value();
    for (std::size_t i = 0; i < definition.mesh.triangles.size(); ++i)
      if (definition.triangle_region[i] == index)
        for (const int corner : definition.mesh.triangles[i]) vertices.insert(corner);
    return vertices;
  };
  const std::set<int> upper = vertices_of("upper_lip");
  const std::set<int> lower = vertices_of("lower_lip");
  EXPECT_GT(upper.size(), 60u);
  EXPECT_GT(lower.size(), 60u);
  const double corner_x =
      rig.neutral_mesh().vertices[rig.FindLandmark("left_mouth_corner").value()].x();
  for (const int vertex : upper) {
    if (!lower.contains(vertex)) continue;
    EXPECT_GT(std::abs(rig.neutral_mesh().vertices[vertex].x()), corner_x - 3);
  }
  // Every landmark of a lip lies on its region.
  for (const char* name : {"upper_lip_center", "upper_lip_left", "upper_lip_right"})
    EXPECT_TRUE(upper.contains(rig.FindLandmark(name).value())) << name;
  for (const char* name : {"lower_lip_center", "lower_lip_left", "lower_lip_right"})
    EXPECT_TRUE(lower.contains(rig.FindLandmark(name).value())) << name;
  EXPECT_THAT(definition.region_names,
              IsSupersetOf({"skull", "nose", "upper_lip", "lower_lip", "jaw", "left_cheek",
                            "right_cheek", "neck", "inside"}));
}

TEST_F(MakeHumanHead, AnotherUnitIsNoticed) {
  ARTICAP_NEEDS_TEST_DATA("makehuman/base.obj");
  const auto refused = ImportRig(TestDataPath("makehuman/base.obj"), std::nullopt, {.unit = "mm"});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("decimetres; pass --unit dm"));
}

}  // namespace
}  // namespace articap
