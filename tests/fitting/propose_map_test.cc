// SPDX-License-Identifier: MIT
// Marker maps proposed for takes whose marker names say nothing.
#include "fitting/propose_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "core/marker_io.h"
#include "rig/default_head/default_head.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using ::testing::HasSubstr;

const FaceRig& DefaultHead() {
  static const FaceRig rig = MakeDefaultHead().value();
  return rig;
}

MarkerSet MapNamed(const std::string& name) {
  return ReadMarkerSet(SourceFolder() / "maps" / (name + ".toml")).value();
}

// The same tracks under names without meaning: "m0", "m1", ...
StageTracks WithoutNames(const StageTracks& tracks) {
  std::vector<std::string> names;
  for (int m = 0; m < tracks.num_markers(); ++m) names.push_back("m" + std::to_string(m));
  StageTracks nameless(names, tracks.num_frames(), tracks.rate_hz());
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int m = 0; m < tracks.num_markers(); ++m)
      if (!tracks.is_missing(frame, m)) nameless.Set(frame, m, tracks.position_mm(frame, m));
  return nameless;
}

SyntheticTake Speaker(int seed) {
  SyntheticTakeOptions options;
  options.seed = seed;
  options.speech.num_sentences = 2;
  return SynthesizeTake(DefaultHead(), MapNamed("spectacles30"), options).value();
}

// How many of the markers that the true map puts at a landmark are proposed for that landmark.
struct Agreement {
  int right = 0, total = 0;
};
Agreement Compare(const MarkerSet& proposed, const MarkerSet& truth,
                  const std::vector<std::string>& true_names) {
  Agreement agreement;
  for (std::size_t m = 0; m < true_names.size(); ++m) {
    const MarkerRole* role = truth.Find(true_names[m]);
    if (!role || role->landmark.empty()) continue;
    ++agreement.total;
    const MarkerRole* proposal = proposed.Find("m" + std::to_string(m));
    if (proposal && proposal->landmark == role->landmark)
      ++agreement.right;
    else
      std::printf("%s: %s for %s\n", true_names[m].c_str(),
                  proposal ? proposal->landmark.c_str() : "-", role->landmark.c_str());
  }
  std::printf("%d of %d markers at their landmarks\n", agreement.right, agreement.total);
  return agreement;
}

// z is up, which the first case does not know, and the speaker looks anywhere.
TEST(ProposeMapTest, FindsThePlacesOfASyntheticSpeakersMarkers) {
  for (const int seed : {1, 2}) {
    const SyntheticTake take = Speaker(seed);
    ProposeMapOptions options;
    if (seed > 1) options.up = "+z";
    const auto proposal =
        ProposeMap(WithoutNames(take.markers.tracks), "test", DefaultHead(), options);
    ASSERT_TRUE(proposal) << proposal.error().message;
    EXPECT_TRUE(proposal->report.usable) << proposal->report.BriefReport();
    const Agreement agreement =
        Compare(proposal->output, take.marker_set, take.markers.tracks.names());
    EXPECT_EQ(agreement.total, 35);
    EXPECT_GE(agreement.right, 31) << proposal->report.BriefReport();
    EXPECT_EQ(proposal->output.mode, StabilizationMode::kRigid);
  }
}

TEST(ProposeMapTest, TheProposalIsAMapThatCanBeRead) {
  const SyntheticTake take = Speaker(4);
  ProposeMapOptions options;
  options.up = "+z";
  const auto proposal =
      ProposeMap(WithoutNames(take.markers.tracks), "odd \"name\"", DefaultHead(), options);
  ASSERT_TRUE(proposal) << proposal.error().message;
  const std::string text = WriteMapProposal(*proposal);
  EXPECT_THAT(text, HasSubstr("# A proposal"));
  const auto read = ParseMarkerSet(text, "proposal");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(WriteMarkerSet(*read), WriteMarkerSet(proposal->output));
  EXPECT_EQ(read->name, "odd \"name\"");
}

TEST(ProposeMapTest, RealMarkersFindTheirPlaces) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  const auto recording = ReadMarkers(TestDataPath("animface/jaw.trc"), {});
  ASSERT_TRUE(recording) << recording.error().message;
  const ProposeMapOptions options{.up = "+y", .forward = "+z"};
  const auto proposal = ProposeMap(WithoutNames(recording->tracks), "jaw", DefaultHead(), options);
  ASSERT_TRUE(proposal) << proposal.error().message;
  EXPECT_TRUE(proposal->report.usable) << proposal->report.BriefReport();
  const Agreement agreement =
      Compare(proposal->output, MapNamed("animface"), recording->tracks.names());
  EXPECT_GE(agreement.right, 24) << proposal->report.BriefReport();
  // Some are taken for their neighbours, and the report says so.
  EXPECT_THAT(proposal->report.warnings,
              testing::Contains(HasSubstr("on one side of the face alone")));
}

TEST(ProposeMapTest, NamesAxesThatContradictOneAnother) {
  const ProposeMapOptions options{.up = "+z", .forward = "-z"};
  const auto proposal = ProposeMap(Speaker(1).markers.tracks, "test", DefaultHead(), options);
  ASSERT_FALSE(proposal);
  EXPECT_THAT(proposal.error().message, HasSubstr("right angles"));
}

}  // namespace
}  // namespace articap
