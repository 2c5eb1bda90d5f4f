// SPDX-License-Identifier: MIT
#include "tests/synthetic/patch_face.h"

#include <cmath>

namespace articap {
namespace {

constexpr int kColumns = 13;  // from the speaker's right to the left, 8 mm apart
constexpr int kRows = 9;      // of each sheet, 6 mm apart
constexpr int kMiddle = kColumns / 2;

enum RegionIndex : std::uint8_t { kSkull, kUpperLip, kLowerLip, kJaw };

double DepthAt(double x, double y) { return 90 - 0.006 * x * x - 0.002 * y * y; }

double Bump(double distance, double radius) {
  const double x = distance / radius;
  return x >= 1 ? 0 : (1 - x * x) * (1 - x * x);
}

// Adds a sheet whose row 0 lies at `y0`; rows go up for direction +1, down for -1. Returns its
// first vertex.
int AddSheet(double y0, int direction, RegionIndex near, RegionIndex far, RigDefinition* rig) {
  const int first = static_cast<int>(rig->mesh.vertices.size());
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double x = 8.0 * (column - kMiddle), y = y0 + direction * 6.0 * row;
      rig->mesh.vertices.push_back({x, y, DepthAt(x, y)});
    }
  for (int row = 0; row + 1 < kRows; ++row)
    for (int column = 0; column + 1 < kColumns; ++column) {
      const int a = first + row * kColumns + column, b = a + 1, c = b + kColumns, d = a + kColumns;
      if (direction > 0)
        rig->mesh.triangles.insert(rig->mesh.triangles.end(), {{a, b, c}, {a, c, d}});
      else
        rig->mesh.triangles.insert(rig->mesh.triangles.end(), {{a, c, b}, {a, d, c}});
      rig->triangle_region.insert(rig->triangle_region.end(), 2, row < 3 ? near : far);
      rig->triangle_part.insert(rig->triangle_part.end(), 2, 0);
    }
  return first;
}

void AddSpectacles(RigDefinition* rig) {
  const std::vector<Eigen::Vector3d> corners = {{0, 75, 105}, {60, 80, 70}, {-60, 80, 70}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int v = static_cast<int>(rig->mesh.vertices.size());
    rig->mesh.vertices.insert(
        rig->mesh.vertices.end(),
        {corners[i], corners[i] + Eigen::Vector3d(4, 0, 0), corners[i] + Eigen::Vector3d(0, 4, 0)});
    rig->mesh.triangles.push_back({v, v + 1, v + 2});
    rig->triangle_region.push_back(kSkull);
    rig->triangle_part.push_back(1);
    rig->landmarks.push_back({"spectacles_" + std::to_string(i + 1), v});
  }
}

}  // namespace

FaceRig MakePatchFace() {
  RigDefinition rig;
  rig.name = "patch";
  rig.part_names = {"skin", "spectacles"};
  rig.region_names = {"skull", "upper_lip", "lower_lip", "jaw"};
  const int upper = AddSheet(0, 1, kUpperLip, kSkull, &rig);
  const int lower = AddSheet(0, -1, kLowerLip, kJaw, &rig);
  const int upper_end = lower;
  const int skin_end = static_cast<int>(rig.mesh.vertices.size());
  AddSpectacles(&rig);
  const int condyles = static_cast<int>(rig.mesh.vertices.size());
  rig.mesh.vertices.push_back({0, 50, -5});
  const int mouth = condyles + 1;
  rig.mesh.vertices.push_back({0, 0, 90});

  const std::size_t num_vertices = rig.mesh.vertices.size();
  rig.colors.assign(num_vertices, {0.8f, 0.6f, 0.5f});
  enum MapIndex { kJawMap, kMouthMap, kUpperMap, kLowerMap, kLeftMap, kRightMap };
  for (const char* name : {"jaw", "mouth", "upper", "lower", "left", "right"})
    rig.weight_maps.push_back({name, std::vector<double>(num_vertices, 0)});
  for (int v = 0; v < skin_end; ++v) {
    const Eigen::Vector3d p = rig.mesh.vertices[v];
    const double near_mouth = Bump(std::hypot(p.x(), p.y()), 42);
    const auto weight = [&](MapIndex map) -> double& { return rig.weight_maps[map].weights[v]; };
    if (v >= upper_end) weight(kJawMap) = std::exp(-std::pow(p.x() / 40, 4));
    weight(kMouthMap) = near_mouth;
    weight(v < upper_end ? kUpperMap : kLowerMap) = near_mouth;
    weight(kLeftMap) = Bump(std::hypot(p.x() - 24, p.y()), 30);
    weight(kRightMap) = Bump(std::hypot(p.x() + 24, p.y()), 30);
  }
  const auto mm = ParameterUnit::kMillimetre;
  rig.parameters = {{"jaw_rotation", ParameterUnit::kRadian, -0.02, 0.25, "opens", "test"},
                    {"lip_rounding", ParameterUnit::kWeight, -0.2, 1, "rounds", "test"},
                    {"upper_lip_retraction", mm, -6, 4, "back", "test"},
                    {"upper_lip_raise", mm, -4, 8, "up", "test"},
                    {"lower_lip_retraction", mm, -6, 5, "back", "test"},
                    {"lower_lip_depression", mm, -14, 10, "down", "test"},
                    {"left_mouth_corner_stretch", mm, -6, 10, "out", "test"},
                    {"right_mouth_corner_stretch", mm, -6, 10, "out", "test"},
                    {"jaw_thrust", mm, -3, 5, "forward", "test"},
                    {"jaw_shift", mm, -5, 5, "left", "test"}};
  using Kind = WeightedTransform::Kind;
  rig.transforms = {{Kind::kScale, 1, kMouthMap, {-0.35, 0, 0}, mouth},
                    {Kind::kTranslate, 1, kMouthMap, {0, 0, 4}, -1},
                    {Kind::kTranslate, 2, kUpperMap, {0, 0, -1}, -1},
                    {Kind::kTranslate, 3, kUpperMap, {0, 1, 0.1}, -1},
                    {Kind::kTranslate, 4, kLowerMap, {0, 0, -1}, -1},
                    {Kind::kTranslate, 5, kLowerMap, {0, -1, 0.1}, -1},
                    {Kind::kTranslate, 6, kLeftMap, {1, 0.1, -0.4}, -1},
                    {Kind::kTranslate, 7, kRightMap, {-1, 0.1, -0.4}, -1}};
  rig.jaw = JawJoint{.weight_map = kJawMap,
                     .pivot_vertex = condyles,
                     .rotation_parameter = 0,
                     .thrust_parameter = 8,
                     .shift_parameter = 9};
  const auto at = [](int sheet, int column, int row) { return sheet + row * kColumns + column; };
  const std::vector<Landmark> face = {{"upper_lip_center", at(upper, kMiddle, 1)},
                                      {"lower_lip_center", at(lower, kMiddle, 1)},
                                      {"left_mouth_corner", at(upper, kMiddle + 3, 0)},
                                      {"right_mouth_corner", at(upper, kMiddle - 3, 0)},
                                      {"lower_lip_left", at(lower, kMiddle + 2, 1)},
                                      {"lower_lip_right", at(lower, kMiddle - 2, 1)},
                                      {"chin", at(lower, kMiddle, 7)},
                                      {"jaw_left", at(lower, kMiddle + 3, 6)},
                                      {"nose_tip", at(upper, kMiddle, 5)}};
  rig.landmarks.insert(rig.landmarks.end(), face.begin(), face.end());
  IdentitySlider width{"face_width", -1, 1, "+1 is 10 % wider", {}};
  for (std::size_t v = 0; v < num_vertices; ++v) {
    width.field.vertices.push_back(static_cast<int>(v));
    width.field.displacements_mm.push_back({0.1 * rig.mesh.vertices[v].x(), 0, 0});
  }
  rig.identity_sliders = {width};
  return FaceRig::Create(std::move(rig)).value();
}

MarkerSet PatchFaceMarkers() {
  MarkerSet set;
  set.name = "patch";
  for (int i = 1; i <= 3; ++i) {
    const std::string number = std::to_string(i);
    set.markers.push_back(
        {.name = "s" + number, .head_reference = true, .landmark = "spectacles_" + number});
  }
  for (const char* landmark :
       {"upper_lip_center", "lower_lip_center", "left_mouth_corner", "right_mouth_corner",
        "lower_lip_left", "lower_lip_right", "chin", "jaw_left", "nose_tip"})
    set.markers.push_back({.name = landmark, .face = true, .landmark = landmark, .offset_mm = 2});
  return set;
}

}  // namespace articap
