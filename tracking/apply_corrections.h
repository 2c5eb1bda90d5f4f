// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/marker_recording.h"
#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "core/report.h"
#include "core/result.h"
#include "tracking/corrections.h"
#include "tracking/label.h"
#include "tracking/synchronize.h"

namespace articap {

// Corrections on their way through the stages: what is said of dots before they become points, what
// is said of labels after they were found, so that nothing later overrules a person. Frames count
// from `first_frame`.
//
//   AppliedCorrections corrections(*ReadCorrections(path), 1);
//   if (const auto known = corrections.CheckViews(array); !known) ...
//   corrections.CorrectDots(array, dots.instants);
//   ... Reconstruct(), a template ...
//   if (const auto known = corrections.CheckMarkers(marker_template); !known) ...
//   Labelling labelling = corrections.Label(clouds, marker_template, options, array, instants);
//   ... RecordingOf(), filling of gaps ...
//   corrections.ClearFillsAcrossSplits(labelling, recording);
//   reports.push_back(corrections.Report());
class AppliedCorrections {
 public:
  AppliedCorrections(Corrections corrections, int first_frame);

  bool empty() const { return corrections_.list.empty(); }

  // Refused, naming the line and what there is: views and markers that do not exist.
  Result<void> CheckViews(const CameraArray& array) const;
  Result<void> CheckMarkers(const MarkerTemplate& marker_template) const;

  // The dot nearest to a place, at most its own radius or 5 px away, is taken away or moved there;
  // where there is none to be moved, one is added that is like the others of the picture. A place
  // that a person gave is known to half a pixel.
  void CorrectDots(const CameraArray& array, std::vector<InstantDots>& instants);

  // LabelClouds(), every part between splits by itself, and what is said of labels. A moved marker
  // gets the point of its dot that most views agree on; whoever else claimed one of its dots loses
  // it. Whatever a person named has no margin (NaN), and its depth, where only one view sees it, is
  // what the template expects. `instants`: none with an array without cameras.
  Labelling Label(const PointClouds& clouds, const MarkerTemplate& marker_template,
                  const LabelOptions& options, const CameraArray& array,
                  const std::vector<InstantDots>& instants);

  // Filled samples between what was seen before a split and what was seen after it become missing.
  void ClearFillsAcrossSplits(const Labelling& labelling, MarkerRecording& recording) const;

  // "correct": how much each changed; a warning for each that changed nothing.
  StageReport Report() const;

 private:
  void CorrectLabels(const PointClouds& clouds, const MarkerTemplate& marker_template,
                     const CameraArray& array, const std::vector<InstantDots>& instants,
                     Labelling& labelling);
  std::vector<int> SplitFrames(int num_frames) const;

  Corrections corrections_;
  std::vector<int> changed_;  // samples or dots, by correction
  int first_frame_;
};

}  // namespace articap
