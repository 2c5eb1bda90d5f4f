// SPDX-License-Identifier: MIT
#include <cstdio>

#include "core/transforms.h"
#include "core/version.h"
#include "rig/face_rig.h"

// Prints articap's version where a header and a library of the installed tree agree.
int main() {
  const articap::Sim3d twice = articap::Sim3d::FromParameters({0, 0, 0, 0, 0, 0, 2});
  const articap::Result<articap::FaceRig> rig = articap::FaceRig::Create({});
  const bool works = twice.ToParameters()[6] == 2 && (!rig || rig->num_vertices() == 0);
  if (works) std::printf("%s\n", articap::kVersion);
  return works ? 0 : 1;
}
