// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "core/board.h"
#include "core/transforms.h"
#include "render/scene.h"

namespace articap {

// A printed board: a plate 3 mm thick, the pattern on its front, the rest as white as the paper.
// The front is cut into cells without steps or gaps, so that edges are exactly where the pattern
// has them. white and black are linear albedos.
RenderMesh BoardMesh(const BoardPattern& pattern, const Rigid3d& stage_from_board,
                     float white = 0.85f, float black = 0.04f);

// A round rod, open at its ends.
RenderMesh RodMesh(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double radius_mm,
                   const Eigen::Vector3f& color);

}  // namespace articap
