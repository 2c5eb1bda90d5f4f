// SPDX-License-Identifier: MIT
// Recordings of real faces, from marker file to parameters; docs/accuracy.md tells the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/marker_io.h"
#include "fitting/bind.h"
#include "fitting/fit.h"
#include "rig/default_head/default_head.h"
#include "rig/io/import.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"
#include "tracking/stabilize.h"

namespace articap {
namespace {

struct RealFit {
  StageTracks stage_tracks;
  HeadTracks head_tracks;
  Binding binding;
  ShapeFit fit;
  StageReport report;

  double Figure(const std::string& name) const {
    for (const auto& [figure, value] : report.figures)
      if (figure == name) return value;
    throw std::runtime_error("the report has no figure " + name);
  }
  std::string Text(const std::string& name) const {
    for (const auto& [text, value] : report.texts)
      if (text == name) return value;
    throw std::runtime_error("the report has no text " + name);
  }
  Eigen::VectorXd Parameter(const std::string& name) const {
    const auto& names = fit.parameters.names;
    return fit.parameters.values.col(std::find(names.begin(), names.end(), name) - names.begin());
  }
  Eigen::Vector3d PointInHead(int frame, const std::string& marker) const {
    return head_tracks.position_mm(frame, head_tracks.Find(marker).value());
  }
  int CountFitted() const {
    return static_cast<int>(std::count_if(fit.parameters.residuals_mm.begin(),
                                          fit.parameters.residuals_mm.end(),
                                          [](double residual) { return std::isfinite(residual); }));
  }
};

RealFit FitRecording(const std::string& recording, const std::string& map, const FaceRig& rig,
                     const FitOptions& options) {
  RealFit real;
  real.stage_tracks = OrThrow(ReadMarkers(TestDataPath(recording))).tracks;
  const MarkerSet set = OrThrow(ReadMarkerSet(SourceFolder() / "maps" / (map + ".toml")));
  auto stabilized = OrThrow(Stabilize(real.stage_tracks, set, std::nullopt)).output;
  real.head_tracks = stabilized.tracks;
  real.binding =
      OrThrow(Bind(real.head_tracks, stabilized.head_shape, set, rig, BindOptions())).output;
  auto fit =
      OrThrow(Fit(real.head_tracks, real.binding, rig, options, real.binding.reference_frames));
  real.fit = std::move(fit.output);
  real.report = std::move(fit.report);
  return real;
}

// Refined from 300 of the frames, which the explained variance is not judged by.
FitOptions Refined() {
  FitOptions options;
  options.refine_frames = 300;
  return options;
}

double Correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return x.dot(y) / std::sqrt(x.squaredNorm() * y.squaredNorm());
}

TEST(RealDataTest, JawMovements) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  const RealFit real =
      FitRecording("animface/jaw.trc", "animface", MakeDefaultHead().value(), Refined());
  EXPECT_EQ(real.CountFitted(), 1590);

  const int num_frames = real.head_tracks.num_frames();
  Eigen::VectorXd opening(num_frames), lateral(num_frames);
  for (int frame = 0; frame < num_frames; ++frame) {
    const Eigen::Vector3d chin = real.PointInHead(frame, "Chin");
    opening[frame] = (chin - real.PointInHead(frame, "NoseTop")).norm();
    lateral[frame] = chin.x();
  }
  const double rotation = Correlation(real.Parameter("jaw_rotation"), opening);
  const double shift = Correlation(real.Parameter("jaw_shift"), lateral);
  EXPECT_GE(rotation, 0.97);
  EXPECT_GE(shift, 0.9);
  EXPECT_GE(real.Figure("explained_variance_mouth_chin_%"), 95);
  RecordProperty("jaw_rotation_correlation", std::to_string(rotation));
  RecordProperty("jaw_shift_correlation", std::to_string(shift));
  RecordProperty("explained_%", std::to_string(real.Figure("explained_variance_mouth_chin_%")));
}

// Cheeks blown up and sucked in, which the rig's ten parameters are not made for: all frames are
// fitted, and the report says how much of it is explained.
TEST(RealDataTest, CheekMovements) {
  ARTICAP_NEEDS_TEST_DATA("animface/cheeks.trc");
  const RealFit real =
      FitRecording("animface/cheeks.trc", "animface", MakeDefaultHead().value(), Refined());
  EXPECT_EQ(real.CountFitted(), 1499);
  EXPECT_GE(real.Figure("explained_variance_mouth_chin_%"), 80);
  RecordProperty("explained_%", std::to_string(real.Figure("explained_variance_mouth_chin_%")));
}

TEST(RealDataTest, JawMovementsOnMakeHumansHead) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  ARTICAP_NEEDS_TEST_DATA("makehuman/base.obj");
  const FaceRig rig =
      OrThrow(ImportRig(TestDataPath("makehuman/base.obj"), std::nullopt, {})).output;
  const RealFit real = FitRecording("animface/jaw.trc", "animface", rig, Refined());
  EXPECT_EQ(real.CountFitted(), 1590);
  EXPECT_GE(real.Figure("explained_variance_mouth_chin_%"), 85);
  RecordProperty("explained_%", std::to_string(real.Figure("explained_variance_mouth_chin_%")));
}

// Four lip and jaw coils cannot determine ten parameters, and the report says which they do.
TEST(RealDataTest, SpokenSentenceOfFourCoils) {
  ARTICAP_NEEDS_TEST_DATA("speech/F01_B01_S01_R01_N.trc");
  const RealFit real = FitRecording("speech/F01_B01_S01_R01_N.trc", "haskins_ema",
                                    MakeDefaultHead().value(), FitOptions());
  EXPECT_EQ(real.CountFitted(), 262);
  EXPECT_NE(real.Text("determined").find("jaw_rotation"), std::string::npos);
  EXPECT_NE(real.Text("held").find("right_mouth_corner_stretch"), std::string::npos);
  RecordProperty("determined", real.Text("determined"));
}

}  // namespace
}  // namespace articap
