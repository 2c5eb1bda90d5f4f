// SPDX-License-Identifier: MIT
#include "capture/cuts.h"

#include <gmock/gmock.h>

namespace articap {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

MATCHER_P3(IsCut, start_s, end_s, name, "") {
  return arg.start_s == start_s && arg.end_s == end_s && arg.name == name;
}

TEST(CutsTest, LinesOfTimesAreRead) {
  EXPECT_THAT(
      ParseCuts("# minutes of tuesday\n0.5 1.25\n\n  -1\t2.5e0  the  second one \r\n3 4 last",
                "times.txt")
          .value(),
      ElementsAre(IsCut(0.5, 1.25, ""), IsCut(-1, 2.5, "the  second one"), IsCut(3, 4, "last")));
}

TEST(CutsTest, FaultsOfTimesAreNamedWithTheirLine) {
  const auto fault_of = [](const std::string& text) {
    const auto cuts = ParseCuts(text, "times.txt");
    return cuts ? "" : cuts.error().message;
  };
  EXPECT_THAT(fault_of("1 2\n1,5 2 a"), AllOf(HasSubstr("times.txt:2:"), HasSubstr("two numbers")));
  EXPECT_THAT(fault_of("1"), HasSubstr("times.txt:1: does not begin with two numbers: '1'"));
  EXPECT_THAT(fault_of("2 2 a"), HasSubstr("ends before it starts"));
  EXPECT_THAT(fault_of("nan 2"), HasSubstr("two numbers"));
  EXPECT_THAT(fault_of("1 inf"), HasSubstr("two numbers"));
  EXPECT_THAT(fault_of("# nothing\n"), HasSubstr("times.txt: names no part"));
}

TEST(CutsTest, LabelledIntervalsAreCuts) {
  TextGridTier tier;
  tier.name = "sentences";
  tier.labels = {{0, 1, " "}, {1, 2.5, " aba "}, {2.5, 3, ""}, {3, 4, "b"}};
  EXPECT_THAT(CutsOfTier(tier).value(), ElementsAre(IsCut(1, 2.5, "aba"), IsCut(3, 4, "b")));
  tier.labels = {{0, 1, ""}};
  EXPECT_THAT(CutsOfTier(tier).error().message, HasSubstr("'sentences'"));
  tier.kind = TextGridTier::Kind::kPoints;
  EXPECT_THAT(CutsOfTier(tier).error().message, HasSubstr("points"));
}

}  // namespace
}  // namespace articap
