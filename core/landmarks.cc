// SPDX-License-Identifier: MIT
#include "core/landmarks.h"

#include <algorithm>
#include <array>

namespace articap {
namespace {

constexpr std::array<std::string_view, 8> kRegions = {
    "skull", "nose", "upper_lip", "lower_lip", "jaw", "left_cheek", "right_cheek", "neck"};

const std::array<LandmarkInfo, 56> kLandmarks = {{
    {"nose_bridge", "nose", {0, 0, 0}},
    {"nose_tip", "nose", {0, -38, 22}},
    {"subnasale", "nose", {0, -50, 6}},
    {"nose_left", "nose", {17, -43, -2}},
    {"nose_right", "nose", {-17, -43, -2}},
    {"chin", "jaw", {0, -104, -2}},
    {"menton", "jaw", {0, -116, -10}},
    {"chin_left", "jaw", {15, -104, -5}},
    {"chin_right", "jaw", {-15, -104, -5}},
    {"jaw_left", "jaw", {40, -94, -36}},
    {"jaw_right", "jaw", {-40, -94, -36}},
    {"left_jaw_angle", "jaw", {53, -75, -72}},
    {"right_jaw_angle", "jaw", {-53, -75, -72}},
    {"left_mouth_corner", "upper_lip", {26, -73, -8}},
    {"right_mouth_corner", "upper_lip", {-26, -73, -8}},
    {"upper_lip_center", "upper_lip", {0, -67, 8}},
    {"upper_lip_left", "upper_lip", {13, -68, 3}},
    {"upper_lip_right", "upper_lip", {-13, -68, 3}},
    {"lower_lip_center", "lower_lip", {0, -81, 5}},
    {"lower_lip_left", "lower_lip", {13, -79, 0}},
    {"lower_lip_right", "lower_lip", {-13, -79, 0}},
    {"left_eye_inner", "skull", {16, -7, -12}},
    {"right_eye_inner", "skull", {-16, -7, -12}},
    {"left_eye_outer", "skull", {45, -6, -22}},
    {"right_eye_outer", "skull", {-45, -6, -22}},
    {"left_eye_upper", "skull", {31, 2, -10}},
    {"right_eye_upper", "skull", {-31, 2, -10}},
    {"left_eye_lower", "skull", {31, -15, -13}},
    {"right_eye_lower", "skull", {-31, -15, -13}},
    {"left_brow_inner", "skull", {13, 16, 0}},
    {"right_brow_inner", "skull", {-13, 16, 0}},
    {"left_brow_middle", "skull", {32, 21, -6}},
    {"right_brow_middle", "skull", {-32, 21, -6}},
    {"left_brow_outer", "skull", {52, 14, -25}},
    {"right_brow_outer", "skull", {-52, 14, -25}},
    {"brow_center", "skull", {0, 16, 4}},
    {"forehead_center", "skull", {0, 50, 0}},
    {"forehead_left", "skull", {40, 45, -18}},
    {"forehead_right", "skull", {-40, 45, -18}},
    {"left_tragion", "skull", {71, -20, -95}},
    {"right_tragion", "skull", {-71, -20, -95}},
    {"left_cheek", "left_cheek", {56, -32, -33}},
    {"right_cheek", "right_cheek", {-56, -32, -33}},
    {"left_cheek_middle", "left_cheek", {44, -52, -22}},
    {"right_cheek_middle", "right_cheek", {-44, -52, -22}},
    {"left_cheek_lower", "left_cheek", {46, -73, -28}},
    {"right_cheek_lower", "right_cheek", {-46, -73, -28}},
    {"crown", "skull", {0, 105, -95}},
    {"back_of_head", "skull", {0, 20, -185}},
    {"spectacles_1", "skull", {-70, 3, -70}},
    {"spectacles_2", "skull", {-55, 12, -5}},
    {"spectacles_3", "skull", {0, 8, 12}},
    {"spectacles_4", "skull", {55, 12, -5}},
    {"spectacles_5", "skull", {70, 3, -70}},
    {"upper_incisor", "skull", {0, -72, -3}},
    {"lower_incisor", "jaw", {0, -76, -6}},
}};

}  // namespace

std::span<const LandmarkInfo> AllLandmarks() { return kLandmarks; }

const LandmarkInfo* FindLandmark(std::string_view name) {
  const auto found = std::find_if(kLandmarks.begin(), kLandmarks.end(),
                                  [&](const LandmarkInfo& info) { return info.name == name; });
  return found == kLandmarks.end() ? nullptr : &*found;
}

std::span<const std::string_view> AllRegions() { return kRegions; }

bool IsRegion(std::string_view name) {
  return std::find(kRegions.begin(), kRegions.end(), name) != kRegions.end();
}

}  // namespace articap
