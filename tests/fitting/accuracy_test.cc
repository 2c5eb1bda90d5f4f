// SPDX-License-Identifier: MIT
// How well the shape fit finds the articulation of a speaker whose truth is known, against the best
// that any unbiased estimator can do (Cramer and Rao): truth by synthesis.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>

#include "core/head_pose.h"
#include "fitting/bind.h"
#include "fitting/fit.h"
#include "rig/default_head/default_head.h"
#include "rig/virtual_marker_evaluator.h"
#include "synthetic/noise.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

constexpr double kNoiseMm = 0.2;

const FaceRig& DefaultHead() {
  static const FaceRig rig = MakeDefaultHead().value();
  return rig;
}

MarkerSet ThirtyMarkers() {
  return ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml").value();
}

SyntheticTake Speak(const std::vector<std::string>& identity, int seed) {
  SyntheticTakeOptions options;
  options.seed = seed;
  options.speech.num_sentences = 20;
  options.identity = identity;
  options.identity_spread = 0;
  return SynthesizeTake(DefaultHead(), ThirtyMarkers(), options).value();
}

// The head's movement is taken out with the true pose: what stabilisation adds is its own test's.
HeadTracks InHead(const SyntheticTake& take, const MarkerRecording& markers) {
  return ToHead(markers.tracks, take.true_pose);
}

struct FitResult {
  Binding binding;
  ParameterTrack found;
};

// Binds to the first second, at rest, of the noisy recording itself, and fits the whole of it.
FitResult BindAndFit(const SyntheticTake& take, const MarkerRecording& markers,
                     const BindOptions& bind_options) {
  const HeadTracks tracks = InHead(take, markers);
  const auto bound = Bind(tracks, {}, take.marker_set, DefaultHead(), bind_options);
  if (!bound) throw std::runtime_error(bound.error().message);
  const auto fitted = Fit(tracks, bound->output, DefaultHead(), {});
  if (!fitted) throw std::runtime_error(fitted.error().message);
  return {bound->output, fitted->output.parameters};
}

BindOptions OwnHead() {
  BindOptions options;
  options.frames = "1:60";
  options.fit_identity = false;
  return options;
}

bool IsAtRest(const SyntheticTake& take, int frame) {
  return take.truth.values.row(frame).isZero(0);
}

// Root mean square over the frames of speech, of each parameter.
Eigen::VectorXd RmsErrors(const SyntheticTake& take, const ParameterTrack& found) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(take.truth.num_parameters());
  int count = 0;
  for (int frame = 0; frame < take.truth.num_frames(); ++frame) {
    if (IsAtRest(take, frame)) continue;
    squares += (found.values.row(frame) - take.truth.values.row(frame)).cwiseAbs2().transpose();
    ++count;
  }
  return (squares / count).cwiseSqrt();
}

// The Cramer-Rao bound of the same figure: of all frames of speech the mean of
// diag((J^T J)^-1) sigma^2, with J the Jacobian, at the truth, of the face markers that survive:
// seen and no outliers.
Eigen::VectorXd CramerRaoBounds(const SyntheticTake& take, const DisturbedRecording& recorded) {
  std::vector<VirtualMarker> face;
  std::vector<int> column;
  for (std::size_t i = 0; i < take.true_attachments.size(); ++i)
    if (take.marker_set.markers[i].face) {
      face.push_back(take.true_attachments[i]);
      column.push_back(static_cast<int>(i));
    }
  const FaceRig speaker = DefaultHead().WithIdentity(take.identity_values());
  const VirtualMarkerEvaluator evaluator(speaker, face);
  const int num_parameters = take.truth.num_parameters();
  Eigen::VectorXd variances = Eigen::VectorXd::Zero(num_parameters);
  int count = 0;
  for (int frame = 0; frame < take.truth.num_frames(); ++frame) {
    if (IsAtRest(take, frame)) continue;
    const Eigen::VectorXd truth = take.truth.values.row(frame);
    Eigen::MatrixXd jacobian =
        evaluator.DenseJacobian({truth.data(), static_cast<std::size_t>(truth.size())});
    for (std::size_t i = 0; i < face.size(); ++i)
      if (recorded.fault(frame, column[i]) != SampleFault::kNone)
        jacobian.middleRows<3>(3 * static_cast<int>(i)).setZero();
    const Eigen::MatrixXd information = jacobian.transpose() * jacobian / (kNoiseMm * kNoiseMm);
    variances += information.ldlt()
                     .solve(Eigen::MatrixXd::Identity(num_parameters, num_parameters))
                     .diagonal();
    ++count;
  }
  return (variances / count).cwiseSqrt();
}

// The RMS error of every parameter stays within `factor` of the bound.
void ExpectWithin(double factor, const SyntheticTake& take, const DisturbedRecording& recorded,
                  const ParameterTrack& found) {
  const Eigen::VectorXd errors = RmsErrors(take, found);
  const Eigen::VectorXd bounds = CramerRaoBounds(take, recorded);
  for (int i = 0; i < errors.size(); ++i) {
    std::printf("  %-28s RMS error %.5f %-3s  bound %.5f  ratio %.3f\n",
                take.truth.names[i].c_str(), errors[i], take.truth.units[i].c_str(), bounds[i],
                errors[i] / bounds[i]);
    EXPECT_LE(errors[i], factor * bounds[i]) << take.truth.names[i];
  }
}

TEST(AccuracyTest, OwnHeadComesNearTheCramerRaoBound) {
  const SyntheticTake take = Speak({}, 11);
  SyntheticNoiseOptions noise;
  noise.noise_mm = kNoiseMm;
  const DisturbedRecording recorded = AddNoise(take.markers, noise, 11);
  ExpectWithin(1.15, take, recorded, BindAndFit(take, recorded.markers, OwnHead()).found);
}

TEST(AccuracyTest, DropoutsAndOutliersCostLittle) {
  const SyntheticTake take = Speak({}, 12);
  SyntheticNoiseOptions noise;
  noise.noise_mm = kNoiseMm;
  noise.dropout = 0.2;
  noise.outliers = 0.02;
  noise.outlier_mm = 10;
  const DisturbedRecording recorded = AddNoise(take.markers, noise, 12);
  ExpectWithin(1.3, take, recorded, BindAndFit(take, recorded.markers, OwnHead()).found);
}

TEST(AccuracyTest, AnotherIdentityKeepsTheMovements) {
  const SyntheticTake take =
      Speak({"face_width=0.08", "jaw_length=0.10", "lip_thickness=0.30"}, 13);
  SyntheticNoiseOptions noise;
  noise.noise_mm = kNoiseMm;
  const DisturbedRecording recorded = AddNoise(take.markers, noise, 13);
  BindOptions options;
  options.frames = "1:60";
  const ParameterTrack found = BindAndFit(take, recorded.markers, options).found;
  const Eigen::VectorXd errors = RmsErrors(take, found);
  for (int i = 0; i < take.truth.num_parameters(); ++i) {
    const Eigen::VectorXd x = take.truth.values.col(i), y = found.values.col(i);
    const Eigen::VectorXd dx = x.array() - x.mean(), dy = y.array() - y.mean();
    const double correlation = dx.dot(dy) / (dx.norm() * dy.norm());
    std::printf("  %-28s correlation %.4f  bias %+.4f %-3s  gain %.3f  RMS error %.4f\n",
                take.truth.names[i].c_str(), correlation, y.mean() - x.mean(),
                take.truth.units[i].c_str(), dx.dot(dy) / dx.squaredNorm(), errors[i]);
    EXPECT_GE(correlation, 0.97) << take.truth.names[i];
  }
}

}  // namespace
}  // namespace articap
