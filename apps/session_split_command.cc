// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "apps/session_split.h"
#include "apps/verbs.h"

namespace articap {
namespace {

struct SplitArguments {
  std::string session, take;
  double pulse_channel = 0;  // as the command line has it
  SplitRule rule;
  SplitOptions options;
};

// One rule, and a channel that there may be; the message, or nothing.
std::string WrongUsage(SplitArguments& arguments) {
  constexpr double kMostChannels = 1000;
  SplitRule& rule = arguments.rule;
  const bool by_pulses = arguments.pulse_channel != 0;
  const int given =
      int{!rule.tier.empty()} + int{!rule.times.empty()} + int{by_pulses} + int{rule.silence};
  if (given != 1) return "say by what to cut: one of --tier, --times, --pulses and --silence";
  rule.pulse_channel = 1 <= arguments.pulse_channel && arguments.pulse_channel <= kMostChannels
                           ? static_cast<int>(arguments.pulse_channel)
                           : 0;
  if (by_pulses && rule.pulse_channel != arguments.pulse_channel)
    return fmt::format("--pulses {}: name a channel, counted from 1", arguments.pulse_channel);
  return "";
}

Result<StageReport> RunSplit(const SplitArguments& arguments) {
  const Result<Recording> recording = OpenSession(arguments.session);
  if (!recording) return tl::unexpected(recording.error());
  const StoredTake* const take = recording->Find(arguments.take);
  if (take == nullptr)
    return Fail(fmt::format("{}: there is no take {}; 'articap session info' lists them",
                            arguments.session, arguments.take));
  const auto cuts = FindCuts(*take, arguments.rule, arguments.options);
  if (!cuts) return tl::unexpected(cuts.error());
  return SplitTake(*take, *cuts, arguments.options);
}

}  // namespace

ExitCode SessionSplitCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap session split",
                "Cut a long take into parts, which are takes of their own: by the intervals of a\n"
                "tier of its labels, a list of times, sync pulses, or silences. Its files stay as\n"
                "and where they are.",
                "articap session split anna_01 long --tier sentences --pad-s 0.2\n"
                "  articap session split anna_01 long --pulses 2 --gap-s 3");
  SplitArguments values;
  line.Argument("SESSION", values.session, "folder of the session");
  line.Argument("TAKE", values.take, "id of the take");
  line.Flag("--tier", values.rule.tier, "NAME", "every labelled interval of this tier");
  line.Flag("--times", values.rule.times, "FILE",
            "lines of \"start end name\", seconds on the take's clock");
  line.Flag("--pulses", values.pulse_channel, "CHANNEL",
            "every burst of pulses on this channel of the audio, from 1");
  line.Flag("--silence", values.rule.silence, "what is spoken between silences");
  line.Stage("split", values.options);
  if (const auto exit = line.Parse(arguments)) return *exit;
  if (const std::string wrong = WrongUsage(values); !wrong.empty())
    return FailWith(ExitCode::kWrongUsage, wrong);
  const Result<StageReport> report = RunSplit(values);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
