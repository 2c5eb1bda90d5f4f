// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "core/marker_set.h"
#include "core/report.h"

namespace articap {

// Where a marker with a landmark lies, in any one frame of reference.
struct PlacedLandmark {
  std::string marker;
  std::string landmark;
  Eigen::Vector3d point_mm;
};

// The markers of the set that have a landmark and a known place (points_mm: of each name; NaN where
// not known).
std::vector<PlacedLandmark> PlaceLandmarks(const MarkerSet& set,
                                           const std::vector<std::string>& names,
                                           const std::vector<Eigen::Vector3d>& points_mm);

// What a face looks like, against the average face of core/landmarks.h: enough to tell mirrored
// data and exchanged names, which no alignment of the data with themselves can show.
struct AnatomyFindings {
  int num_landmarks = 0;  // too few, or all in a plane, find nothing
  bool is_mirrored = false;
  double rms_proper_mm = 0;    // of the landmarks from the average face, sized to fit
  double rms_mirrored_mm = 0;  // from its mirror image
  // Pairs of markers that fit far better with their names exchanged.
  std::vector<std::pair<std::string, std::string>> exchanged;
  // Angle from the axes the points are given in to those of the face; 0 where not known.
  double tilt_rad = 0;
};
AnatomyFindings CheckAnatomy(const std::vector<PlacedLandmark>& landmarks);

// The error for mirrored data, and the warnings for exchanged names.
std::string MirroredMessage(const AnatomyFindings& anatomy);
void WarnOfExchangedNames(const AnatomyFindings& anatomy, StageReport& report);

}  // namespace articap
