// SPDX-License-Identifier: MIT
#include "tracking/corrections.h"

#include <gmock/gmock.h>

#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

std::string FaultOf(const std::string& toml_text) {
  const auto read = ParseCorrections(toml_text, "c.toml");
  return read ? "" : read.error().message;
}

TEST(CorrectionsTest, EveryKindIsReadInTheOrderOfTheFile) {
  const Corrections corrections =
      OrThrow(ReadCorrections(SourceFolder() / "tests/golden/corrections.toml"));
  std::vector<CorrectionKind> kinds;
  std::vector<int> lines;
  for (const Correction& correction : corrections.list) {
    kinds.push_back(correction.kind);
    lines.push_back(correction.line);
  }
  EXPECT_THAT(
      kinds, ElementsAre(CorrectionKind::kSwap, CorrectionKind::kRelabel, CorrectionKind::kDelete,
                         CorrectionKind::kDeleteDot, CorrectionKind::kSplit, CorrectionKind::kSplit,
                         CorrectionKind::kMove, CorrectionKind::kSwap));
  EXPECT_THAT(lines, ElementsAre(4, 8, 13, 17, 22, 25, 29, 35));
  const Correction& relabel = corrections.list[1];
  EXPECT_EQ(relabel.marker, "chin");
  EXPECT_EQ(relabel.other, "lower_lip");
  EXPECT_EQ(relabel.first, 120);
  EXPECT_EQ(relabel.last, 164);
  const Correction& dot = corrections.list[3];
  EXPECT_EQ(dot.view, "front/left");
  EXPECT_EQ(dot.place_px, Eigen::Vector2d(412, 300.5));
  EXPECT_EQ(corrections.list[4].marker, "");
  EXPECT_EQ(corrections.list[5].marker, "chin");
  const Correction& move = corrections.list[6];
  EXPECT_EQ(move.marker, "chin");
  EXPECT_EQ(move.first, 120);
  EXPECT_EQ(move.last, 120);
}

TEST(CorrectionsTest, AnEmptyFileCorrectsNothing) {
  EXPECT_THAT(OrThrow(ParseCorrections("# nothing yet\n", "c.toml")).list, SizeIs(0));
}

TEST(CorrectionsTest, FaultsAreNamedWithTheirLine) {
  EXPECT_THAT(FaultOf("\n[[relabel]]\nmarker = 'a'\nframe = 3\n"),
              HasSubstr("c.toml, line 2: 'is' is missing"));
  EXPECT_THAT(FaultOf("[[swap]]\nmarkers = ['a']\nframe = 3\n"), HasSubstr("line 1: 'markers'"));
  EXPECT_THAT(FaultOf("[[swap]]\nmarkers = ['a', 'a']\nframe = 3\n"), HasSubstr("own place"));
  EXPECT_THAT(FaultOf("[[delete]]\nmarker = 'a'\nframes = [9, 8]\n"), HasSubstr("'frames'"));
  EXPECT_THAT(FaultOf("[[delete]]\nmarker = 'a'\nframes = [1.5, 8]\n"), HasSubstr("whole"));
  EXPECT_THAT(FaultOf("[[delete]]\nmarker = 'a'\nframe = 1\nframes = [1, 8]\n"),
              HasSubstr("not both"));
  EXPECT_THAT(FaultOf("[[delete]]\nmarker = 'a'\n"), HasSubstr("'frames' is needed"));
  EXPECT_THAT(FaultOf("[[delete]]\nmarker = 'a'\nview = 'b'\nat_px = [1, 2]\nframe = 1\n"),
              HasSubstr("choose one"));
  EXPECT_THAT(FaultOf("[[move]]\nmarker = 'a'\nview = 'b'\nto_px = [1]\nframe = 1\n"),
              HasSubstr("'to_px' must be two numbers"));
  EXPECT_THAT(FaultOf("[[split]]\nframe = -4\n"), HasSubstr("'frame' is no number"));
  EXPECT_THAT(FaultOf("[[split]]\nframe = 4\nframes = [1, 2]\n"), HasSubstr("no key"));
  EXPECT_THAT(FaultOf("[[rename]]\nmarker = 'a'\n"), HasSubstr("'rename' is no key"));
  EXPECT_THAT(FaultOf("relabel = 3\n"), HasSubstr("[[relabel]]"));
  EXPECT_THAT(FaultOf("[[split]\n"), HasSubstr("c.toml, line 1"));
}

}  // namespace
}  // namespace articap
