// SPDX-License-Identifier: MIT
#include "core/ply.h"

#include <gtest/gtest.h>

namespace articap {
namespace {

TEST(PlyTest, MeasuredAndVirtualMarkersOfOneNameShareAnIndex) {
  const HeadShape measured{{{"nose", {1, 2, 3}}, {"spectacles", {0, 0, 10}}, {"chin", {0, -1, 0}}}};
  const Sim3d rig_from_head{2, Eigen::Quaterniond::Identity(), {0, 0, 0.5}};
  const std::string names[] = {"chin", "nose"};
  const Eigen::Vector3d virtual_in_rig_mm[] = {{0, -2, 0.25}, {2, 4, 6.12345}};
  EXPECT_EQ(MarkersToPly(measured, rig_from_head, names, virtual_in_rig_mm),
            "ply\n"
            "format ascii 1.0\n"
            "comment articap markers, rig frame: mm, x left, y up, z forward\n"
            "comment red: as measured; blue: virtual markers of the rig\n"
            "comment marker 1 nose\n"
            "comment marker 2 spectacles\n"
            "comment marker 0 chin\n"
            "element vertex 5\n"
            "property float x\n"
            "property float y\n"
            "property float z\n"
            "property uchar red\n"
            "property uchar green\n"
            "property uchar blue\n"
            "property int marker\n"
            "end_header\n"
            "2.0000 4.0000 6.5000 220 40 40 1\n"
            "0.0000 0.0000 20.5000 220 40 40 2\n"
            "0.0000 -2.0000 0.5000 220 40 40 0\n"
            "0.0000 -2.0000 0.2500 40 90 220 0\n"
            "2.0000 4.0000 6.1235 40 90 220 1\n");
}

TEST(PlyTest, ANameWithALineBreakStaysInItsComment) {
  const PlyPoint points[] = {{"a\nend_header", {0, 0, 0}, {1, 2, 3}, 7}};
  EXPECT_EQ(WritePly(points),
            "ply\n"
            "format ascii 1.0\n"
            "comment marker 7 a end_header\n"
            "element vertex 1\n"
            "property float x\n"
            "property float y\n"
            "property float z\n"
            "property uchar red\n"
            "property uchar green\n"
            "property uchar blue\n"
            "property int marker\n"
            "end_header\n"
            "0.0000 0.0000 0.0000 1 2 3 7\n");
}

TEST(PlyTest, NoPointsAreACloudToo) {
  EXPECT_NE(WritePly({}).find("element vertex 0\n"), std::string::npos);
}

}  // namespace
}  // namespace articap
