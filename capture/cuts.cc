// SPDX-License-Identifier: MIT
#include "capture/cuts.h"

#include <fmt/format.h>

#include <optional>

#include "core/csv_values.h"
#include "core/io/text.h"

namespace articap {
namespace {

// Takes the first word off a text.
std::string_view NextWord(std::string_view& rest) {
  rest = Trim(rest);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
  rest.remove_prefix(word.size());
  return word;
}

}  // namespace

Result<std::vector<Cut>> CutsOfTier(const TextGridTier& tier) {
  if (tier.kind != TextGridTier::Kind::kIntervals)
    return Fail(
        fmt::format("the tier '{}' holds points, not intervals; a part has a start and an "
                    "end",
                    tier.name));
  std::vector<Cut> cuts;
  for (const TextGridLabel& label : tier.labels)
    if (const std::string_view name = Trim(label.text); !name.empty())
      cuts.push_back({label.start_s, label.end_s, std::string(name)});
  if (cuts.empty()) return Fail(fmt::format("no interval of the tier '{}' has a label", tier.name));
  return cuts;
}

Result<std::vector<Cut>> ParseCuts(std::string_view text, const std::string& source_name) {
  std::vector<Cut> cuts;
  LineReader lines(text);
  while (const std::optional<std::string_view> line = lines.Next()) {
    std::string_view rest = Trim(*line);
    if (rest.empty() || rest[0] == '#') continue;
    const std::optional<double> start_s = ParseFinite(NextWord(rest));
    const std::optional<double> end_s = ParseFinite(NextWord(rest));
    const auto fail = [&](const char* what) {
      return Fail(fmt::format("{}:{}: {}: '{}'; a line is \"start end name\", in seconds",
                              source_name, lines.line_number(), what, Printable(*line)));
    };
    if (!start_s || !end_s) return fail("does not begin with two numbers");
    if (!(*end_s > *start_s)) return fail("ends before it starts");
    cuts.push_back({*start_s, *end_s, std::string(Trim(rest))});
  }
  if (cuts.empty()) return Fail(fmt::format("{}: names no part", source_name));
  return cuts;
}

}  // namespace articap
