// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// A rig on disk is a folder:
//   rig.toml      name, parts, regions, landmarks, parameters, transforms, jaw, identity sliders
//   mesh.obj      "v x y z r g b" (mm, linear RGB), triangles in groups "part region"
//   weights.csv   vertex,map,weight            where a weight is not 0
//   morphs.csv    morph,vertex,dx_mm,dy_mm,dz_mm   morphs are numbered in the order of rig.toml
//   identity.csv  slider,vertex,dx_mm,dy_mm,dz_mm
// Vertices count from 0 in TOML and CSV. Numbers are exact, so that saving what was loaded gives
// the same bytes. The three tables are left out where they would be empty.
using RigFiles = std::map<std::string, std::string>;  // file name -> bytes

Result<FaceRig> LoadRig(const std::filesystem::path& folder);

// Makes the folder, or replaces the rig that it holds; refuses a folder with other things in it.
Result<void> SaveRig(const FaceRig& rig, const std::filesystem::path& folder);

// The same from and to memory; `source` names the rig in messages.
Result<FaceRig> ParseRig(const RigFiles& files, const std::string& source);
RigFiles SerializeRig(const FaceRig& rig);

// XXH3 of the serialised rig, identity included: equal rigs have equal hashes.
std::string HashOf(const FaceRig& rig);

}  // namespace articap
