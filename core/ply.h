// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/head_shape.h"
#include "core/transforms.h"

namespace articap {

struct RgbColor {
  std::uint8_t red = 0, green = 0, blue = 0;
};

// A point of a point cloud; `marker_index` ties together what belongs to one marker.
struct PlyPoint {
  std::string name;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  RgbColor color;
  int marker_index = 0;
};

// ASCII PLY with a vertex a point (float x y z in mm, uchar red green blue, int marker), which
// MeshLab, CloudCompare and Blender open. PLY has no texts besides comments: `comments` and then
// the points' names, "marker INDEX NAME", stand there, without line breaks.
std::string WritePly(std::span<const PlyPoint> points, std::span<const std::string> comments = {});

// Markers as measured, laid on a rig (red), and where the rig puts them (blue), in the rig frame.
// `virtual_in_rig_mm`: in the order of `names`. A measured marker has the index of its name; those
// that are not among the names follow with indices of their own.
std::string MarkersToPly(const HeadShape& measured, const Sim3d& rig_from_head,
                         std::span<const std::string> names,
                         std::span<const Eigen::Vector3d> virtual_in_rig_mm);

}  // namespace articap
