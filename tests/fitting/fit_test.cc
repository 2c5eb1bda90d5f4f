// SPDX-License-Identifier: MIT
#include "fitting/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fitting/bind.h"
#include "fitting/refinement.h"
#include "rig/virtual_marker_evaluator.h"
#include "tests/support/matchers.h"
#include "tests/support/report_figures.h"
#include "tests/support/result.h"
#include "tests/support/spoken_take.h"

namespace articap {
namespace {

using testing::Contains;
using testing::HasSubstr;

struct BoundTake : SpokenTake {
  Binding binding;
};

// Four sentences, some 1100 frames, 0.4 mm of noise, true head pose.
const BoundTake& Speaker() {
  static const BoundTake bound = [] {
    BoundTake speaker{
        MakeSpokenTake({.seed = 6, .num_sentences = 4, .noise_mm = 0.4, .own_identity = false}),
        {}};
    BindOptions options;
    options.frames = "1:60";
    options.fit_identity = false;
    speaker.binding =
        OrThrow(Bind(speaker.tracks, {}, speaker.take.marker_set, DefaultHead(), options)).output;
    return speaker;
  }();
  return bound;
}

StageResult<ShapeFit> FitSpeaker(const FitOptions& options, const FrameRange& binding_frames = {}) {
  return OrThrow(Fit(Speaker().tracks, Speaker().binding, DefaultHead(), options, binding_frames));
}

// RMS error of every parameter over the take, as a part of its range.
Eigen::VectorXd RelativeErrors(const ParameterTrack& found) {
  const Eigen::MatrixXd errors = found.values - Speaker().take.truth.values;
  Eigen::VectorXd rms = errors.colwise().squaredNorm().transpose() / errors.rows();
  rms = rms.cwiseSqrt();
  for (int k = 0; k < rms.size(); ++k) {
    const RigParameter& parameter = DefaultHead().definition().parameters[k];
    rms[k] /= parameter.max - parameter.min;
  }
  return rms;
}

TEST(FitTest, TheNumberOfThreadsChangesNothing) {
  ASSERT_GT(Speaker().tracks.num_frames(), 1024);  // more than two runs of frames
  FitOptions options;
  options.threads = 1;
  const ShapeFit one = FitSpeaker(options).output;
  options.threads = 3;
  const ShapeFit three = FitSpeaker(options).output;
  EXPECT_EQ(one.parameters.values, three.parameters.values);
  EXPECT_EQ(one.parameters.sigmas, three.parameters.sigmas);
  EXPECT_EQ(one.residuals_mm, three.residuals_mm);
}

TEST(FitTest, TheBindingsFramesAreNotJudgedBy) {
  const int num_frames = Speaker().tracks.num_frames();
  EXPECT_EQ(FigureOf(FitSpeaker({}).report, "explained_variance_frames"), num_frames);
  EXPECT_EQ(FigureOf(FitSpeaker({}, {1, 60}).report, "explained_variance_frames"), num_frames - 60);
}

TEST(FitTest, SmoothingTakesNoiseOutOfTheTracks) {
  const Eigen::VectorXd rough = RelativeErrors(FitSpeaker({}).output.parameters);
  FitOptions options;
  options.smoothing_s = 0.05;
  const Eigen::VectorXd smooth = RelativeErrors(FitSpeaker(options).output.parameters);
  for (int k = 0; k < rough.size(); ++k)
    EXPECT_LT(smooth[k], rough[k]) << Speaker().take.truth.names[k];
  EXPECT_LT(smooth.mean(), 0.8 * rough.mean());
}

TEST(FitTest, ALooseSmoothnessPriorChangesNothing) {
  FitOptions options;
  options.smoothing_s = 1e-4;
  const Eigen::MatrixXd prior = FitSpeaker(options).output.parameters.values;
  const Eigen::MatrixXd none = FitSpeaker({}).output.parameters.values;
  EXPECT_LT((prior - none).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(FitTest, SmoothingDoesNotReachAcrossAGap) {
  HeadTracks tracks = Speaker().tracks;
  for (int frame = 400; frame < 410; ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) tracks.SetMissing(frame, marker);
  FitOptions options;
  options.smoothing_s = 0.05;
  const auto fit_of = [&](const HeadTracks& take) {
    return OrThrow(Fit(take, Speaker().binding, DefaultHead(), options)).output.parameters;
  };
  const ParameterTrack whole = fit_of(tracks);
  EXPECT_EQ(whole.statuses[405], FitStatus::kNoHeadPose);
  EXPECT_TRUE(std::isnan(whole.values(405, 0)));
  // What comes before the gap is as it would be without what comes after it.
  for (int frame = 410; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) tracks.SetMissing(frame, marker);
  const ParameterTrack before = fit_of(tracks);
  EXPECT_LT((whole.values.topRows(400) - before.values.topRows(400)).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(FitTest, SpikesAreLeftOutAndNamed) {
  HeadTracks tracks = Speaker().tracks;
  const int chin = tracks.Find("chin").value();
  tracks.Set(500, chin, tracks.position_mm(500, chin) + Eigen::Vector3d(0, 0, 25));
  const auto fit = OrThrow(Fit(tracks, Speaker().binding, DefaultHead(), {}));
  EXPECT_EQ(FigureOf(fit.report, "spikes"), 1);
  EXPECT_THAT(fit.report.warnings, Contains(HasSubstr("chin")));
  EXPECT_LT(
      (fit.output.parameters.values.row(500) - FitSpeaker({}).output.parameters.values.row(500))
          .cwiseAbs()
          .maxCoeff(),
      1.5);
}

TEST(FitTest, ATakeWithoutTheBindingsMarkersFails) {
  const HeadTracks strange({"a", "b"}, 10, 60);
  const auto fit = Fit(strange, Speaker().binding, DefaultHead(), {});
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("marker set"));
}

// Markers bound 4 mm beside where they are worn: with the poses known, sixty frames tell.
TEST(RefinementTest, FindsWhereMarkersAreWorn) {
  const SyntheticTake& take = Speaker().take;
  std::vector<VirtualMarker> worn, bound;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < take.true_attachments.size(); ++i) {
    if (!take.marker_set.markers[i].face) continue;
    worn.push_back(take.true_attachments[i]);
    names.push_back(worn.back().name);
    bound.push_back(worn.back());
    bound.back().u_mm += 1.5;
    bound.back().s += 0.4;
  }
  const VirtualMarkerEvaluator evaluator(DefaultHead(), worn);
  RigTracks measured(names, take.truth.num_frames(), 60);
  for (int frame = 0; frame < measured.num_frames(); ++frame) {
    const Eigen::VectorXd y = take.truth.values.row(frame);
    const Eigen::Matrix3Xd q = evaluator.Positions({y.data(), static_cast<std::size_t>(y.size())});
    for (int i = 0; i < measured.num_markers(); ++i) measured.Set(frame, i, q.col(i));
  }
  std::vector<int> frames;
  for (int frame = 5; frame < measured.num_frames(); frame += measured.num_frames() / 60)
    frames.push_back(frame);
  const auto refined =
      RefineAttachments(DefaultHead(), bound, bound, measured, frames, take.truth.values, 20);
  const VirtualMarkerEvaluator before(DefaultHead(), bound), after(DefaultHead(), refined);
  double sum_before_mm = 0, sum_after_mm = 0;
  for (int frame = 0; frame < measured.num_frames(); frame += 7) {
    const Eigen::VectorXd y = take.truth.values.row(frame);
    const std::span<const double> parameters(y.data(), static_cast<std::size_t>(y.size()));
    const Eigen::Matrix3Xd q_before = before.Positions(parameters),
                           q_after = after.Positions(parameters);
    for (int i = 0; i < measured.num_markers(); ++i) {
      sum_before_mm += (q_before.col(i) - measured.position_mm(frame, i)).norm();
      sum_after_mm += (q_after.col(i) - measured.position_mm(frame, i)).norm();
    }
  }
  EXPECT_LT(sum_after_mm, 0.05 * sum_before_mm);
}

}  // namespace
}  // namespace articap
