// SPDX-License-Identifier: MIT
#include "rig/default_head/default_head.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "rig/default_head/rig_file.h"

namespace articap {
namespace {

using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;

using Positions = std::vector<Eigen::Vector3d>;

const FaceRig& Head() {
  static const FaceRig head = MakeDefaultHead().value();
  return head;
}

int Parameter(const std::string& name) { return Head().FindParameter(name).value(); }
int Vertex(const std::string& landmark) { return Head().FindLandmark(landmark).value(); }
Eigen::Vector3d Neutral(const std::string& landmark) {
  return Head().neutral_mesh().vertices[Vertex(landmark)];
}

Positions Pose(const std::map<std::string, double>& values) {
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(Head().num_parameters());
  for (const auto& [name, value] : values) parameters[Parameter(name)] = value;
  return Head().Evaluate(parameters);
}

// How a landmark moves per unit of a parameter, near neutral.
Eigen::Vector3d Effect(const std::string& parameter, const std::string& landmark) {
  constexpr double kStep = 1e-4;
  const int vertex = Vertex(landmark);
  return (Pose({{parameter, kStep}})[vertex] - Pose({{parameter, -kStep}})[vertex]) / (2 * kStep);
}

FaceRig WithSlider(const std::string& name, double value) {
  const auto& sliders = Head().definition().identity_sliders;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<int>(sliders.size()));
  for (std::size_t i = 0; i < sliders.size(); ++i)
    if (sliders[i].name == name) values[static_cast<int>(i)] = value;
  EXPECT_NE(values.norm(), 0) << name;
  return Head().WithIdentity(values);
}

Eigen::Vector3d Cross(const Positions& vertices, const Eigen::Vector3i& triangle) {
  return (vertices[triangle[1]] - vertices[triangle[0]])
      .cross(vertices[triangle[2]] - vertices[triangle[0]]);
}

int RegionOf(std::size_t triangle) { return Head().definition().triangle_region[triangle]; }

std::set<int> VerticesOfRegion(const std::string& name) {
  const int region = Head().FindRegion(name).value();
  std::set<int> vertices;
  for (std::size_t i = 0; i < Head().neutral_mesh().triangles.size(); ++i)
    if (RegionOf(i) == region)
      for (const int vertex : Head().neutral_mesh().triangles[i].reshaped())
        vertices.insert(vertex);
  return vertices;
}

// Pairs of an upper and a lower vertex that coincide: the seam of the closed lips.
std::vector<std::pair<int, int>> SeamPairs() {
  const std::set<int> upper = VerticesOfRegion("upper_lip");
  const std::set<int> lower = VerticesOfRegion("lower_lip");
  std::map<std::tuple<double, double, double>, int> upper_at;
  const Positions& vertices = Head().neutral_mesh().vertices;
  const auto key = [&](int v) {
    return std::tuple(vertices[v].x(), vertices[v].y(), vertices[v].z());
  };
  for (const int vertex : upper) upper_at[key(vertex)] = vertex;
  std::vector<std::pair<int, int>> pairs;
  for (const int vertex : lower)
    if (const auto found = upper_at.find(key(vertex));
        found != upper_at.end() && found->second != vertex)
      pairs.emplace_back(found->second, vertex);
  return pairs;
}

TEST(DefaultHead, IsTheSameAtEveryCall) {
  const FaceRig again = MakeDefaultHead().value();
  EXPECT_EQ(again.neutral_mesh().vertices, Head().neutral_mesh().vertices);
  EXPECT_EQ(again.neutral_mesh().triangles, Head().neutral_mesh().triangles);
  ASSERT_EQ(again.definition().weight_maps.size(), Head().definition().weight_maps.size());
  for (std::size_t i = 0; i < again.definition().weight_maps.size(); ++i)
    EXPECT_EQ(again.definition().weight_maps[i].weights,
              Head().definition().weight_maps[i].weights);
}

TEST(DefaultHead, HasTheTenParametersInTheirOrder) {
  std::vector<std::string> names;
  for (const RigParameter& parameter : Head().definition().parameters) {
    names.push_back(parameter.name);
    EXPECT_LT(parameter.min, 0) << parameter.name;
    EXPECT_GT(parameter.max, 0) << parameter.name;
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
    EXPECT_FALSE(parameter.source.empty()) << parameter.name;
  }
  EXPECT_THAT(names, ElementsAre("jaw_rotation", "lip_rounding", "upper_lip_retraction",
                                 "upper_lip_raise", "lower_lip_retraction", "lower_lip_depression",
                                 "left_mouth_corner_stretch", "right_mouth_corner_stretch",
                                 "jaw_thrust", "jaw_shift"));
}

TEST(DefaultHead, IsMirrorSymmetricToTheBit) {
  const TriangleMesh& mesh = Head().neutral_mesh();
  // Points where several vertices meet (the lips' seam) get a partner per vertex by their
  // triangles: so compare triangles as the points of their corners, rotated to a canonical start.
  using Point = std::array<double, 3>;
  const auto triangle_key = [&](const Eigen::Vector3i& t, bool mirrored) {
    std::array<Point, 3> corners;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d& p = mesh.vertices[mirrored ? t[2 - i] : t[i]];
      corners[i] = {mirrored && p.x() != 0 ? -p.x() : p.x(), p.y(), p.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return corners;
  };
  std::multiset<std::array<Point, 3>> triangles, mirrored;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    triangles.insert(triangle_key(triangle, false));
    mirrored.insert(triangle_key(triangle, true));
  }
  EXPECT_EQ(triangles, mirrored);
}

TEST(DefaultHead, MovesAndVariesSymmetrically) {
  // A pose and its mirror image, with an identity: every vertex has its partner.
  const auto points = [](const FaceRig& rig, double left, double right, double shift, double sign) {
    Eigen::VectorXd p = Eigen::VectorXd::Zero(rig.num_parameters());
    p << 0.1, 2, 1, 1, 1, 2, left, right, 1, shift;
    std::multiset<std::array<double, 3>> set;
    // Rounded to 1e-9 mm: the sums of the two sides run in another order.
    for (const Eigen::Vector3d& v : rig.Evaluate(p))
      set.insert(
          {std::round(sign * v.x() * 1e9) + 0.0, std::round(v.y() * 1e9), std::round(v.z() * 1e9)});
    return set;
  };
  const FaceRig rig = Head().WithIdentity(Eigen::VectorXd::Constant(
      static_cast<int>(Head().definition().identity_sliders.size()), 0.05));
  EXPECT_EQ(points(rig, 3, -2, 1.5, 1), points(rig, -2, 3, -1.5, -1));
}

TEST(DefaultHead, HasTheSizesOfAnAverageAdult) {
  struct Distance {
    const char *from, *to;
    double mean_mm, tolerance_mm;
  };
  // Means of the table in docs/default-head.md; tolerances of about half a standard deviation of
  // adults, which also covers that landmarks are vertices.
  constexpr Distance kDistances[] = {{"left_mouth_corner", "right_mouth_corner", 51, 0.5},
                                     {"left_eye_inner", "right_eye_inner", 32, 1},
                                     {"left_eye_outer", "right_eye_outer", 90, 1},
                                     {"left_eye_center", "right_eye_center", 63, 0.1},
                                     {"nose_left", "nose_right", 34, 2},
                                     {"nose_bridge", "menton", 118, 2.5},
                                     {"subnasale", "menton", 70, 2.5},
                                     {"left_jaw_angle", "right_jaw_angle", 105, 2},
                                     {"brow_center", "back_of_head", 190, 5},
                                     {"jaw_pivot", "lower_incisor", 100, 3}};
  for (const Distance& distance : kDistances)
    EXPECT_NEAR((Neutral(distance.from) - Neutral(distance.to)).norm(), distance.mean_mm,
                distance.tolerance_mm)
        << distance.from << " to " << distance.to;
  EXPECT_NEAR(Neutral("nose_tip").z() - Neutral("subnasale").z(), 20, 2) << "nose protrusion";
  const double stomion_y = Head().neutral_mesh().vertices[SeamPairs().front().first].y();
  EXPECT_NEAR(Neutral("upper_lip_center").y() - stomion_y, 8, 1) << "upper vermilion";
  EXPECT_NEAR(stomion_y - Neutral("lower_lip_center").y(), 9, 1) << "lower vermilion";
}

TEST(DefaultHead, HasItsOriginBetweenTheTragia) {
  const Eigen::Vector3d middle = 0.5 * (Neutral("left_tragion") + Neutral("right_tragion"));
  EXPECT_THAT(middle.norm(), Le(3.5));
  EXPECT_THAT(Neutral("left_tragion").x(), Gt(60));
}

TEST(DefaultHead, OpensAtTheIncisorsAsAJawDoes) {
  const Positions open = Pose({{"jaw_rotation", 14 * std::numbers::pi / 180}});
  EXPECT_NEAR((open[Vertex("lower_incisor")] - Neutral("lower_incisor")).norm(), 25, 1.5);
  EXPECT_EQ(open[Vertex("upper_incisor")], Neutral("upper_incisor"));
}

TEST(DefaultHead, MovesLandmarksByTheParametersUnits) {
  const auto expect = [](const char* parameter, const char* landmark,
                         const Eigen::Vector3d& effect) {
    EXPECT_LT((Effect(parameter, landmark) - effect).norm(), 1e-6)
        << parameter << " at " << landmark << ": " << Effect(parameter, landmark).transpose();
  };
  expect("upper_lip_raise", "upper_lip_center", {0, 1, 0});
  expect("upper_lip_retraction", "upper_lip_center", {0, 0, -1});
  expect("lower_lip_retraction", "lower_lip_center", {0, 0, -1});
  expect("lower_lip_depression", "lower_lip_center", {0, -1, 0});
  expect("jaw_thrust", "lower_incisor", {0, 0, 1});
  expect("jaw_shift", "lower_incisor", {1, 0, 0});
  expect("jaw_shift", "chin", {1, 0, 0});
  expect("jaw_thrust", "chin", {0, 0, 1});
  EXPECT_NEAR(Effect("left_mouth_corner_stretch", "left_mouth_corner").norm(), 1, 1e-6);
  EXPECT_NEAR(Effect("right_mouth_corner_stretch", "right_mouth_corner").norm(), 1, 1e-6);
  EXPECT_NEAR(Effect("lip_rounding", "upper_lip_center").z(), 1, 1e-6);
  EXPECT_NEAR(Effect("lip_rounding", "lower_lip_center").z(), 1, 1e-6);
}

TEST(DefaultHead, KeepsWhatAParameterDoesNotConcernStill) {
  for (const char* landmark : {"chin", "left_mouth_corner", "lower_lip_center", "nose_tip"})
    EXPECT_LT(Effect("upper_lip_raise", landmark).norm(), 0.15) << landmark;
  EXPECT_LT(Effect("lower_lip_depression", "chin").norm(), 0.1);
  EXPECT_EQ(Effect("left_mouth_corner_stretch", "right_mouth_corner").norm(), 0);
  for (const RigParameter& parameter : Head().definition().parameters)
    for (const char* landmark :
         {"spectacles_1", "spectacles_2", "spectacles_3", "spectacles_4", "spectacles_5",
          "left_tragion", "brow_center", "crown", "left_eye_upper", "upper_incisor", "nose_bridge"})
      EXPECT_EQ(Effect(parameter.name, landmark).norm(), 0) << parameter.name << " " << landmark;
}

TEST(DefaultHead, GoesHalfWayWithTheJawAtTheCorners) {
  EXPECT_NEAR(Head().jaw_weight(Vertex("left_mouth_corner")), 0.5, 0.03);
  EXPECT_NEAR(Head().jaw_weight(Vertex("lower_lip_center")), 1, 0.03);
  EXPECT_NEAR(Head().jaw_weight(Vertex("upper_lip_center")), 0, 0.03);
  EXPECT_NEAR(Head().jaw_weight(Vertex("chin_left")), 1, 0.02);
  EXPECT_NEAR(Head().jaw_weight(Vertex("menton")), 1, 0.05);
  const double cheek = Head().jaw_weight(Vertex("left_cheek_lower"));
  EXPECT_GT(cheek, 0.2);
  EXPECT_LT(cheek, 0.8);
}

TEST(DefaultHead, ClosesItsLipsExactly) {
  // Both halves' columns and the midline, without the corners, where the lips are one.
  EXPECT_THAT(SeamPairs().size(), Ge(25u));
}

TEST(DefaultHead, NeverCrossesItsLipsAsItSpeaks) {
  const auto least_gap = [](const Positions& posed) {
    double least = 1e9;
    for (const auto& [upper, lower] : SeamPairs())
      least = std::min(least, posed[upper].y() - posed[lower].y());
    return least;
  };
  for (double rotation = 0; rotation <= 0.28; rotation += 0.02)
    for (const double rounding : {0.0, 4.0, 8.0})
      for (const double raise : {0.0, 4.0})
        EXPECT_THAT(least_gap(Pose({{"jaw_rotation", rotation},
                                    {"lip_rounding", rounding},
                                    {"upper_lip_raise", raise}})),
                    Ge(-1e-9))
            << rotation << " rad, " << rounding << " mm, " << raise << " mm";
}

TEST(DefaultHead, ClosesItsLipsOverAnOpenJaw) {
  // A bilabial with the teeth 10 mm apart.
  const double rotation = 0.10;
  const Positions open = Pose({{"jaw_rotation", rotation}});
  const Positions closed = Pose({{"jaw_rotation", rotation}, {"lower_lip_depression", -10}});
  const auto gap = [](const Positions& posed) {
    double widest = -1e9;
    for (const auto& [upper, lower] : SeamPairs())
      widest = std::max(widest, posed[upper].y() - posed[lower].y());
    return widest;
  };
  EXPECT_GT(gap(open), 8);
  EXPECT_LT(gap(closed), 2);
}

TEST(DefaultHead, HasNoDegenerateTriangles) {
  for (const Eigen::Vector3i& triangle : Head().neutral_mesh().triangles)
    EXPECT_GT(0.5 * Cross(Head().neutral_mesh().vertices, triangle).norm(), 0.01);
}

TEST(DefaultHead, FacesOutwards) {
  const TriangleMesh& mesh = Head().neutral_mesh();
  const std::vector<Eigen::Vector3d> normals = VertexNormals(mesh);
  for (const char* landmark : {"nose_tip", "chin", "brow_center", "forehead_left",
                               "left_cheek_middle", "lower_lip_center", "upper_lip_center"})
    EXPECT_GT(normals[Vertex(landmark)].z(), 0.1) << landmark;
  EXPECT_GT(normals[Vertex("left_tragion")].x(), 0.5);
  EXPECT_GT(normals[Vertex("crown")].y(), 0.5);
  EXPECT_LT(normals[Vertex("back_of_head")].z(), -0.5);
}

// Turning by less than a right angle and keeping a part of the area: neither folded nor collapsed.
void ExpectNoFolds(const Positions& posed, const std::string& what) {
  const TriangleMesh& mesh = Head().neutral_mesh();
  int folded = 0;
  double least_area = 1;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Eigen::Vector3d before = Cross(mesh.vertices, triangle);
    const Eigen::Vector3d after = Cross(posed, triangle);
    if (before.dot(after) <= 0) ++folded;
    least_area = std::min(least_area, after.norm() / before.norm());
  }
  EXPECT_EQ(folded, 0) << what;
  EXPECT_GT(least_area, 0.1) << what;
}

TEST(DefaultHead, DoesNotFoldAtTheExtremesOfItsParameters) {
  for (const RigParameter& parameter : Head().definition().parameters)
    for (const double value : {parameter.min, parameter.max})
      ExpectNoFolds(Pose({{parameter.name, value}}), parameter.name + " " + std::to_string(value));
}

TEST(DefaultHead, DoesNotFoldAtTheExtremesOfItsIdentities) {
  for (const IdentitySlider& slider : Head().definition().identity_sliders)
    for (const double value : {slider.min, slider.max})
      ExpectNoFolds(WithSlider(slider.name, value).neutral_mesh().vertices,
                    slider.name + " " + std::to_string(value));
}

TEST(DefaultHead, VariesByTheSizesItsSlidersName) {
  const auto distance = [](const FaceRig& rig, const char* a, const char* b) {
    const Positions& v = rig.neutral_mesh().vertices;
    return (v[Vertex(a)] - v[Vertex(b)]).norm();
  };
  const auto ratio = [&](const FaceRig& rig, const char* a, const char* b) {
    return distance(rig, a, b) / distance(Head(), a, b);
  };
  const FaceRig wide = WithSlider("face_width", 0.08);
  EXPECT_NEAR(ratio(wide, "left_mouth_corner", "right_mouth_corner"), 1.08, 1e-9);
  EXPECT_NEAR(ratio(wide, "spectacles_2", "spectacles_4"), 1.08, 1e-9);
  EXPECT_NEAR(ratio(WithSlider("jaw_length", 0.10), "jaw_pivot", "menton"), 1.10, 0.005);
  EXPECT_NEAR(ratio(WithSlider("jaw_length", 0.10), "jaw_pivot", "lower_incisor"), 1, 1e-9);
  const FaceRig long_face = WithSlider("face_length", 0.05);
  const auto height = [](const FaceRig& rig, const char* landmark) {
    return rig.neutral_mesh().vertices[Vertex(landmark)].y();
  };
  EXPECT_NEAR(height(long_face, "menton") / height(Head(), "menton"), 1.05, 1e-9);

  const FaceRig full = WithSlider("lip_thickness", 0.30);
  const double seam_y = Head().neutral_mesh().vertices[SeamPairs().front().first].y();
  EXPECT_NEAR(
      (height(full, "upper_lip_center") - seam_y) / (Neutral("upper_lip_center").y() - seam_y),
      1.30, 0.03);
  EXPECT_NEAR(
      (height(full, "lower_lip_center") - seam_y) / (Neutral("lower_lip_center").y() - seam_y),
      1.30, 0.03);

  const auto protrusion = [](const FaceRig& rig) {
    const Positions& v = rig.neutral_mesh().vertices;
    return v[Vertex("nose_tip")].z() - v[Vertex("subnasale")].z();
  };
  EXPECT_NEAR(protrusion(WithSlider("nose", 0.20)) / protrusion(Head()), 1.20, 0.03);
  const FaceRig browed = WithSlider("brow", 1);
  const double forward =
      browed.neutral_mesh().vertices[Vertex("brow_center")].z() - Neutral("brow_center").z();
  EXPECT_NEAR(forward, 3, 0.3);
}

TEST(DefaultHead, ClosesItsLipsInEveryIdentity) {
  for (const IdentitySlider& slider : Head().definition().identity_sliders) {
    const Positions vertices = WithSlider(slider.name, slider.max).neutral_mesh().vertices;
    for (const auto& [upper, lower] : SeamPairs())
      EXPECT_LT((vertices[upper] - vertices[lower]).norm(), 1e-12) << slider.name;
  }
}

TEST(DefaultHead, KeepsTheLipsApartAsRegions) {
  // A marker on one lip must not find a triangle of the other: no triangle of a region has vertices
  // on the other lip's outside.
  for (const auto& [name, sign] : {std::pair("upper_lip", 1), std::pair("lower_lip", -1)}) {
    const int region = Head().FindRegion(name).value();
    const TriangleMesh& mesh = Head().neutral_mesh();
    int count = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (RegionOf(i) != region) continue;
      ++count;
      const Eigen::Vector3i& t = mesh.triangles[i];
      const Eigen::Vector3d middle =
          (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
      EXPECT_GT(sign * (middle.y() + 53.8), -2.0) << name << " at " << middle.transpose();
    }
    EXPECT_GT(count, 200) << name;
  }
  std::vector<int> shared;
  const std::set<int> upper = VerticesOfRegion("upper_lip"), lower = VerticesOfRegion("lower_lip");
  std::set_intersection(upper.begin(), upper.end(), lower.begin(), lower.end(),
                        std::back_inserter(shared));
  for (const int vertex : shared)  // the row of vertices outwards from each corner of the mouth
    EXPECT_GT(std::abs(Head().neutral_mesh().vertices[vertex].x()), 23);
}

TEST(DefaultHead, HasEveryRegionAndPart) {
  std::set<int> regions, parts;
  for (std::size_t i = 0; i < Head().neutral_mesh().triangles.size(); ++i) {
    regions.insert(RegionOf(i));
    parts.insert(Head().definition().triangle_part[i]);
  }
  EXPECT_EQ(regions.size(), Head().definition().region_names.size());
  EXPECT_EQ(parts.size(), Head().definition().part_names.size());
}

// The layout of the fitting tests: lips, chin, jaw line, cheeks, nose.
TEST(DefaultHead, HasParametersThatThirtyMarkersTellApart) {
  const std::vector<std::string> markers{"left_mouth_corner",
                                         "right_mouth_corner",
                                         "upper_lip_center",
                                         "lower_lip_center",
                                         "upper_lip_left",
                                         "upper_lip_right",
                                         "lower_lip_left",
                                         "lower_lip_right",
                                         "chin",
                                         "menton",
                                         "chin_left",
                                         "chin_right",
                                         "jaw_left",
                                         "jaw_right",
                                         "left_jaw_angle",
                                         "right_jaw_angle",
                                         "left_cheek",
                                         "right_cheek",
                                         "left_cheek_middle",
                                         "right_cheek_middle",
                                         "left_cheek_lower",
                                         "right_cheek_lower",
                                         "nose_tip",
                                         "nose_left",
                                         "nose_right",
                                         "subnasale",
                                         "left_brow_inner",
                                         "right_brow_inner",
                                         "left_brow_outer",
                                         "right_brow_outer"};
  Eigen::MatrixXd jacobian(3 * markers.size(), Head().num_parameters());
  for (int p = 0; p < Head().num_parameters(); ++p)
    for (std::size_t m = 0; m < markers.size(); ++m)
      jacobian.block<3, 1>(static_cast<int>(3 * m), p) =
          Effect(Head().definition().parameters[p].name, markers[m]);
  // A sigma of 0.2 mm at each marker leaves at most 0.4 mm (rad: 0.004) on any parameter.
  const Eigen::MatrixXd covariance = (jacobian.transpose() * jacobian).inverse() * 0.2 * 0.2;
  for (int p = 0; p < Head().num_parameters(); ++p)
    EXPECT_LT(std::sqrt(covariance(p, p)), p == 0 ? 0.004 : 0.4)
        << Head().definition().parameters[p].name;
  jacobian.colwise().normalize();
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(jacobian).singularValues();
  RecordProperty("condition", std::to_string(values[0] / values[values.size() - 1]));
  EXPECT_LT(values[0] / values[values.size() - 1], 15);
}

TEST(DefaultHeadRigFile, SaysWhereAFieldIsMissing) {
  const auto broken = default_head::ParseRigFile(
      "[[parameter]]\nname = \"jaw_rotation\"\nunit = \"feet\"\n", "rig.toml");
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().message, HasSubstr("rig.toml, line 1"));
  EXPECT_THAT(broken.error().message, HasSubstr("unit"));
  EXPECT_FALSE(default_head::ParseRigFile("name = [", "rig.toml"));
}

}  // namespace
}  // namespace articap
