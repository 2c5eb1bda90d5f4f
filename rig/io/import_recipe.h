// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// How a mesh with morph targets becomes a rig: which groups are which part, where landmarks and
// regions lie, which targets serve which parameter. Read from commented TOML, such as
// rig/makehuman/hm08.toml. Vertex numbers are the file's own, from 0; positions are in the rig
// frame.
struct ImportRecipe {
  // Vertices that a target moves by so much: tells the lips apart, which touch but part when the
  // mouth opens.
  struct MovedBy {
    std::string target;
    std::array<double, 2> range_mm = {0, 0};
  };
  // Triangles of these groups whose corners all lie on the plane's positive side. The first rule
  // that fits takes a triangle; triangles that no rule takes are left out. Several rules may name
  // one part.
  struct Part {
    std::string name;
    std::vector<std::string> groups;  // empty: all
    std::optional<Eigen::Vector3f> color;
    std::optional<Eigen::Vector3d> plane_point_mm;
    Eigen::Vector3d plane_normal = Eigen::Vector3d::UnitY();
  };
  // Triangles of these parts, inside an outline seen from the front (|x|, y) and a range of depth,
  // or reached from a vertex without entering regions before it. The first rule that fits wins;
  // several rules may name one region.
  struct Region {
    std::string name;
    std::vector<std::string> parts;  // empty: all
    std::vector<Eigen::Vector2d> outline_mm;
    std::optional<std::array<double, 2>> depth_mm;  // range of z
    std::optional<Eigen::Vector3d> facing;          // the normal's half space
    std::optional<MovedBy> moved_by;                // on average over the corners
    int side = 0;                                   // +1 the speaker's left alone, -1 the right
    std::optional<int> fill_from;
    std::optional<Eigen::Vector3f> color;  // of all its vertices
  };
  // One target's share in a parameter; masks multiply.
  struct TargetUse {
    std::string target;
    double gain = 1;
    int side = 0;               // +1 the speaker's left alone, -1 the right
    double side_blend_mm = 10;  // the left share goes from 0 to 1 between x = -blend and +blend
    std::optional<double> below_mm;  // nothing where y is larger
    std::optional<MovedBy> moved_by;
    std::optional<std::array<double, 2>> lateral_mm;  // |x| up to where all, and from where nothing
  };
  struct Parameter {
    RigParameter parameter;
    std::string joint;  // "rotation", "thrust", "shift" of the jaw, or ""
    std::vector<TargetUse> targets;
  };
  // A jaw joint whose weights follow from a target that opens the jaw: the share of each vertex in
  // the turn that the target stands for.
  struct Jaw {
    std::string target;
    double angle_rad = 0;  // by which the target opens the jaw, as a turn about the pivot
    Eigen::Vector3d pivot_mm = Eigen::Vector3d::Zero();
    std::vector<std::string>
        rigid_groups;  // groups that turn with the whole jaw: lower teeth, tongue
    std::vector<std::string> fixed_groups;  // groups that do not turn: upper teeth, eyes
    double soft_mm = 1;        // ways not longer than this count for little: skin slides over bone
    int smoothing_rounds = 0;  // of the weights over the mesh
  };

  std::string name;
  std::string unit;                              // mm, cm, dm, m, in; "": as the format says
  std::array<std::string, 2> axes = {"x", "y"};  // the file's axes to the speaker's left, and up
  std::array<std::string, 2> origin_between;     // two landmarks; empty: the file's origin
  std::vector<Part> parts;                       // empty: one for each group
  std::vector<Landmark> landmarks;
  std::vector<Region> regions;        // empty: one region "face"
  std::vector<Parameter> parameters;  // empty: one for each target
  std::optional<Jaw> jaw;
};

Result<ImportRecipe> ParseImportRecipe(std::string_view text, const std::string& source);

// Millimetres in a unit of length by its name; nothing for others than mm, cm, dm, m, in.
std::optional<double> MillimetresPer(std::string_view unit);

}  // namespace articap
