// SPDX-License-Identifier: MIT
// The synthetic speaker on the project's own head: what the patch of a face cannot tell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/marker_set.h"
#include "rig/default_head/default_head.h"
#include "synthetic/lip_gauge.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

const FaceRig& DefaultHead() {
  static const FaceRig rig = MakeDefaultHead().value();
  return rig;
}

SyntheticSpeech Speak(const FaceRig& rig) {
  SyntheticSpeechOptions options;
  options.num_sentences = 20;
  return SynthesizeSpeech(rig, options, 1);
}

TEST(DefaultHeadSpeechTest, LipsMeetInBilabialsWhoeverSpeaks) {
  const int num_sliders = static_cast<int>(DefaultHead().definition().identity_sliders.size());
  for (const double part : {0.0, 0.8, -0.8}) {
    Eigen::VectorXd identity(num_sliders);
    for (int i = 0; i < num_sliders; ++i) {
      const IdentitySlider& slider = DefaultHead().definition().identity_sliders[i];
      identity[i] = part > 0 ? part * slider.max : -part * slider.min;
    }
    const FaceRig rig = DefaultHead().WithIdentity(identity);
    const auto lips = LipGauge::Create(rig);
    ASSERT_TRUE(lips);
    const SyntheticSpeech speech = Speak(rig);
    for (const PhoneToken& token : speech.utterances.phones) {
      if (!token.phone || token.phone->contact != LipContact::kLipToLip) continue;
      const int frame = static_cast<int>(std::lround(token.center_s() * speech.track.rate_hz));
      EXPECT_LT(std::abs(lips->OpeningMm(speech.track.values.row(frame))), 0.5)
          << token.name() << " at " << token.center_s() << " s";
    }
  }
}

TEST(DefaultHeadSpeechTest, MouthsOpenAsFarAsMouthsDo) {
  const auto lips = LipGauge::Create(DefaultHead());
  ASSERT_TRUE(lips);
  const SyntheticSpeech speech = Speak(DefaultHead());
  std::vector<double> openings_mm;
  for (int frame = 0; frame < speech.track.num_frames(); ++frame)
    openings_mm.push_back(lips->OpeningMm(speech.track.values.row(frame)));
  EXPECT_GT(*std::min_element(openings_mm.begin(), openings_mm.end()), -0.2) << "lips cross";
  // Between the lips of open vowels speakers have 15 to 25 mm.
  const double widest_mm = *std::max_element(openings_mm.begin(), openings_mm.end());
  EXPECT_GT(widest_mm, 15);
  EXPECT_LT(widest_mm, 26);
}

TEST(DefaultHeadSpeechTest, UsesAGoodPartOfEveryRange) {
  const ParameterTrack track = Speak(DefaultHead()).track;
  for (int i = 0; i < track.num_parameters(); ++i) {
    const RigParameter& range = DefaultHead().definition().parameters[i];
    const double least = track.values.col(i).minCoeff(), most = track.values.col(i).maxCoeff();
    EXPECT_GE(least, range.min) << range.name;
    EXPECT_LE(most, range.max) << range.name;
    EXPECT_GE(most - least, 0.45 * (range.max - range.min)) << range.name;
  }
}

TEST(DefaultHeadSpeechTest, WearsThirtyFiveMarkersOfWhichTheSpectaclesAreRigid) {
  const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml").value();
  SyntheticTakeOptions options;
  options.speech.num_sentences = 1;
  const SyntheticTake take = SynthesizeTake(DefaultHead(), set, options).value();
  const StageTracks& tracks = take.markers.tracks;
  ASSERT_EQ(tracks.num_markers(), 35);
  for (int marker = 0; marker < tracks.num_markers(); ++marker) {
    double travel_mm = 0;  // in the head frame
    const Eigen::Vector3d first =
        take.true_pose.poses[0].head_from_stage * tracks.position_mm(0, marker);
    for (int frame = 0; frame < tracks.num_frames(); ++frame)
      travel_mm = std::max(
          travel_mm,
          (take.true_pose.poses[frame].head_from_stage * tracks.position_mm(frame, marker) - first)
              .norm());
    const MarkerRole& role = take.marker_set.markers[marker];
    if (role.head_reference) {
      EXPECT_LT(travel_mm, 1e-9) << role.name;
    }
    if (role.name.find("lip") != std::string::npos || role.name.find("chin") == 0) {
      EXPECT_GT(travel_mm, 3) << role.name;
    }
  }
}

}  // namespace
}  // namespace articap
