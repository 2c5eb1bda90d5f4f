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
  std::string landmark;         // of core/landmarks.h; empty where it sits at none
  // Of the rig, where its virtual marker must lie; empty: the landmark's region.
  std::string region;
  double offset_mm = 0;          // height of the marker's centre above the skin, where known
  bool beside_landmark = false;  // sits near its landmark, too far off to tell the identity by
};

// The marker's region, or its landmark's where it names none; empty where neither is known.
std::string_view RegionOf(const MarkerRole& role);

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
//   left = "+x"                  # declared axes, all three or none, in the stage frame;
//   up = "+y"                    # or unit vectors: [0.0, 1.0, 0.0]
//   forward = "+z"
//   [[marker]]
//   name = "Chin"
//   roles = ["strategic", "face"]         # of: head, strategic, face
//   landmark = "chin"
//   beside_landmark = true                # optional: near the landmark, not at it
//   region = "jaw"                        # optional
//   offset_mm = 2.0                       # optional
struct MarkerSet {
  std::string name;
  StabilizationMode mode = StabilizationMode::kRigid;
  std::optional<DeclaredAxes> axes;
  std::vector<MarkerRole> markers;

  const MarkerRole* Find(std::string_view marker_name) const;
  // The first marker at a landmark, or null.
  const MarkerRole* FindAtLandmark(std::string_view landmark) const;
};

// "+x", "-y", ... as a unit vector.
Result<Eigen::Vector3d> ParseAxis(const std::string& text);
// Refused unless unit vectors at right angles with left x up = forward: a left-handed choice would
// mirror the face.
Result<DeclaredAxes> MakeDeclaredAxes(const Eigen::Vector3d& left_in_stage,
                                      const Eigen::Vector3d& up_in_stage,
                                      const Eigen::Vector3d& forward_in_stage);

// Refused, naming file and line: unknown keys, roles, landmarks and regions, markers without a name
// or there twice.
Result<MarkerSet> ParseMarkerSet(const std::string& toml_text, const std::string& source_name);
Result<MarkerSet> ReadMarkerSet(const std::filesystem::path& path);
std::string WriteMarkerSet(const MarkerSet& set);

}  // namespace articap
