// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calib/mirror_matching.h"
#include "core/camera.h"
#include "core/dots.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

struct NominalMirrorOptions {
  MirrorSide mirror_side = MirrorSide::kByRegion;
  // Between the mirror's plane and the camera's axis, and how well it is known, SD.
  double mirror_angle_deg = 45;
  double mirror_angle_sigma_deg = 3;
  // Of the lens, where it is known to some percent; else the mirror's angle tells it.
  std::optional<double> focal_px;

  bool operator==(const NominalMirrorOptions&) const = default;
};
void VisitOptions(NominalMirrorOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const NominalMirrorOptions& options);

// A camera with a centred lens at the origin of the stage, and a mirror, "mirror", of which nothing
// is known yet: what the names and regions of the views are, before any dot was seen.
CameraArray UnknownMirror(const std::string& camera, int width, int height);

// What tells how large things are.
struct NominalScale {
  std::optional<double> dot_diameter_mm;
  // Standard deviation of the dots' heights in one frame, of a usual face: where no diameter is
  // given, a scale to begin with.
  double usual_spread_mm = 30;
};

struct NominalMirror {
  CameraArray array;  // one camera, one mirror with its region; the stage frame is the camera's
  int pairs = 0;
  int frames = 0;        // that were looked at
  double sigma_px = 0;   // of a dot from where its reflection says that it is
  double angle_rad = 0;  // between the mirror's plane and the camera's axis
  double angle_sigma_rad = 0;
  double tilt_rad = 0;     // of the mirror from upright
  double focal_sigma = 0;  // over the focal length
  double scale_sigma = 0;  // over any length
  double distance = 0;     // of the face from the camera, over the mirror's
  // What an error of focal length and mirror of one standard deviation moves the dots, RMS, after
  // the best similarity: how far the shape can be trusted; over the mirror's distance.
  double shape_sigma = 0;

  // All lengths become so many times as long, and are known to that part of themselves.
  void Rescale(double factor, double sigma);
};

// A camera and a mirror without any calibration, from dots that are seen both ways: the nearest to
// the measured ones among pinholes without distortion and upright mirrors at about the given angle.
// The lines from dots to their reflections meet where the mirror's normal points, focal length over
// the tangent of its angle beside the middle of the picture; so either the angle tells the focal
// length, or the focal length the angle. Which dot is whose reflection is found on the way: no
// names are needed. Errors are counted once a dot, not once a frame: what is off, stays off.
//
// `array`: UnknownMirror(), with regions where they were drawn. Refused: no side and no region, no
// dots in the mirror, dots that do not match.
Result<NominalMirror> EstimateNominalMirror(const DotVideo& video, const CameraArray& array,
                                            const NominalScale& scale,
                                            const NominalMirrorOptions& options);

// "uncalibrated": what was assumed, what was found, and what it costs. `scale_source`: what told
// the lengths, in words.
StageReport DescribeNominalMirror(const NominalMirror& mirror, const std::string& scale_source,
                                  const NominalMirrorOptions& options);

}  // namespace articap
