// SPDX-License-Identifier: MIT
#pragma once

#include "core/marker_recording.h"
#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "core/report.h"
#include "tracking/label.h"

namespace articap {

// The markers of a file as points without names, to be labelled.
PointClouds CloudsOf(const MarkerRecording& recording);

// The labelled points of a take, by the template's names. What two views or more see is measured.
// What a single view sees is marked as filled: on its ray it is seen, along it it is estimated. The
// standard deviation is that of a coordinate, the mean of all directions. `views`: how many views
// there are; of the first seven C3D keeps which saw a marker.
MarkerRecording RecordingOf(const PointClouds& clouds, const MarkerTemplate& marker_template,
                            const Labelling& labelling, const CameraArray& array);
// Of a file whose columns were named otherwise or not at all: with its events, analog channels and
// residuals. Markers that got no name are left out.
MarkerRecording RecordingOf(const MarkerRecording& source, const PointClouds& clouds,
                            const MarkerTemplate& marker_template, const Labelling& labelling);

// How well the labels are founded: of every marker how often it was seen, by one view alone, how
// far its rays miss one another, gaps, the margin of its labels, and its jitter: what remains of it
// in second differences, where it is quiet.
StageReport DescribeLabelling(const PointClouds& clouds, const MarkerTemplate& marker_template,
                              const Labelling& labelling, const LabelOptions& options);

}  // namespace articap
