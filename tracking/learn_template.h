// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/marker_set.h"
#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "core/result.h"
#include "tracking/label.h"

namespace articap {

// Where the markers of a map are on an average face, by their landmarks: in head axes (x to the
// left, y up, z forward), rough. Refused where a marker has no landmark.
Result<MarkerTemplate> LayoutOf(const MarkerSet& set);

// A layout whose left and right are exchanged would label everything, and all of it wrong: refused
// where the landmarks of the map's markers lie the other way round.
Result<void> RefuseMirrored(const MarkerTemplate& layout, const MarkerSet& set);

// How a head may sit in the stage, layout_from_stage: as the stage's own axes say, and before each
// camera, upright and looking at it.
std::vector<Eigen::Quaterniond> LikelyAttitudes(const CameraArray& array);

// Learns a speaker's template from a recording and a layout that knows the places of the markers
// only roughly (typical ones, or clicked). In the frames of `frames` the head is looked for, in any
// of the attitudes and in three sizes; the layout is bent onto the best one; the take is
// labelled with what was found, and the places and how far each marker strays from them are
// measured in it; markers that the take hardly shows where that frame has them go back to the
// layout's places, and it is labelled once more. The template's axes are those of the stage.
// Refused, with what was found instead, where too few markers are found, or where another pose
// explains the frame nearly as well.
Result<MarkerTemplate> LearnTemplate(const PointClouds& clouds, const MarkerTemplate& layout,
                                     std::span<const int> frames,
                                     std::span<const Eigen::Quaterniond> attitudes,
                                     const LabelOptions& options);

// The template with the median places of a labelled take, and the spread about them, from what two
// views measured where there are twenty such samples; markers with fewer than twenty samples keep
// what they had.
MarkerTemplate RefineTemplate(const MarkerTemplate& marker_template, const PointClouds& clouds,
                              const Labelling& labelling);

}  // namespace articap
