// SPDX-License-Identifier: MIT
#include "tracking/head_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>

namespace articap {
namespace {

// On the midline, in order of preference.
constexpr std::array<std::string_view, 6> kLower = {
    "chin", "menton", "lower_incisor", "subnasale", "lower_lip_center", "nose_tip"};
constexpr std::array<std::string_view, 3> kUpper = {"nose_bridge", "brow_center",
                                                    "forehead_center"};
// Left of a symmetric pair; the eyes first, then the mouth.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kPairs = {{
    {"left_eye_outer", "right_eye_outer"},
    {"left_eye_inner", "right_eye_inner"},
    {"left_mouth_corner", "right_mouth_corner"},
    {"left_tragion", "right_tragion"},
    {"left_brow_outer", "right_brow_outer"},
    {"left_brow_inner", "right_brow_inner"},
    {"left_jaw_angle", "right_jaw_angle"},
    {"left_cheek", "right_cheek"},
}};

class Landmarks {
 public:
  explicit Landmarks(const std::vector<PlacedLandmark>& placed) : placed_(placed) {}

  const PlacedLandmark* At(std::string_view landmark) const {
    const auto found = std::ranges::find(placed_, landmark, &PlacedLandmark::landmark);
    return found == placed_.end() ? nullptr : &*found;
  }
  const PlacedLandmark* FirstOf(std::span<const std::string_view> names) const {
    for (const std::string_view name : names)
      if (const PlacedLandmark* landmark = At(name)) return landmark;
    return nullptr;
  }
  std::pair<const PlacedLandmark*, const PlacedLandmark*> FirstPair() const {
    for (const auto& [left_name, right_name] : kPairs) {
      const PlacedLandmark* left = At(left_name);
      const PlacedLandmark* right = At(right_name);
      if (left && right) return {left, right};
    }
    return {nullptr, nullptr};
  }

 private:
  const std::vector<PlacedLandmark>& placed_;
};

}  // namespace

Eigen::Quaterniond HeadFromStage(const DeclaredAxes& axes) {
  Eigen::Matrix3d head_from_stage;
  head_from_stage << axes.left_in_stage.transpose(), axes.up_in_stage.transpose(),
      axes.forward_in_stage.transpose();
  return Eigen::Quaterniond(head_from_stage).normalized();
}

Result<HeadAxes> FindHeadAxes(const std::vector<PlacedLandmark>& placed,
                              const std::optional<DeclaredAxes>& declared,
                              const Eigen::Quaterniond& stage_from_shape,
                              const Eigen::Vector3d& reference_centroid_mm) {
  const Landmarks landmarks(placed);
  const PlacedLandmark* lower = landmarks.FirstOf(kLower);
  const PlacedLandmark* upper = landmarks.FirstOf(kUpper);
  const auto [left, right] = landmarks.FirstPair();

  HeadAxes axes;
  if (lower && upper && left) {
    const Eigen::Vector3d y = (upper->point_mm - lower->point_mm).normalized();
    const Eigen::Vector3d across = (left->point_mm - right->point_mm).normalized();
    if (constexpr double kLargestCosine = 0.7; std::abs(across.dot(y)) > kLargestCosine)
      return Fail(fmt::format(
          "the line from '{}' to '{}' (up) and that from '{}' to '{}' (left) are only {:.0f} "
          "degrees apart, which no face is: check the names of these markers and their landmarks",
          lower->marker, upper->marker, right->marker, left->marker,
          std::acos(std::min(std::abs(across.dot(y)), 1.0)) * 180 / std::numbers::pi));
    const Eigen::Vector3d x = (across - across.dot(y) * y).normalized();
    Eigen::Matrix3d head_from_shape;
    head_from_shape << x.transpose(), y.transpose(), x.cross(y).transpose();
    axes.head_from_shape.rotation = Eigen::Quaterniond(head_from_shape).normalized();
    axes.axes = fmt::format("y from {} to {}, x from {} to {}", lower->marker, upper->marker,
                            right->marker, left->marker);
  } else if (declared) {
    axes.head_from_shape.rotation = (HeadFromStage(*declared) * stage_from_shape).normalized();
    axes.axes = "as declared, for the head's mean orientation";
  } else {
    return Fail(fmt::format(
        "the axes of the head cannot be found: the markers show {}. Give markers the landmarks "
        "chin, "
        "nose_bridge and left_ and right_eye_outer (or _eye_inner, _mouth_corner) in the map, or "
        "declare the axes left, up and forward (--left +x --up +y --forward +z, or [head] in the "
        "map), or give a reference shape (--shape)",
        !lower || !upper ? "no line from the chin up to the nose bridge"
                         : "no left and right corner of the eyes or the mouth"));
  }

  const PlacedLandmark* bridge = landmarks.At("nose_bridge");
  axes.origin = bridge ? bridge->marker : "centroid of the references";
  const Eigen::Vector3d origin_mm = bridge ? bridge->point_mm : reference_centroid_mm;
  axes.head_from_shape.translation_mm = -(axes.head_from_shape.rotation * origin_mm);
  return axes;
}

}  // namespace articap
