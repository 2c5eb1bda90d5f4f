// SPDX-License-Identifier: MIT
// How well the shape fit finds the articulation of a speaker whose truth is known, against the best
// that any unbiased estimator can do (Cramer and Rao): truth by synthesis.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "core/head_pose.h"
#include "core/marker_set.h"
#include "fitting/bind.h"
#include "fitting/fit.h"
#include "rig/virtual_marker_evaluator.h"
#include "synthetic/noise.h"
#include "synthetic/speaker.h"
#include "tests/support/result.h"
#include "tests/support/spoken_take.h"
#include "tests/support/test_data.h"
#include "tracking/stabilize.h"

namespace articap {
namespace {

constexpr double kNoiseMm = 0.2;

// Thirty markers on the face, five on the spectacles.
const MarkerSet& Markers() {
  static const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml").value();
  return set;
}

// A speaker and a noisy recording of eight sentences.
struct Session {
  SyntheticTake take;
  DisturbedRecording recorded;
  HeadTracks tracks;
  HeadShape head_shape;  // empty where the head pose is the true one
};

struct SessionOptions {
  int seed = 1;
  std::vector<std::string> identity = {};
  double misplacement_mm = 0;
  bool faulty = false;     // 20 % dropouts and 2 % outliers of 10 mm
  bool find_head = false;  // from the five spectacle markers; else the head pose is the true one
};

Session Record(const SessionOptions& wanted) {
  SyntheticTakeOptions options;
  options.seed = wanted.seed;
  options.speech.num_sentences = 8;
  options.identity = wanted.identity;
  options.identity_spread = 0;
  options.misplacement_mm = wanted.misplacement_mm;
  SyntheticNoiseOptions noise;
  noise.noise_mm = kNoiseMm;
  if (wanted.faulty) {
    noise.dropout = 0.2;
    noise.outliers = 0.02;
    noise.outlier_mm = 10;
  }
  SyntheticTake take = SynthesizeTake(DefaultHead(), Markers(), options).value();
  DisturbedRecording recorded = AddNoise(take.markers, noise, wanted.seed);
  if (wanted.find_head) {
    Stabilized found = OrThrow(Stabilize(recorded.markers.tracks, take.marker_set, {})).output;
    return {std::move(take), std::move(recorded), std::move(found.tracks),
            std::move(found.head_shape)};
  }
  HeadTracks tracks = ToHead(recorded.markers.tracks, take.true_pose);
  return {std::move(take), std::move(recorded), std::move(tracks), {}};
}

// Binds to the first second of the noisy recording itself, at rest, and fits all of it.
ParameterTrack BindAndFit(const Session& session, bool fit_identity) {
  BindOptions options;
  options.frames = "1:60";
  options.fit_identity = fit_identity;
  const Binding binding = OrThrow(Bind(session.tracks, session.head_shape, session.take.marker_set,
                                       DefaultHead(), options))
                              .output;
  return OrThrow(Fit(session.tracks, binding, DefaultHead(), {})).output.parameters;
}

// The variances that Cramer and Rao allow: diag((J^T J)^-1) sigma^2, with J the Jacobian, at the
// truth, of the face markers that survive: seen, and no outliers.
class CramerRao {
 public:
  explicit CramerRao(const Session& session)
      : session_(session),
        evaluator_(DefaultHead().WithIdentity(session.take.identity_values()),
                   FaceAttachments(session.take)) {
    for (std::size_t i = 0; i < session.take.marker_set.markers.size(); ++i)
      if (session.take.marker_set.markers[i].face) columns_.push_back(static_cast<int>(i));
  }

  Eigen::VectorXd VariancesOf(int frame) const {
    const Eigen::VectorXd truth = session_.take.truth.values.row(frame);
    Eigen::MatrixXd jacobian =
        evaluator_.DenseJacobian({truth.data(), static_cast<std::size_t>(truth.size())});
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (session_.recorded.fault(frame, columns_[i]) != SampleFault::kNone)
        jacobian.middleRows<3>(3 * static_cast<int>(i)).setZero();
    const Eigen::MatrixXd information = jacobian.transpose() * jacobian / (kNoiseMm * kNoiseMm);
    return information.ldlt()
        .solve(Eigen::MatrixXd::Identity(truth.size(), truth.size()))
        .diagonal();
  }

 private:
  static std::vector<VirtualMarker> FaceAttachments(const SyntheticTake& take) {
    std::vector<VirtualMarker> face;
    for (std::size_t i = 0; i < take.true_attachments.size(); ++i)
      if (take.marker_set.markers[i].face) face.push_back(take.true_attachments[i]);
    return face;
  }

  const Session& session_;
  VirtualMarkerEvaluator evaluator_;
  std::vector<int> columns_;  // of the face markers in the recording
};

// Squared errors and variances of each parameter, summed over the frames that count: those of
// speech in which the markers that survive determine every parameter to a tenth of its range.
struct Accuracy {
  Eigen::VectorXd squared_errors = Eigen::VectorXd::Zero(DefaultHead().num_parameters());
  Eigen::VectorXd variances = squared_errors;
  Eigen::VectorXd squared_deviates = squared_errors;  // errors over the sigmas that the fit states
  int num_frames = 0;
  int num_left_out = 0;

  void Add(const Session& session, const ParameterTrack& found) {
    const ParameterTrack& truth = session.take.truth;
    const CramerRao bound(session);
    for (int frame = 0; frame < truth.num_frames(); ++frame) {
      if (truth.values.row(frame).isZero(0)) continue;
      const Eigen::VectorXd frame_variances = bound.VariancesOf(frame);
      if (!AreDetermined(frame_variances)) {
        ++num_left_out;
        continue;
      }
      variances += frame_variances;
      const Eigen::VectorXd errors = found.values.row(frame) - truth.values.row(frame);
      squared_errors += errors.cwiseAbs2();
      squared_deviates += errors.cwiseQuotient(found.sigmas.row(frame).transpose()).cwiseAbs2();
      ++num_frames;
    }
  }

  // Errors are as large as the sigmas say, within `tolerance` of the ratio 1.
  void ExpectHonestSigmas(double tolerance) const {
    for (int i = 0; i < squared_deviates.size(); ++i) {
      const std::string& name = DefaultHead().definition().parameters[i].name;
      const double ratio = std::sqrt(squared_deviates[i] / num_frames);
      std::printf("  %-28s RMS error over sigma %.3f\n", name.c_str(), ratio);
      EXPECT_NEAR(ratio, 1, tolerance) << name;
    }
  }

  // The RMS error of every parameter stays within `factor` of the bound.
  void ExpectWithin(double factor) const {
    std::printf("  %d frames; %d left out, whose surviving markers determine too little\n",
                num_frames, num_left_out);
    for (int i = 0; i < variances.size(); ++i) {
      const std::string& name = DefaultHead().definition().parameters[i].name;
      const double rms = std::sqrt(squared_errors[i] / num_frames);
      const double least = std::sqrt(variances[i] / num_frames);
      std::printf("  %-28s RMS error %.5f, bound %.5f, ratio %.3f\n", name.c_str(), rms, least,
                  rms / least);
      EXPECT_LE(rms, factor * least) << name;
    }
    EXPECT_LT(num_left_out, 0.05 * num_frames);
  }

 private:
  static bool AreDetermined(const Eigen::VectorXd& variances) {
    for (int i = 0; i < variances.size(); ++i) {
      const RigParameter& range = DefaultHead().definition().parameters[i];
      if (!(std::sqrt(variances[i]) <= 0.1 * (range.max - range.min))) return false;
    }
    return true;
  }
};

// Several takes, because the error of a binding is one draw for all frames of its take.
Accuracy OverTakes(SessionOptions options) {
  Accuracy accuracy;
  for (options.seed = 11; options.seed < 17; ++options.seed) {
    const Session session = Record(options);
    accuracy.Add(session, BindAndFit(session, false));
  }
  return accuracy;
}

// The spatial median of three-dimensional normal noise, which the sum of distances comes down to,
// reaches 1.085 of the bound at best (Brown 1983).
// What exceeds the sigmas by a few per cent is the error of the binding, one draw a take.
TEST(AccuracyTest, OwnHeadComesNearTheCramerRaoBound) {
  const Accuracy accuracy = OverTakes({});
  accuracy.ExpectWithin(1.15);
  accuracy.ExpectHonestSigmas(0.1);
}

TEST(AccuracyTest, MarkersBesideTheirLandmarksCostLittle) {
  OverTakes({.misplacement_mm = 0.5}).ExpectWithin(1.25);
}

// The whole way from the recording. The bound is still that of a known head pose; the noise of the
// five spectacle markers comes on top, magnified at the chin: most in jaw_thrust (1.82 times the
// bound; 3.7 times were the poses not smoothed).
TEST(AccuracyTest, AHeadPoseFoundFromSpectacles) {
  OverTakes({.find_head = true}).ExpectWithin(1.9);
}

TEST(AccuracyTest, DropoutsAndOutliersCostLittle) {
  OverTakes({.misplacement_mm = 0.5, .faulty = true}).ExpectWithin(1.3);
}

TEST(AccuracyTest, AnotherIdentityKeepsTheMovements) {
  const Session session =
      Record({.seed = 13,
              .identity = {"face_width=0.08", "jaw_length=0.10", "lip_thickness=0.30"},
              .misplacement_mm = 0.5});
  const ParameterTrack found = BindAndFit(session, true);
  const ParameterTrack& truth = session.take.truth;
  for (int i = 0; i < truth.num_parameters(); ++i) {
    const Eigen::VectorXd x = truth.values.col(i), y = found.values.col(i);
    const Eigen::VectorXd dx = x.array() - x.mean(), dy = y.array() - y.mean();
    const double correlation = dx.dot(dy) / (dx.norm() * dy.norm());
    std::printf("  %-28s correlation %.4f, bias %+.4f %s, gain %.3f\n", truth.names[i].c_str(),
                correlation, y.mean() - x.mean(), truth.units[i].c_str(),
                dx.dot(dy) / dx.squaredNorm());
    EXPECT_GE(correlation, 0.97) << truth.names[i];
  }
}

}  // namespace
}  // namespace articap
