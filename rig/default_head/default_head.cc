// SPDX-License-Identifier: MIT
#include "rig/default_head/default_head.h"

#include "rig/default_head/ears.h"
#include "rig/default_head/eyes.h"
#include "rig/default_head/hair.h"
#include "rig/default_head/mouth_parts.h"
#include "rig/default_head/spectacles.h"
#include "rig/default_head/half_mesh.h"
#include "rig/default_head/skin.h"

namespace articap {

Result<FaceRig> MakeDefaultHead() {
  const FaceShape shape;
  HalfMesh half;
  const Skin skin = AddSkin(shape, half);
  AddEyeball(half);
  AddBrow(shape, half);
  AddEar(half);
  AddHair(shape, half);
  AddTeeth(half);
  AddTongue(half);
  AddSpectacles(half);
  RigDefinition definition;
  definition.name = "default";
  MirrorHalf(half, definition);
  return FaceRig::Create(std::move(definition));
}

}  // namespace articap
