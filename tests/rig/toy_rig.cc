// SPDX-License-Identifier: MIT
#include "tests/rig/toy_rig.h"

#include <cmath>

namespace articap {
namespace {

constexpr int kColumns = 15;  // from the speaker's right to the left
constexpr int kRows = 21;     // from the chin up; the mouth lies at row 8
constexpr int kMouthRow = 8;

Eigen::Vector3d SkinPoint(int column, int row) {
  constexpr int kMiddleColumn = kColumns / 2;
  const double x = 6.0 * (column - kMiddleColumn);
  const double y = 6.0 * (row - kMouthRow);
  return {x, y, 80 - 0.006 * x * x - 0.002 * y * y + 1.5 * std::sin(0.11 * x) * std::cos(0.09 * y)};
}

double Bump(double distance, double radius) {
  return distance >= radius ? 0 : 0.5 + 0.5 * std::cos(M_PI * distance / radius);
}

}  // namespace

FaceRig MakeToyRig() {
  RigDefinition rig;
  rig.name = "toy";
  rig.part_names = {"skin"};
  rig.region_names = {"skull", "upper_lip", "lower_lip", "jaw"};
  const auto vertex = [](int column, int row) { return row * kColumns + column; };
  WeightMap jaw{"jaw", {}}, lips{"lips", {}};
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const Eigen::Vector3d point = SkinPoint(column, row);
      rig.mesh.vertices.push_back(point);
      jaw.weights.push_back(1 / (1 + std::exp(0.15 * point.y() + 0.002 * point.x())));
      lips.weights.push_back(Bump(std::hypot(0.6 * point.x(), point.y()), 30));
    }
  for (int row = 0; row + 1 < kRows; ++row)
    for (int column = 0; column + 1 < kColumns; ++column) {
      const int a = vertex(column, row), b = vertex(column + 1, row);
      const int c = vertex(column + 1, row + 1), d = vertex(column, row + 1);
      rig.mesh.triangles.insert(rig.mesh.triangles.end(), {{a, b, c}, {a, c, d}});
      const int region = row >= kMouthRow + 3   ? 0
                         : row >= kMouthRow     ? 1
                         : row >= kMouthRow - 3 ? 2
                                                : 3;
      rig.triangle_region.insert(rig.triangle_region.end(), 2, static_cast<std::uint8_t>(region));
      rig.triangle_part.insert(rig.triangle_part.end(), 2, 0);
    }
  rig.mesh.vertices.push_back({0, 10, -20});  // the condyles
  rig.mesh.vertices.push_back({0, 0, 75});    // the centre of the mouth
  const int condyles = kColumns * kRows, mouth = condyles + 1;
  for (WeightMap* map : {&jaw, &lips}) map->weights.resize(rig.mesh.vertices.size(), 0);
  rig.weight_maps = {jaw, lips};
  rig.colors.assign(rig.mesh.vertices.size(), {0.8f, 0.6f, 0.5f});
  rig.landmarks = {{"chin", vertex(7, 1)},
                   {"nose_tip", vertex(7, 14)},
                   {"nose_bridge", vertex(7, 18)},
                   {"left_mouth_corner", vertex(11, kMouthRow)},
                   {"right_mouth_corner", vertex(3, kMouthRow)},
                   {"left_brow_middle", vertex(12, 20)},
                   {"right_brow_middle", vertex(2, 20)}};
  rig.parameters = {{"jaw_rotation", ParameterUnit::kRadian, -0.05, 0.3, "opens", "test"},
                    {"lip_rounding", ParameterUnit::kMillimetre, -5, 8, "protrudes", "test"},
                    {"lip_spread", ParameterUnit::kWeight, -0.3, 0.3, "spreads", "test"},
                    {"jaw_thrust", ParameterUnit::kMillimetre, -3, 4, "forward", "test"},
                    {"jaw_shift", ParameterUnit::kMillimetre, -4, 4, "left", "test"}};
  using Kind = WeightedTransform::Kind;
  rig.transforms = {{Kind::kTranslate, 1, 1, {0, 0.1, 1}, -1},
                    {Kind::kScale, 2, 1, {1, -0.2, 0}, mouth}};
  rig.jaw = JawJoint{.weight_map = 0,
                     .pivot_vertex = condyles,
                     .axis = Eigen::Vector3d::UnitX(),
                     .thrust_direction = Eigen::Vector3d(0, -0.1, 1).normalized(),
                     .shift_direction = Eigen::Vector3d::UnitX(),
                     .rotation_parameter = 0,
                     .thrust_parameter = 3,
                     .shift_parameter = 4};
  IdentitySlider width{"face_width", -1, 1, "+1 is 10 % wider", {}};
  for (std::size_t i = 0; i < rig.mesh.vertices.size(); ++i) {
    width.field.vertices.push_back(static_cast<int>(i));
    width.field.displacements_mm.push_back({0.1 * rig.mesh.vertices[i].x(), 0, 0});
  }
  rig.identity_sliders = {width};
  return FaceRig::Create(std::move(rig)).value();
}

}  // namespace articap
