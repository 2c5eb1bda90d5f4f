// SPDX-License-Identifier: MIT
#include "core/text_grid.h"

#include <gmock/gmock.h>

#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::AllOf;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

using Kind = TextGridTier::Kind;

auto Label(double start_s, double end_s, const std::string& text) {
  return AllOf(Field("start_s", &TextGridLabel::start_s, DoubleEq(start_s)),
               Field("end_s", &TextGridLabel::end_s, DoubleEq(end_s)),
               Field("text", &TextGridLabel::text, text));
}

TextGrid ReadGolden(const std::string& name) {
  const auto grid = ReadTextGrid(SourceFolder() / "tests/golden/text_grid" / name);
  EXPECT_TRUE(grid) << grid.error().message;
  return grid ? *grid : TextGrid{};
}

// The same annotation in every form and encoding that Praat writes.
void ExpectGoldenContent(const TextGrid& grid, const std::string& last_mark) {
  EXPECT_EQ(grid.start_s, 0);
  EXPECT_EQ(grid.end_s, 1.5);
  ASSERT_THAT(grid.tiers, SizeIs(3));
  EXPECT_EQ(grid.tiers[0].name, "words");
  EXPECT_THAT(grid.tiers[0].labels,
              ElementsAre(Label(0, 0.5, ""), Label(0.5, 1.5, "say \"\u00e9t\u00e9\"")));
  EXPECT_EQ(grid.tiers[1].name, "phones");
  EXPECT_EQ(grid.tiers[1].kind, Kind::kIntervals);
  EXPECT_THAT(grid.tiers[1].labels, ElementsAre(Label(0, 0.5, ""), Label(0.5, 0.8, "e"),
                                                Label(0.8, 1.1, "t"), Label(1.1, 1.5, "\"e:")));
  EXPECT_EQ(grid.tiers[2].kind, Kind::kPoints);
  EXPECT_THAT(grid.tiers[2].labels,
              ElementsAre(Label(0.25, 0.25, "first\nsecond line"), Label(1.25, 1.25, last_mark)));
}

class TextGridForms : public testing::TestWithParam<const char*> {};

TEST_P(TextGridForms, HoldTheSameAnnotation) {
  const TextGrid grid = ReadGolden(GetParam());
  ExpectGoldenContent(grid, "\u0283");
  EXPECT_THAT(grid.warnings, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Golden, TextGridForms,
                         testing::Values("long_utf8.TextGrid", "short_utf8_crlf.TextGrid",
                                         "long_utf16be.TextGrid", "short_utf16le.TextGrid"));

TEST(TextGridTest, Latin1IsReadWithAWarning) {
  const TextGrid grid = ReadGolden("long_latin1.TextGrid");
  ExpectGoldenContent(grid, "S");
  EXPECT_THAT(grid.warnings, ElementsAre(HasSubstr("Latin-1")));
}

TEST(TextGridTest, Utf16WithoutByteOrderMarkIsRecognised) {
  std::string bytes;
  for (const char c : std::string("\"ooTextFile\"\n\"TextGrid\"\n0 1 <absent>\n")) {
    bytes += '\0';
    bytes += c;
  }
  const auto grid = ParseTextGrid(bytes, "bare.TextGrid");
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(grid->end_s, 1);
  EXPECT_THAT(grid->tiers, IsEmpty());
}

TEST(TextGridTest, CommentsAndUnknownWordsArePassedOver) {
  const auto grid = ParseTextGrid(
      "\"ooTextFile\" \"TextGrid\" ! of 3 May\nfrom 0 to 2 s, tiers: <exists>, 1 tier\n"
      "\"TextTier\" called \"clicks\" 0 2 with 1 point at 1 \"x\"",
      "hand.TextGrid");
  ASSERT_TRUE(grid) << grid.error().message;
  ASSERT_THAT(grid->tiers, SizeIs(1));
  EXPECT_THAT(grid->tiers[0].labels, ElementsAre(Label(1, 1, "x")));
}

struct BadGrid {
  const char* text;
  const char* message;
};

class BadTextGrid : public testing::TestWithParam<BadGrid> {};

TEST_P(BadTextGrid, IsRefusedWithPlaceAndReason) {
  const auto grid = ParseTextGrid(GetParam().text, "bad.TextGrid");
  ASSERT_FALSE(grid);
  EXPECT_THAT(grid.error().message, HasSubstr("bad.TextGrid"));
  EXPECT_THAT(grid.error().message, HasSubstr(GetParam().message));
}

#define HEAD "\"ooTextFile\"\n\"TextGrid\"\n0\n1\n<exists>\n"
INSTANTIATE_TEST_SUITE_P(
    Kinds, BadTextGrid,
    testing::Values(
        BadGrid{"", "does not begin with \"ooTextFile\""},
        BadGrid{"ooBinaryFile\x08TextGrid", "binary Praat file"},
        BadGrid{"\"ooTextFile\"\n\"PitchTier\"\n", "bad.TextGrid:2: holds a PitchTier"},
        BadGrid{"\"ooTextFile\"\n\"TextGrid\"\n\"a\"", ":3: the start of the TextGrid"},
        BadGrid{HEAD "1e300\n", ":6: the number of tiers is 1e+300, which is no count"},
        BadGrid{HEAD "-1\n", "no count"},
        BadGrid{HEAD "1\n\"Pitch\" \"a\"", "only IntervalTier and TextTier"},
        BadGrid{HEAD "1\n\"IntervalTier\"\n\"a\"\n0\n1\n999999999\n0\n0.5\n\"a\"\n",
                ":15: the start of an interval should be here, a number, but there is the end"},
        BadGrid{HEAD "1\n\"IntervalTier\"\n\"a\"\n0\n1\n1\n0.5\n0.25\n\"a\"\n",
                ":14: label 1 of tier 'a' ends (0.25 s) before it starts"},
        BadGrid{HEAD "1\n\"IntervalTier\"\n\"a\"\n0\n1\n2\n0\n0.5\n\"a\"\n0.25\n1\n\"b\"",
                "starts at 0.25 s, before the one before it ends"},
        BadGrid{HEAD "1\n\"IntervalTier\"\n\"a", "does not end"},
        BadGrid{HEAD "<exists", "flag such as <exists> does not end"}));

TEST(TextGridTest, EveryTruncationIsAnErrorNotACrash) {
  const std::string whole =
      HEAD "1\n\"IntervalTier\"\n\"a\"\n0\n1\n2\n0\n0.5\n\"x\"\n0.5\n1\n\"y\"\n";
  ASSERT_TRUE(ParseTextGrid(whole, "whole"));
  const std::size_t last_quote = whole.rfind('"');
  for (std::size_t size = 0; size <= last_quote; ++size)
    EXPECT_FALSE(ParseTextGrid(whole.substr(0, size), "part")) << size;
}
#undef HEAD

TextGrid GridWithTiers(const std::vector<std::string>& names) {
  TextGrid grid;
  for (const std::string& name : names) grid.tiers.push_back({name, Kind::kIntervals, {}});
  return grid;
}

TEST(FindPhoneTierTest, TakesTheNamedTier) {
  const TextGrid grid = GridWithTiers({"phones", "mine"});
  const auto tier = FindPhoneTier(grid, "mine");
  ASSERT_TRUE(tier);
  EXPECT_EQ((*tier)->name, "mine");
}

TEST(FindPhoneTierTest, KnowsTheNamesThatAlignersGive) {
  for (const char* name : {"phones", "phone", "Phonemes", "MAU", "Anna - phones", "anna_phones"}) {
    const TextGrid grid = GridWithTiers({"words", name, "telephone"});
    const auto tier = FindPhoneTier(grid);
    ASSERT_TRUE(tier) << name << ": " << tier.error().message;
    EXPECT_EQ((*tier)->name, name);
  }
}

TEST(FindPhoneTierTest, NamesTheTiersThereAre) {
  const auto unknown = FindPhoneTier(GridWithTiers({"words", "notes"}), "phones");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message,
              AllOf(HasSubstr("no tier 'phones'"), HasSubstr("'words', 'notes'")));
  const auto none = FindPhoneTier(GridWithTiers({"words", "notes"}));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("'words', 'notes'"));
  const auto two = FindPhoneTier(GridWithTiers({"A - phones", "B - phones"}));
  ASSERT_FALSE(two);
  EXPECT_THAT(two.error().message, HasSubstr("several tiers"));
}

std::vector<SessionTime> TimesAt(double rate_hz, int count) {
  std::vector<SessionTime> times;
  for (int i = 0; i < count; ++i) times.push_back(TimeOfFrame(i, rate_hz));
  return times;
}

TEST(LabelsOfFramesTest, AnIntervalHoldsItsStartAndNotItsEnd) {
  const TextGridTier tier{
      "phones", Kind::kIntervals, {{0.1, 0.2, "a"}, {0.2, 0.3, "b"}, {0.4, 0.5, "c"}}};
  EXPECT_THAT(LabelsOfFrames(tier, TimesAt(10, 7)), ElementsAre("", "a", "b", "", "c", "c", ""));
}

TEST(LabelsOfFramesTest, APointLabelsTheNearestFrame) {
  const TextGridTier tier{
      "clicks", Kind::kPoints, {{0.0, 0.0, "first"}, {0.26, 0.26, "x"}, {9, 9, "far"}}};
  EXPECT_THAT(LabelsOfFrames(tier, TimesAt(10, 5)), ElementsAre("first", "", "", "x", ""));
}

TEST(TextGridTest, RealFilesOfBothForms) {
  ARTICAP_NEEDS_TEST_DATA("textgrid/long_format.TextGrid");
  for (const char* name : {"textgrid/long_format.TextGrid", "textgrid/short_format.TextGrid"}) {
    const auto grid = ReadTextGrid(TestDataPath(name));
    ASSERT_TRUE(grid) << grid.error().message;
    EXPECT_THAT(grid->tiers, SizeIs(4));
    const auto tier = FindPhoneTier(*grid);
    ASSERT_TRUE(tier) << tier.error().message;
    ASSERT_THAT((*tier)->labels, SizeIs(104));
    EXPECT_THAT((*tier)->labels[2], Label(1362.0125, 1362.1325, "AY1"));
  }
}

TEST(TextGridTest, RealSentence) {
  ARTICAP_NEEDS_TEST_DATA("speech/F01_B01_S01_R01_N.TextGrid");
  const auto grid = ReadTextGrid(TestDataPath("speech/F01_B01_S01_R01_N.TextGrid"));
  ASSERT_TRUE(grid) << grid.error().message;
  const auto tier = FindPhoneTier(*grid);
  ASSERT_TRUE(tier) << tier.error().message;
  const auto labels = LabelsOfFrames(**tier, TimesAt(100, 260));
  EXPECT_EQ(labels[0], "sp");
  for (const TextGridLabel& label : (*tier)->labels) {
    const auto frame = static_cast<std::size_t>(std::ceil(label.start_s * 100 + 1e-6));
    if (label.end_s - label.start_s > 0.02 && frame < labels.size()) {
      EXPECT_EQ(labels[frame], label.text) << "at frame " << frame;
    }
  }
}

}  // namespace
}  // namespace articap
