// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/head_pose.h"
#include "core/result.h"

namespace articap {

// One marker of a set: what it is for, and where it sits on a face.
struct MarkerRole {
  std::string name;
  bool head_reference = false;  // moves with the skull
  bool strategic = false;       // a point of the orientation fit
  bool face = false;            // drives the articulatory parameters
  std::string landmark;         // of docs/landmarks.md; empty where it sits at none
  std::string
      region;  // of the rig, where its virtual marker must lie; empty: the landmark's region
  double offset_mm = 0;  // height of the marker's centre above the skin, where known
};

// The axes of data whose head axes cannot be found from landmarks, e.g. an articulograph's: unit
// vectors of the stage frame.
struct DeclaredAxes {
  Eigen::Vector3d left_in_stage = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up_in_stage = Eigen::Vector3d::UnitY();
  Eigen::Vector3d forward_in_stage = Eigen::Vector3d::UnitZ();
};

// The marker map of a recording set-up, a commented TOML file:
//   name = "animface"
//   [head]
//   mode = "rigid"               # rigid, translation, none
//   left = "+x"                  # declared axes, all three or none
//   up = "+y"
//   forward = "+z"
//   [[marker]]
//   name = "Chin"
//   roles = ["strategic", "face"]         # of: head, strategic, face
//   landmark = "chin"
//   region = "jaw"                        # optional
struct MarkerSet {
  std::string name;
  StabilizationMode mode = StabilizationMode::kRigid;
  std::optional<DeclaredAxes> axes;
  std::vector<MarkerRole> markers;

  const MarkerRole* Find(std::string_view marker_name) const;
  // The first marker at a landmark, or null.
  const MarkerRole* FindAtLandmark(std::string_view landmark) const;
};

Result<MarkerSet> ParseMarkerSet(const std::string& toml_text, const std::string& source_name);
Result<MarkerSet> ReadMarkerSet(const std::filesystem::path& path);
std::string WriteMarkerSet(const MarkerSet& set);

}  // namespace articap
