// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/template_input.h"
#include "apps/verb_line.h"
#include "calib/nominal_mirror.h"
#include "core/camera.h"
#include "core/marker_recording.h"
#include "core/marker_set.h"
#include "core/point_cloud.h"
#include "core/report.h"
#include "core/result.h"
#include "tracking/label.h"

namespace articap {

// `articap track` without a calibration: one camera before a mirror, positions relative to the
// nose.
struct UncalibratedInput {
  bool enabled = false;
  double dot_diameter_mm = 0;             // 0: not given
  std::vector<std::string> known_length;  // two markers and the distance between them, mm
  NominalMirrorOptions mirror;
};
void AddUncalibratedInput(VerbLine& line, UncalibratedInput& input);

// What is given too little, too much, or for the other mode. `cameras`: the calibration.
Result<void> CheckInput(const UncalibratedInput& input, const std::string& cameras,
                        const TemplateInput& naming);

// A nominal camera and its mirror for a take, and what they cost.
class NominalTake {
 public:
  // The camera of the only video, of which nothing is known yet. Refused: several.
  static Result<CameraArray> ArrayOf(const std::vector<std::string>& paths);
  // Refused: maps without a marker on the tip of the nose, or without those of the known length;
  // and what EstimateNominalMirror() refuses.
  static Result<NominalTake> Start(const UncalibratedInput& input, const TemplateInput& naming,
                                   const CameraArray& array, const DotVideo& video);

  const CameraArray& array() const { return mirror_.array; }
  double sigma_px() const { return mirror_.sigma_px; }
  // Whether the scale still waits for labels.
  bool needs_length() const { return length_mm_.has_value(); }
  // Makes the known length right: the median of the frames in which two views see both of its
  // markers, of those within 0.2 s of the reference frame where one is named. Refused where there
  // are none.
  Result<void> ScaleTo(const PointClouds& clouds, const MarkerTemplate& marker_template,
                       const Labelling& labelling);

  // Refused where the template that gave the names does not know the map's nose.
  Result<MarkerRecording> RelativeToNose(const MarkerRecording& markers) const;
  // `relative`: the frames that lost the nose are named.
  StageReport Report(const MarkerRecording& relative) const;

 private:
  NominalTake(const UncalibratedInput& input, double reference_frame, std::string nose,
              NominalMirror mirror);

  UncalibratedInput input_;
  double reference_frame_;  // as the recording counts; 0: none
  std::string nose_;
  NominalMirror mirror_;
  std::optional<double> length_mm_;
  std::string scale_source_;
};

}  // namespace articap
