// SPDX-License-Identifier: MIT
#include "synthetic/speech.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "synthetic/lip_gauge.h"
#include "synthetic/text_grid_writer.h"
#include "tests/synthetic/patch_face.h"

namespace articap {
namespace {

SyntheticSpeechOptions Sentences(int count) {
  SyntheticSpeechOptions options;
  options.num_sentences = count;
  return options;
}

TEST(SynthesizeSpeechTest, SameSeedSameSpeechOtherSeedOtherSpeech) {
  const FaceRig rig = MakePatchFace();
  const SyntheticSpeech a = SynthesizeSpeech(rig, Sentences(2), 5);
  const SyntheticSpeech b = SynthesizeSpeech(rig, Sentences(2), 5);
  const SyntheticSpeech c = SynthesizeSpeech(rig, Sentences(2), 6);
  EXPECT_EQ(a.track.values, b.track.values);
  EXPECT_EQ(WriteTextGrid(LabelsOf(a.utterances)), WriteTextGrid(LabelsOf(b.utterances)));
  EXPECT_NE(WriteTextGrid(LabelsOf(a.utterances)), WriteTextGrid(LabelsOf(c.utterances)));
}

TEST(SynthesizeSpeechTest, StaysWithinTheRangesAndUsesThem) {
  const FaceRig rig = MakePatchFace();
  const ParameterTrack track = SynthesizeSpeech(rig, Sentences(20), 1).track;
  for (int i = 0; i < rig.num_parameters(); ++i) {
    const RigParameter& range = rig.definition().parameters[i];
    std::vector<double> values(track.values.col(i).begin(), track.values.col(i).end());
    std::sort(values.begin(), values.end());
    EXPECT_GE(values.front(), range.min) << range.name;
    EXPECT_LE(values.back(), range.max) << range.name;
    const double used = values[values.size() * 98 / 100] - values[values.size() * 2 / 100];
    EXPECT_GE(used, 0.3 * (range.max - range.min)) << range.name << ", 2nd to 98th percentile";
    EXPECT_GE(values.back() - values.front(), 0.45 * (range.max - range.min)) << range.name;
  }
}

TEST(SynthesizeSpeechTest, RestsExactlyBeforeAndAfter) {
  SyntheticSpeechOptions options = Sentences(1);
  options.rest_s = 1;
  const ParameterTrack track = SynthesizeSpeech(MakePatchFace(), options, 2).track;
  const int rest_frames = static_cast<int>(options.rest_s * options.rate_hz);
  EXPECT_EQ(track.values.topRows(rest_frames).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(track.values.bottomRows(rest_frames).cwiseAbs().maxCoeff(), 0);
  EXPECT_GT(track.values.cwiseAbs().maxCoeff(), 1);
}

// Peak acceleration of a parameter, as a multiple of its range a second squared.
double PeakAcceleration(const ParameterTrack& track, int parameter, const RigParameter& range) {
  double peak = 0;
  for (int frame = 1; frame + 1 < track.num_frames(); ++frame)
    peak = std::max(
        peak, std::abs(track.values(frame - 1, parameter) - 2 * track.values(frame, parameter) +
                       track.values(frame + 1, parameter)));
  return peak * track.rate_hz * track.rate_hz / (range.max - range.min);
}

TEST(SynthesizeSpeechTest, MovesSmoothly) {
  const FaceRig rig = MakePatchFace();
  SyntheticSpeechOptions options = Sentences(10);
  options.rate_hz = 960;
  const ParameterTrack fine = SynthesizeSpeech(rig, options, 3).track;
  options.rate_hz = 480;
  const ParameterTrack coarse = SynthesizeSpeech(rig, options, 3).track;
  for (int i = 0; i < rig.num_parameters(); ++i) {
    const RigParameter& range = rig.definition().parameters[i];
    const double peak = PeakAcceleration(fine, i, range);
    // A step over the whole range within the quickest closure, 2 x 40 ms, peaks at
    // 1.878 / 0.04^2 = 1170 ranges a second squared; a lower lip that runs into the upper brakes
    // faster still.
    EXPECT_LT(peak, range.name == "lower_lip_depression" ? 2000 : 1170) << range.name;
    // A jump or a kink would double it when the step is halved.
    EXPECT_LT(peak, 1.1 * PeakAcceleration(coarse, i, range)) << range.name;
  }
}

TEST(SynthesizeSpeechTest, LipsMeetInBilabialsAndNowhereElseCross) {
  const FaceRig rig = MakePatchFace();
  const auto lips = LipGauge::Create(rig);
  ASSERT_TRUE(lips);
  const SyntheticSpeech speech = SynthesizeSpeech(rig, Sentences(20), 4);
  int closures = 0;
  for (const PhoneToken& token : speech.utterances.phones) {
    if (!token.phone || token.phone->contact != LipContact::kLipToLip) continue;
    ++closures;
    const int frame = static_cast<int>(std::lround(token.center_s() * speech.track.rate_hz));
    EXPECT_LT(std::abs(lips->OpeningMm(speech.track.values.row(frame))), 0.7) << token.name();
  }
  EXPECT_GT(closures, 20);
  double widest_mm = 0;
  for (int frame = 0; frame < speech.track.num_frames(); ++frame) {
    const double opening_mm = lips->OpeningMm(speech.track.values.row(frame));
    EXPECT_GT(opening_mm, -1) << "frame " << frame;
    widest_mm = std::max(widest_mm, opening_mm);
  }
  EXPECT_GT(widest_mm, 12);
}

TEST(SynthesizeSpeechTest, BothMouthCornersMoveAlikeButNotTheSame) {
  const FaceRig rig = MakePatchFace();
  const ParameterTrack track = SynthesizeSpeech(rig, Sentences(20), 5).track;
  const Eigen::VectorXd left = track.values.col(*rig.FindParameter("left_mouth_corner_stretch"));
  const Eigen::VectorXd right = track.values.col(*rig.FindParameter("right_mouth_corner_stretch"));
  const Eigen::VectorXd l = left.array() - left.mean(), r = right.array() - right.mean();
  const double correlation = l.dot(r) / (l.norm() * r.norm());
  EXPECT_GT(correlation, 0.7);
  EXPECT_LT(correlation, 0.99);
}

TEST(SynthesizeSpeechTest, PhonesLastAsLongAsKlattHasThem) {
  const SyntheticSpeech speech = SynthesizeSpeech(MakePatchFace(), Sentences(60), 6);
  std::map<std::string_view, std::vector<double>> durations_ms;
  for (const PhoneToken& token : speech.utterances.phones)
    if (token.phone) durations_ms[token.name()].push_back(1e3 * (token.end_s - token.begin_s));
  for (const PhoneModel& phone : Phones()) {
    const std::vector<double>& found = durations_ms[phone.name];
    ASSERT_GT(found.size(), 10u) << phone.name;
    double mean_ms = 0;
    for (const double duration_ms : found) {
      EXPECT_GE(duration_ms, phone.minimum_ms) << phone.name;
      mean_ms += duration_ms / static_cast<double>(found.size());
    }
    EXPECT_LT(mean_ms, phone.inherent_ms) << phone.name;
  }
}

TEST(SynthesizeSpeechTest, LabelsFillTheTakeWithoutGaps) {
  const SyntheticSpeech speech = SynthesizeSpeech(MakePatchFace(), Sentences(3), 7);
  const TextGrid grid = LabelsOf(speech.utterances);
  ASSERT_EQ(grid.tiers.size(), 2u);
  for (const TextGridTier& tier : grid.tiers) {
    double end_s = grid.start_s;
    for (const TextGridLabel& interval : tier.labels) {
      EXPECT_EQ(interval.start_s, end_s);
      EXPECT_GT(interval.end_s, interval.start_s);
      end_s = interval.end_s;
    }
    EXPECT_EQ(end_s, grid.end_s);
  }
  const ParameterTrack& track = speech.track;
  ASSERT_EQ(track.phones.size(), static_cast<std::size_t>(track.num_frames()));
  for (const PhoneToken& token : speech.utterances.phones) {
    const int frame = static_cast<int>(std::ceil(token.begin_s * track.rate_hz + 1e-9));
    if (frame / track.rate_hz < token.end_s) {
      EXPECT_EQ(track.phones[frame], token.name());
    }
  }
}

}  // namespace
}  // namespace articap
