// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/marker_set.h"
#include "core/result.h"
#include "core/transforms.h"
#include "tracking/anatomy.h"

namespace articap {

// The head frame, in the frame of a reference shape, and how it was found (for the report).
struct HeadAxes {
  Rigid3d head_from_shape;
  std::string axes;    // "y from Chin to NoseTop, x through ..."
  std::string origin;  // "NoseTop"
};

// Head axes: x to the speaker's left, y up, z forward. Anatomical where the landmarks allow it: y
// runs exactly from the chin to the nose bridge; x as nearly as it can through the corners of the
// eyes, or of the mouth; z = x cross y. Where one of these landmarks is missing its nearest
// substitute on the midline, or the next symmetric pair, is taken. Otherwise the declared axes, as
// the head lay on average over the take. The origin is the nose bridge, so that it stays put when
// other references are chosen; without that marker, the centroid of the references.
//
// `landmarks`: their median places in the frame of the shape; `stage_from_shape`: the mean
// rotation.
Result<HeadAxes> FindHeadAxes(const std::vector<PlacedLandmark>& landmarks,
                              const std::optional<DeclaredAxes>& declared,
                              const Eigen::Quaterniond& stage_from_shape,
                              const Eigen::Vector3d& reference_centroid_mm);

// Rows left, up, forward: turns stage coordinates into head axes.
Eigen::Quaterniond HeadFromStage(const DeclaredAxes& axes);

}  // namespace articap
