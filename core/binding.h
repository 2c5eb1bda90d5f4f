// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/head_shape.h"
#include "core/marker_set.h"
#include "core/result.h"
#include "core/transforms.h"
#include "core/virtual_marker.h"

namespace articap {

// Frames first to last, both included, by the recording's own numbers.
struct FrameRange {
  int first = 0;
  int last = -1;

  bool Contains(int frame) const { return first <= frame && frame <= last; }
  int size() const { return last - first + 1; }
};

struct NamedValue {
  std::string name;
  double value = 0;
};

// A file that a result was made from: its name and the XXH3 hash (64 bits, hex) of its bytes.
struct SourceHash {
  std::string role;  // "reference", "map", "rig"
  std::string name;
  std::string xxh3;
};

// What one speaker's reference pose fixes for all takes. Lengths mm, angles rad.
struct Binding {
  std::string rig_name;
  MarkerSet marker_set;
  HeadShape head_shape;      // head references in the head frame; empty for the modes without
  HeadShape reference_pose;  // every marker of the reference pose, head frame: what q was tied to
  FrameRange reference_frames;             // of the reference recording, averaged
  Sim3d rig_from_head;                     // written as x = (tx, ty, tz, ax, ay, az, s)
  std::vector<NamedValue> rig_parameters;  // the rig's pose in the reference pose
  std::vector<NamedValue> rig_identity;
  std::vector<VirtualMarker> virtual_markers;  // of the face markers
  std::vector<SourceHash> sources;
};

Result<Binding> ParseBinding(const std::string& toml_text, const std::string& source_name);
Result<Binding> ReadBinding(const std::filesystem::path& path);
std::string WriteBinding(const Binding& binding);

}  // namespace articap
