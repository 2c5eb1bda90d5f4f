// SPDX-License-Identifier: MIT
#include "tests/report/sample_tracking.h"

#include <utility>

#include "tests/tracking/labelled_take.h"
#include "tracking/doubt.h"
#include "tracking/review_json.h"
#include "tracking/take_review.h"

namespace articap {
namespace {

StageReport LabelReport() {
  StageReport report;
  report.stage = "label";
  report.verdict = "96.0 % of all samples have a label";
  report.warnings = {"the standard deviations of the samples are not kept"};
  report.options = {{"seen", "0.9"}};
  return report;
}

}  // namespace

std::string SampleTrackingJson() {
  LabelledTake take = MakeLabelledTake({"nose", "chin <b>", "lip"}, 300);
  for (int frame = 30; frame < 60; ++frame) take.PointOf(frame, 1).sights.resize(1);
  for (int frame = 100; frame < 130; ++frame) take.labelling.frames[frame].points[2] = -1;
  for (int frame = 200; frame < 210; ++frame)
    std::swap(take.labelling.frames[frame].points[0], take.labelling.frames[frame].points[1]);
  take.PointOf(250, 0).residual_px = 1;
  MarkerRecording recording = take.Recording();
  for (int frame = 100; frame < 110; ++frame)
    recording.tracks.Set(frame, 2, Eigen::Vector3d::Zero(), SampleState::kFilled);
  const TakeReview review =
      ReviewOf(take.clouds, take.labelling, recording, take.array, take.instants);
  const auto doubts = DoubtsOf(review, take.labelling, recording.tracks);
  return ReviewJson(review, doubts, {LabelReport()});
}

std::string SampleLabelledFileJson() {
  LabelledTake take = MakeLabelledTake({"nose", "chin"}, 300);
  const MarkerRecording recording = take.Recording();
  for (auto& cloud : take.clouds.frames)
    for (CloudPoint& point : cloud) point.sights.clear();
  const TakeReview review = ReviewOf(take.clouds, take.labelling, recording);
  return ReviewJson(review, DoubtsOf(review, take.labelling, recording.tracks), {LabelReport()});
}

}  // namespace articap
