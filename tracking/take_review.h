// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/dots.h"
#include "core/marker_recording.h"
#include "core/point_cloud.h"
#include "tracking/label.h"

namespace articap {

// What a sample of a labelled take rests on, the worst first.
enum class SampleOrigin : std::uint8_t {
  kGap,       // nothing: it is missing
  kFilled,    // its neighbours in time and space
  kOneView,   // one view: its depth is estimated
  kMeasured,  // two views or more, or the file of markers
};

// One marker through a take. What is by frame counts frames from 0.
struct MarkerReview {
  std::string name;
  std::vector<SampleOrigin> origins;  // by frame
  std::vector<float> residuals_px;    // by frame, RMS of the sights; NaN for fewer than two
  std::vector<float> margins;         // by frame (LabelledFrame); NaN without one
  std::vector<double> seen_by_view;   // part of the frames, by view of the take
  int filled = 0;                     // samples
  int gaps = 0;                       // runs of frames without label, filled or not
  int longest_gap = 0;                // frames
  double residual_rms_px = 0;         // NaN where two views never see it
  double residual_rms_mm = 0;
  // sqrt(mean(d^2) / 6) over the coordinates of the second in which it is least, all of its frames
  // measured: d = x[k-1] - 2 x[k] + x[k+1], whose variance is six times that of white noise. NaN
  // where there is no such second.
  double jitter_at_rest_mm = 0;
  double median_margin = 0;  // NaN without label
  double lowest_margin = 0;
  int lowest_margin_frame = -1;

  // Part of the frames.
  double ShareOf(SampleOrigin origin) const;
};

// Where within their pixels the centres of the labelled dots of a view lie: of a detector without
// bias, and a head that moves, everywhere alike. A head at rest shows the same places again and
// again, so that chi-square is for comparison rather than a test.
struct SubPixelHistogram {
  static constexpr int kBins = 20;
  struct Axis {
    std::vector<int> counts = std::vector<int>(kBins, 0);  // from -0.5 to 0.5 px

    double PeakToMean() const;  // 1 is flat; NaN of nothing
    double ChiSquare() const;   // of flatness; kBins - 1 degrees of freedom
  };
  Axis x, y;
  int num_dots = 0;
};

// All that a person needs to see of a labelled take to trust it, or not.
struct TakeReview {
  double rate_hz = 1;
  int first_frame = 1;  // how the recording counts them
  int num_frames = 0;
  std::vector<std::string> views;  // none of a file of markers
  std::vector<MarkerReview> markers;
  std::vector<SubPixelHistogram> sub_pixel;  // by view
};

// `recording`: the take as it is written, gaps filled or not. `instants`: the dots that the sights
// of the clouds are of, by frame and camera; none with an array without cameras.
TakeReview ReviewOf(const PointClouds& clouds, const Labelling& labelling,
                    const MarkerRecording& recording, const CameraArray& array,
                    const std::vector<std::vector<std::vector<Dot>>>& instants);
// Of markers that a file held.
TakeReview ReviewOf(const PointClouds& clouds, const Labelling& labelling,
                    const MarkerRecording& recording);

}  // namespace articap
