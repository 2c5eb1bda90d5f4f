// SPDX-License-Identifier: MIT
#include "apps/option_binding.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace articap {
namespace {

using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

enum class Metric : std::uint8_t { kSum, kSquared };

struct SampleOptions {
  bool refine = true;
  int max_iterations = 50;
  double epsilon_mm = 0.001;
  std::string unit;
  std::vector<std::string> head_markers;
  std::optional<double> rate_hz;
  Metric metric = Metric::kSum;
};

void VisitOptions(SampleOptions& options, OptionVisitor& visit) {
  visit("refine", options.refine, "refine the markers");
  visit("max_iterations", options.max_iterations, "a frame");
  visit("epsilon_mm", options.epsilon_mm, "smoothing; mm");
  visit("unit", options.unit, "of length");
  visit("head_markers", options.head_markers, "moving with the skull");
  visit("rate_hz", options.rate_hz, "frames a second");
  visit.Enumeration("metric", options.metric, {"sum", "squared"}, "of the distances");
}

struct Outcome {
  SampleOptions options;
  std::vector<std::string> errors;
};

// The way of VerbLine: register, parse the flags, read.
Outcome Read(std::vector<std::string> arguments, const std::string& toml_text = "") {
  CLI::App app;
  Outcome outcome;
  FlagRegistrar registrar(app, "", "sample");
  VisitOptions(outcome.options, registrar);
  std::reverse(arguments.begin(), arguments.end());
  app.parse(arguments);
  const toml::table table = toml::parse(toml_text);
  OptionReader reader(app, "", &table, "options.toml");
  VisitOptions(outcome.options, reader);
  outcome.errors = reader.Errors();
  return outcome;
}

TEST(OptionBinding, KeepsDefaultsWhereNothingIsGiven) {
  const Outcome outcome = Read({});
  EXPECT_THAT(outcome.errors, IsEmpty());
  EXPECT_EQ(EchoOptions(outcome.options), EchoOptions(SampleOptions()));
}

TEST(OptionBinding, ReadsEveryTypeOfFlag) {
  const Outcome outcome =
      Read({"--no-refine", "--max-iterations", "7", "--epsilon-mm", "-0.5", "--unit", "cm",
            "--head-markers", "A,B,C", "--rate-hz=59.94", "--metric", "squared"});
  EXPECT_THAT(outcome.errors, IsEmpty());
  EXPECT_FALSE(outcome.options.refine);
  EXPECT_EQ(outcome.options.max_iterations, 7);
  EXPECT_EQ(outcome.options.epsilon_mm, -0.5);
  EXPECT_EQ(outcome.options.unit, "cm");
  EXPECT_THAT(outcome.options.head_markers, ElementsAre("A", "B", "C"));
  EXPECT_EQ(outcome.options.rate_hz, 59.94);
  EXPECT_EQ(outcome.options.metric, Metric::kSquared);
}

struct Switches {
  bool hold = true;
  bool smooth = true;
  bool mirrored = false;
};

void VisitOptions(Switches& options, OptionVisitor& visit) {
  visit("hold", options.hold, "hold the lens; false: adjust the lens");
  visit("smooth", options.smooth, "smooth the movement");
  visit("mirrored", options.mirrored, "the picture is mirrored");
}

TEST(OptionBinding, TheHelpSaysWhatTheOtherWayOfASwitchDoes) {
  CLI::App app;
  Switches options;
  FlagRegistrar registrar(app, "", "switches");
  VisitOptions(options, registrar);
  const std::string help = app.help();
  EXPECT_THAT(help, ContainsRegex("--no-hold +adjust the lens\n"));
  EXPECT_THAT(help, ContainsRegex("--no-smooth +do not smooth the movement\n"));
  EXPECT_THAT(help, ContainsRegex("--mirrored +the picture is mirrored\n"));
  EXPECT_THAT(help, Not(HasSubstr("--no-mirrored")));
  EXPECT_THAT(help, Not(HasSubstr("--hold")));
}

TEST(OptionBinding, BothWaysOfASwitchAtOnceAreRefused) {
  EXPECT_THAT(Read({"--refine", "--no-refine"}).errors,
              ElementsAre("--refine and --no-refine contradict one another; give one of them"));
}

TEST(OptionBinding, ReadsEveryTypeFromToml) {
  const Outcome outcome = Read({}, R"(
    refine = false
    max_iterations = 7
    epsilon_mm = 2            # a whole number will do
    unit = "cm"
    head_markers = ["A", "B"]
    rate_hz = 50
    metric = "squared")");
  EXPECT_THAT(outcome.errors, IsEmpty());
  EXPECT_FALSE(outcome.options.refine);
  EXPECT_EQ(outcome.options.max_iterations, 7);
  EXPECT_EQ(outcome.options.epsilon_mm, 2);
  EXPECT_EQ(outcome.options.unit, "cm");
  EXPECT_THAT(outcome.options.head_markers, ElementsAre("A", "B"));
  EXPECT_EQ(outcome.options.rate_hz, 50);
  EXPECT_EQ(outcome.options.metric, Metric::kSquared);
}

TEST(OptionBinding, FlagsWinOverToml) {
  const Outcome outcome = Read({"--max-iterations", "9", "--refine"},
                               "max_iterations = 7\nrefine = false\nepsilon_mm = 0.01");
  EXPECT_EQ(outcome.options.max_iterations, 9);
  EXPECT_TRUE(outcome.options.refine);
  EXPECT_EQ(outcome.options.epsilon_mm, 0.01);
}

TEST(OptionBinding, NamesTheLineOfAnUnknownKey) {
  const Outcome outcome = Read({}, "refine = true\nmax_iteration = 7");
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_THAT(outcome.errors[0], HasSubstr("options.toml:2: unknown option max_iteration"));
  EXPECT_THAT(outcome.errors[0], HasSubstr("max_iterations"));
}

TEST(OptionBinding, NamesTheLineOfAWrongType) {
  const Outcome outcome = Read({}, R"(
    max_iterations = 1.5
    refine = "yes"
    metric = "cubed"
    head_markers = [1, 2]
    rate_hz = "fast")");
  ASSERT_EQ(outcome.errors.size(), 5u);
  for (const std::string& error : outcome.errors) EXPECT_THAT(error, HasSubstr("options.toml:"));
  EXPECT_EQ(outcome.options.rate_hz, std::nullopt);
}

TEST(OptionBinding, RefusesFlagsOfTheWrongType) {
  EXPECT_THROW(Read({"--max-iterations", "many"}), CLI::ParseError);
  EXPECT_THROW(Read({"--epsilon-mm", "1mm"}), CLI::ParseError);
  EXPECT_THROW(Read({"--metric", "cubed"}), CLI::ParseError);
}

TEST(OptionBinding, PutsThePrefixBeforeTheName) {
  EXPECT_EQ(FlagOf("", "max_residual_mm"), "--max-residual-mm");
  EXPECT_EQ(FlagOf("bind", "metric"), "--bind-metric");
}

}  // namespace
}  // namespace articap
