// SPDX-License-Identifier: MIT
#include "apps/verbs.h"

#include <fmt/format.h>

#include <algorithm>

namespace articap {
namespace {

std::string HelpOf(const std::string& program, const std::string& summary,
                   const std::vector<VerbEntry>& verbs) {
  std::string text = fmt::format("{}\n\nUsage: {} VERB ...\n\nVerbs:\n", summary, program);
  for (const VerbEntry& verb : verbs) text += fmt::format("  {:<12} {}\n", verb.name, verb.summary);
  return text +
         fmt::format("\nRun '{} VERB --help' for a verb's arguments, options and an example.\n",
                     program);
}

}  // namespace

ExitCode RunVerb(const std::string& program, const std::string& summary,
                 const std::vector<VerbEntry>& verbs, const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    fmt::print(stderr, "{}", HelpOf(program, summary, verbs));
    return ExitCode::kWrongUsage;
  }
  if (arguments[0] == "--help" || arguments[0] == "-h") {
    fmt::print("{}", HelpOf(program, summary, verbs));
    return ExitCode::kUsable;
  }
  const auto verb = std::find_if(verbs.begin(), verbs.end(), [&](const VerbEntry& entry) {
    return entry.name == arguments[0];
  });
  if (verb == verbs.end())
    return FailWith(
        ExitCode::kWrongUsage,
        fmt::format("no verb '{}'; run '{} --help' for those there are", arguments[0], program));
  return verb->run({arguments.begin() + 1, arguments.end()});
}

}  // namespace articap
