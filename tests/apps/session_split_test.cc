// SPDX-License-Identifier: MIT
#include "apps/session_split.h"

#include <gmock/gmock.h>

#include "apps/session_import.h"
#include "apps/take.h"
#include "apps/take_input.h"
#include "core/file_io.h"
#include "tests/support/report_figures.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class SessionSplitTest : public testing::Test {
 protected:
  // The demo, whose labels begin 250 ms late.
  SessionSplitTest() {
    const fs::path demo = SourceFolder() / "recordings" / "demo";
    EXPECT_TRUE(WriteFile(session_ / kSessionFileName, WriteSessionInfo({.speaker = "anna"})));
    ImportOptions options;
    options.id = "long";
    Import import = OrThrow(PrepareImport(
        {(demo / "take.c3d").string(), (demo / "labels.TextGrid").string()}, options));
    import.files[1].info.offset = milliseconds(250);
    take_ = OrThrow(StoreTake(session_, import)).take;
  }
  ~SessionSplitTest() override { fs::remove_all(session_); }

  StoredTake Part(const std::string& id) const {
    return OrThrow(OpenTake(session_ / kTakesFolderName / id));
  }

  const fs::path session_ = MakeTemporaryFolder("articap_session_split_test");
  StoredTake take_;
};

TEST_F(SessionSplitTest, AWordBecomesATakeOfTheSameFiles) {
  SplitRule rule;
  rule.tier = "words";
  const std::vector<Cut> cuts = OrThrow(FindCuts(take_, rule, {}));
  const TextGrid labels = OrThrow(ReadTextGrid(take_.folder / "labels.TextGrid"));
  const TextGridTier& words = *OrThrow(FindPhoneTier(labels, "words"));
  std::vector<TextGridLabel> spoken;
  for (const TextGridLabel& label : words.labels)
    if (!label.text.empty()) spoken.push_back(label);
  ASSERT_THAT(cuts, SizeIs(spoken.size()));
  EXPECT_DOUBLE_EQ(cuts[1].start_s, spoken[1].start_s + 0.25);
  SplitOptions options;
  options.pad_s = 0.05;
  const StageReport report = OrThrow(SplitTake(take_, {cuts[1]}, options));
  EXPECT_EQ(FigureOf(report, "parts"), 1);
  const std::string id = report.tables[0].rows[0].label;
  EXPECT_EQ(id, "long_01_" + SafeNameOf(spoken[1].text));
  const StoredTake part = Part(id);
  EXPECT_THAT(VerifyTake(part), IsEmpty());
  EXPECT_NEAR(std::chrono::duration<double>(part.info.part->start).count(), spoken[1].start_s + 0.2,
              1e-9);
  EXPECT_EQ(std::distance(fs::directory_iterator(part.folder), {}), 1);
}

TEST_F(SessionSplitTest, AFitReadsThePartsFramesWithTheWholesTimes) {
  OrThrow(SplitTake(take_, {{2, 3.5, "a"}}, {.pad_s = 0}));
  const TakeInput input = OrThrow(FindTakeInput(Part("long_01_a").folder.string(), ""));
  EXPECT_DOUBLE_EQ(input.labels_shift_s, 0.25);
  EXPECT_EQ(OrThrow(DigestOf(input.labels)), OrThrow(DigestOf(take_.folder / "labels.TextGrid")));
  ASSERT_TRUE(input.span);
  const StageTracks whole = OrThrow(ReadTake(input.markers, {}, false)).recording.tracks;
  const StageTracks part = OrThrow(ReadTake(input.markers, {}, false, input.span)).recording.tracks;
  ASSERT_EQ(part.num_frames(), 90);  // 1.5 s at 60 Hz
  EXPECT_EQ(part.first_frame(), whole.first_frame() + 120);
  EXPECT_EQ(part.time(0), whole.time(120));
  EXPECT_EQ(part.position_mm(5, 3), whole.position_mm(125, 3));
}

TEST_F(SessionSplitTest, PartsEndWithTheRecordingAndKeepTheirNumbers) {
  const double end_s = take_.info.files[0].duration_s();
  const StageReport report =
      OrThrow(SplitTake(take_, {{-5, 1, ""}, {20, 21, "later"}, {9, 30, "b c"}}, {.pad_s = 0.5}));
  ASSERT_THAT(report.tables[0].rows, SizeIs(2));
  EXPECT_EQ(report.tables[0].rows[0].label, "long_01");
  EXPECT_THAT(report.tables[0].rows[0].values, ElementsAre(0, 1.5, 1.5));
  EXPECT_EQ(report.tables[0].rows[1].label, "long_02_b_c");
  EXPECT_NEAR(report.tables[0].rows[1].values[1], end_s, 1e-9);
  EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("later")));
  // Cut again, they are further versions.
  OrThrow(SplitTake(take_, {{0, 1, ""}}, {}));
  EXPECT_TRUE(IsTakeFolder(session_ / kTakesFolderName / "long_01_v2"));
}

TEST_F(SessionSplitTest, WhatCannotBeCutIsSaid) {
  EXPECT_THAT(SplitTake(take_, {{20, 21, ""}}, {}).error().message, HasSubstr("nothing"));
  StoredTake labels_alone = take_;
  labels_alone.info.files.erase(labels_alone.info.files.begin());
  EXPECT_THAT(SplitTake(labels_alone, {{2, 3, ""}}, {}).error().message, HasSubstr("nothing"));
  EXPECT_THAT(OrThrow(OpenSession(session_)).unfinished(), IsEmpty());
  SplitRule rule;
  rule.silence = true;
  EXPECT_THAT(FindCuts(take_, rule, {}).error().message, HasSubstr("0 files of audio"));
  EXPECT_THAT(FindCuts(take_, rule, {.pad_s = -1}).error().message, HasSubstr("--pad-s is -1"));
  OrThrow(SplitTake(take_, {{2, 3, ""}}, {}));
  EXPECT_THAT(FindCuts(Part("long_01"), rule, {}).error().message, HasSubstr("a part of long"));
  fs::remove(take_.folder / "labels.TextGrid");
  rule.tier = "words";
  EXPECT_THAT(FindCuts(take_, rule, {}).error().message, HasSubstr("labels.TextGrid is missing"));
}

}  // namespace
}  // namespace articap
