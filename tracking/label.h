// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "core/marker_template.h"
#include "core/options.h"
#include "core/point_cloud.h"
#include "core/result.h"
#include "core/transforms.h"
#include "tracking/marker_place.h"

namespace articap {

struct LabelOptions {
  double seen = 0.9;                      // part of a marker's frames in which it is found
  double false_points = 2;                // a frame, in a cube of 300 mm
  double head_acceleration_mm_s2 = 3000;  // about the most of a speaker's head
  double attitude_sigma_deg = 40;         // of the head, from where the template was learnt
  double memory_s = 0.2;     // how long a marker stays away from where the template says, about
  double least_share = 0.3;  // of the template's markers, to find the head in a frame of its own
};
void VisitOptions(LabelOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const LabelOptions& options);

// Who is who in one frame.
struct LabelledFrame {
  // Nothing where the head was not found.
  std::optional<Rigid3d> template_from_stage;
  std::vector<int> points;  // by marker of the template: index in the cloud, -1 for none
  // By marker: where it is, as far as it has a point; of a single sight the depth is what the time
  // before and after, and the template, make of it, and the covariance says how well.
  std::vector<MarkerPlace> places;
  // By marker: how much less likely the next best explanation is, difference of log-likelihood;
  // NaN for markers without a point.
  std::vector<float> margins;

  int num_labelled() const;
};

struct Labelling {
  std::vector<LabelledFrame> frames;
  int searches = 0;        // frames in which the head was found anew
  int relabelled = 0;      // samples that the time before and after names otherwise
  int swaps_repaired = 0;  // samples whose label the rest of their tracklet outvoted
};

// The point that a marker is in a frame; null for none.
const CloudPoint* LabelledPoint(const PointClouds& clouds, const Labelling& labelling, int frame,
                                int marker);

// Names the points of every frame by a template of the speaker. The head is found in the first
// frame that shows enough of it, by what is rigid: triples of points as far apart as the
// template's. From there on each frame begins with what the last ones promise (HeadMotion), markers
// move little within it. The assignment is the most likely one of all markers to all points, or to
// none; the head's pose and the assignment are found in turns. Points that claim one dot exclude
// one another. A second pass expects every marker between where it was before and after, which
// finds what moved too fast and drops what was not it. Then tracklets (the same point from frame to
// frame, whatever its label) vote, and outvoted samples are relabelled.
Labelling LabelClouds(const PointClouds& clouds, const MarkerTemplate& marker_template,
                      const LabelOptions& options);

}  // namespace articap
