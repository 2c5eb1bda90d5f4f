// SPDX-License-Identifier: MIT
#include "synthetic/take_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/marker_io.h"
#include "tests/support/matchers.h"
#include "tests/synthetic/patch_face.h"

namespace articap {
namespace {

using testing::HasSubstr;

struct Written {
  SyntheticTake take;
  DisturbedRecording recorded;
  std::vector<OutputFile> files;

  const std::string& operator[](const std::string& name) const {
    const auto file = std::find_if(files.begin(), files.end(),
                                   [&](const OutputFile& f) { return f.name == name; });
    if (file == files.end()) throw std::runtime_error("no file " + name);
    return file->bytes;
  }
};

Written Write(int seed) {
  SyntheticTakeOptions options;
  options.seed = seed;
  options.speech.num_sentences = 1;
  options.speaker_scale = 1.05;
  SyntheticNoiseOptions noise;
  noise.noise_mm = 0.1;
  noise.dropout = 0.05;
  noise.outliers = 0.01;
  SyntheticTake take = SynthesizeTake(MakePatchFace(), PatchFaceMarkers(), options).value();
  DisturbedRecording recorded = AddNoise(take.markers, noise, seed);
  std::vector<OutputFile> files = FilesOf(take, recorded, noise);
  return {std::move(take), std::move(recorded), std::move(files)};
}

template <class T>
T Parsed(Result<T> result) {
  EXPECT_TRUE(result) << result.error().message;
  return *std::move(result);
}

TEST(FilesOfTest, SameSeedSameBytesOtherSeedOthers) {
  const Written a = Write(1), b = Write(1), c = Write(2);
  ASSERT_EQ(a.files.size(), b.files.size());
  for (const OutputFile& file : a.files) {
    EXPECT_EQ(file.bytes, b[file.name]) << file.name;
    if (file.name != "markers.toml") {
      EXPECT_NE(file.bytes, c[file.name]) << file.name;
    }
  }
}

TEST(FilesOfTest, TheMarkersReadBack) {
  const Written written = Write(3);
  const std::string& bytes = written["take.c3d"];
  const StageTracks& expected = written.recorded.markers.tracks;
  const StageTracks tracks =
      Parsed(ParseMarkers(std::as_bytes(std::span(bytes)), "take.c3d")).tracks;
  ASSERT_EQ(tracks.names(), expected.names());
  ASSERT_EQ(tracks.num_frames(), expected.num_frames());
  EXPECT_EQ(tracks.rate_hz(), expected.rate_hz());
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      ASSERT_EQ(tracks.is_missing(frame, marker), expected.is_missing(frame, marker));
      if (tracks.is_missing(frame, marker)) continue;
      // Floats of some 1,300 mm.
      ASSERT_THAT(tracks.position_mm(frame, marker),
                  PointNear(expected.position_mm(frame, marker), 2e-4));
    }
}

TEST(FilesOfTest, TheTruthReadsBack) {
  const Written written = Write(4);
  const ParameterTrack truth = Parsed(ParseParameterCsv(written["truth.csv"], "truth.csv"));
  EXPECT_EQ(truth.names, written.take.truth.names);
  EXPECT_EQ(truth.phones, written.take.truth.phones);
  EXPECT_LT((truth.values - written.take.truth.values).cwiseAbs().maxCoeff(), 1e-5);

  const HeadPoseTrack pose = Parsed(ParseHeadPoseCsv(written["truth.pose.csv"], "truth.pose.csv"));
  ASSERT_EQ(pose.poses.size(), written.take.true_pose.poses.size());
  for (std::size_t frame = 0; frame < pose.poses.size(); frame += 50)
    EXPECT_THAT(pose.poses[frame].head_from_stage,
                Rigid3dNear(written.take.true_pose.poses[frame].head_from_stage, 1e-6, 1e-4));

  const TextGrid labels = Parsed(ParseTextGrid(written["labels.TextGrid"], "labels.TextGrid"));
  const TextGridTier* const phones = Parsed(FindPhoneTier(labels));
  EXPECT_EQ(phones->labels.front().text, "SIL");
}

TEST(FilesOfTest, TruthTomlNamesSpeakerOptionsAndFaults) {
  const Written written = Write(5);
  const std::string& toml = written["truth.toml"];
  EXPECT_THAT(toml, HasSubstr("rig = \"patch\""));
  EXPECT_THAT(toml, HasSubstr("seed = 5"));
  EXPECT_THAT(toml, HasSubstr("\"face_width\" = "));
  EXPECT_THAT(toml, HasSubstr("noise_mm = 0.1"));
  EXPECT_THAT(toml, HasSubstr("name = \"chin\""));
  const int outliers = written.recorded.Count(SampleFault::kOutlier);
  EXPECT_THAT(toml, HasSubstr("outlier = " + std::to_string(outliers)));
  const std::string& faults = written["truth.faults.csv"];
  EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 1 + outliers);
}

}  // namespace
}  // namespace articap
