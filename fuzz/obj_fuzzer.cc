// SPDX-License-Identifier: MIT
#include "rig/io/obj_mesh.h"

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto mesh = articap::ParseObj(articap::TextOf(data, size), "fuzz");
  if (!mesh) return 0;
  for (const articap::ObjMesh::Face& face : mesh->faces)
    for (int corner = 0; corner < face.num_corners; ++corner)
      articap::Require(mesh->face_corners(face)[corner] < static_cast<int>(mesh->vertices.size()));
  return 0;
}
