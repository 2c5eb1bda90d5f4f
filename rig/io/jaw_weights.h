// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "rig/io/import_recipe.h"

namespace articap {

enum class JawBond { kFree, kRigid, kFixed };

// Weights of a jaw joint from a target that opens the jaw. With r = (R(angle) - I)(p - pivot) the
// way a vertex would go if it turned with the jaw, and d the way the target takes it, the weight is
// the w that makes w r nearest to d, damped by the recipe's soft_mm e where the way is short: d.r /
// (r.r + e^2), scaled so that the longest way is not damped. Rigid vertices get 1, fixed ones 0.
std::vector<double> JawWeights(const ImportRecipe::Jaw& jaw, const TriangleMesh& mesh,
                               const std::vector<Eigen::Vector3d>& opening_mm,
                               const std::vector<JawBond>& bonds);

}  // namespace articap
