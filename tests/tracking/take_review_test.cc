// SPDX-License-Identifier: MIT
#include "tracking/take_review.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "synthetic/random.h"
#include "tests/tracking/labelled_take.h"
#include "tracking/doubt.h"
#include "tracking/review_json.h"

namespace articap {
namespace {

using testing::DoubleEq;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::IsNan;

const std::vector<std::string> kNames = {"nose", "chin", "lip"};

TakeReview ReviewOf(const LabelledTake& take, const MarkerRecording& recording) {
  return ReviewOf(take.clouds, take.labelling, recording, take.array, take.instants);
}
TakeReview ReviewOf(const LabelledTake& take) { return ReviewOf(take, take.Recording()); }

TEST(TakeReviewTest, SaysOfEverySampleWhatItRestsOn) {
  LabelledTake take = MakeLabelledTake(kNames, 100);
  for (int frame = 10; frame < 20; ++frame) take.PointOf(frame, 1).sights.resize(1);
  for (int frame = 30; frame < 45; ++frame) take.labelling.frames[frame].points[1] = -1;
  MarkerRecording recording = take.Recording();
  for (int frame = 30; frame < 35; ++frame)
    recording.tracks.Set(frame, 1, Eigen::Vector3d::Zero(), SampleState::kFilled);
  const TakeReview review = ReviewOf(take, recording);
  EXPECT_THAT(review.views, ElementsAre("left", "right"));
  const MarkerReview& chin = review.markers[1];
  EXPECT_EQ(chin.origins[9], SampleOrigin::kMeasured);
  EXPECT_EQ(chin.origins[10], SampleOrigin::kOneView);
  EXPECT_EQ(chin.origins[34], SampleOrigin::kFilled);
  EXPECT_EQ(chin.origins[35], SampleOrigin::kGap);
  EXPECT_THAT(chin.ShareOf(SampleOrigin::kMeasured), DoubleEq(0.75));
  EXPECT_THAT(chin.seen_by_view, ElementsAre(DoubleNear(0.85, 1e-9), DoubleNear(0.75, 1e-9)));
  EXPECT_EQ(chin.gaps, 1);
  EXPECT_EQ(chin.longest_gap, 15);
  EXPECT_EQ(chin.filled, 5);
  EXPECT_EQ(review.markers[0].gaps, 0);
}

TEST(TakeReviewTest, ResidualsAndMargins) {
  LabelledTake take = MakeLabelledTake(kNames, 4);
  take.PointOf(0, 0).residual_px = 0.4;
  for (int frame = 1; frame < 4; ++frame) take.PointOf(frame, 0).residual_px = 0;
  take.labelling.frames[2].margins[0] = 1.5;
  const MarkerReview nose = ReviewOf(take).markers[0];
  EXPECT_NEAR(nose.residual_rms_px, 0.2, 1e-7);
  EXPECT_NEAR(nose.residual_rms_mm, 0.02, 1e-7);
  EXPECT_EQ(nose.lowest_margin, 1.5);
  EXPECT_EQ(nose.lowest_margin_frame, 2);
  EXPECT_EQ(nose.median_margin, 20);
}

// Of 60 frames and three coordinates the variance of second differences is known to a tenth or so,
// and the quietest of many seconds is chosen.
TEST(TakeReviewTest, JitterAtRestIsTheNoise) {
  const double noise_mm = 0.1;
  const TakeReview review = ReviewOf(MakeLabelledTake(kNames, 600, 60, noise_mm));
  for (const MarkerReview& marker : review.markers) {
    EXPECT_LT(marker.jitter_at_rest_mm, 1.02 * noise_mm);
    EXPECT_GT(marker.jitter_at_rest_mm, 0.75 * noise_mm);
  }
}

TEST(TakeReviewTest, JitterIsNotKnownWithoutAWholeSecond) {
  LabelledTake take = MakeLabelledTake(kNames, 100);
  for (int frame = 0; frame < 100; frame += 40) take.labelling.frames[frame].points[0] = -1;
  const TakeReview review = ReviewOf(take);
  EXPECT_THAT(review.markers[0].jitter_at_rest_mm, IsNan());
  EXPECT_GT(review.markers[1].jitter_at_rest_mm, 0);
}

TEST(TakeReviewTest, SubPixelHistogramIsFlatForCentresAnywhere) {
  LabelledTake take = MakeLabelledTake(kNames, 1000);
  RandomGenerator random(3, 0);
  double sum = 0;
  constexpr int kTrials = 25;
  for (int trial = 0; trial < kTrials; ++trial) {
    for (auto& frame : take.instants)
      for (Dot& dot : frame[0]) dot.center_px = {random.Uniform(0, 640), random.Uniform(-1, 1)};
    const SubPixelHistogram histogram = ReviewOf(take).sub_pixel[0];
    EXPECT_EQ(histogram.num_dots, 3000);
    // 150 a bin, SD 12: five of them.
    EXPECT_LT(histogram.x.PeakToMean(), 1.4);
    sum += histogram.x.ChiSquare() + histogram.y.ChiSquare();
  }
  // Chi-square with 19 degrees of freedom: mean 19, SD sqrt(38) over sqrt(50) trials; four of them.
  EXPECT_NEAR(sum / (2 * kTrials), SubPixelHistogram::kBins - 1, 3.5);
}

TEST(TakeReviewTest, SubPixelHistogramShowsCentresDrawnToPixels) {
  LabelledTake take = MakeLabelledTake(kNames, 100);
  for (auto& frame : take.instants)
    for (Dot& dot : frame[1]) dot.center_px = {std::round(dot.center_px.x()) + 0.01, -3.49};
  const SubPixelHistogram histogram = ReviewOf(take).sub_pixel[1];
  EXPECT_EQ(histogram.x.counts[10], 300);
  EXPECT_EQ(histogram.y.counts[0], 300);
  EXPECT_EQ(histogram.x.PeakToMean(), SubPixelHistogram::kBins);
}

TEST(TakeReviewTest, OfAFileThereAreNoViews) {
  LabelledTake take = MakeLabelledTake(kNames, 10);
  for (auto& cloud : take.clouds.frames)
    for (CloudPoint& point : cloud) point.sights.clear();
  MarkerRecording recording = take.Recording();
  for (int frame = 0; frame < 10; ++frame)
    for (int m = 0; m < 3; ++m)
      recording.tracks.Set(frame, m, take.PointOf(frame, m).position_in_stage_mm);
  const TakeReview review = articap::ReviewOf(take.clouds, take.labelling, recording);
  EXPECT_TRUE(review.views.empty());
  EXPECT_THAT(review.markers[0].origins, Each(SampleOrigin::kMeasured));
  EXPECT_THAT(review.markers[0].residual_rms_px, IsNan());
}

TEST(ReviewJsonTest, HoldsTheReportsAndTheReview) {
  LabelledTake take = MakeLabelledTake(kNames, 5000);
  take.labelling.frames[4000].margins[2] = 0.5;
  const TakeReview review = ReviewOf(take);
  StageReport report;
  report.stage = "label";
  const auto doubts = DoubtsOf(review, take.labelling, take.Recording().tracks);
  const auto json = nlohmann::json::parse(ReviewJson(review, doubts, {report}));
  EXPECT_TRUE(json["label"]["usable"]);
  EXPECT_EQ(json["review"]["frames_per_bin"], 3);
  const auto& lip = json["review"]["markers"][2];
  EXPECT_EQ(lip["runs"], nlohmann::json::parse("[[3, 5000]]"));
  EXPECT_EQ(lip["lowest_margins"].size(), 1667U);
  EXPECT_EQ(lip["lowest_margins"][4000 / 3], 0.5);
  EXPECT_EQ(lip["lowest_margin_frame"], 4001) << "frames count as the recording does";
  ASSERT_EQ(json["review"]["doubts"].size(), 1U);
  EXPECT_EQ(json["review"]["doubts"][0]["frame"], 4001);
  EXPECT_EQ(json["review"]["doubts"][0]["kind"], "margin");
}

}  // namespace
}  // namespace articap
