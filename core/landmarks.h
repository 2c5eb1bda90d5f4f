// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

namespace articap {

// The vocabulary of docs/landmarks.md: the named places of a face that marker maps and rigs share.
// "Left" is the speaker's left.
struct LandmarkInfo {
  std::string_view name;
  std::string_view region;  // of a rig, where a marker at this landmark belongs
  // Where it lies on an average adult face, mm in head axes (x left, y up, z forward), the origin
  // at the nose bridge, from published means (Farkas, Anthropometry of the Head and Face, 1994:
  // face breadth 135, nasion to gnathion 118, outer canthi 90, inner canthi 32, mouth 51, nose
  // breadth 34). Good to some 8 mm: enough to tell left from right and front from back.
  Eigen::Vector3d typical_mm;
};

std::span<const LandmarkInfo> AllLandmarks();
const LandmarkInfo* FindLandmark(std::string_view name);  // null where there is none

// skull, nose, upper_lip, lower_lip, jaw, left_cheek, right_cheek, neck.
std::span<const std::string_view> AllRegions();
bool IsRegion(std::string_view name);

}  // namespace articap
