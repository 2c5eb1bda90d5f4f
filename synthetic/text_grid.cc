// SPDX-License-Identifier: MIT
#include "synthetic/text_grid.h"

#include <fmt/format.h>

#include <iterator>

namespace articap {
namespace {

// Quotation marks are doubled inside of Praat's strings.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  return quoted + '"';
}

}  // namespace

std::string WriteTextGrid(const TextGrid& grid) {
  std::string text = "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n";
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "xmin = {:.6f}\nxmax = {:.6f}\ntiers? <exists>\nsize = {}\nitem []:\n",
                 grid.begin_s, grid.end_s, grid.tiers.size());
  for (std::size_t t = 0; t < grid.tiers.size(); ++t) {
    const TextGridTier& tier = grid.tiers[t];
    fmt::format_to(out, "    item [{}]:\n        class = \"IntervalTier\"\n        name = {}\n",
                   t + 1, Quoted(tier.name));
    fmt::format_to(out, "        xmin = {:.6f}\n        xmax = {:.6f}\n", grid.begin_s, grid.end_s);
    fmt::format_to(out, "        intervals: size = {}\n", tier.intervals.size());
    for (std::size_t i = 0; i < tier.intervals.size(); ++i) {
      const TextGridInterval& interval = tier.intervals[i];
      fmt::format_to(out, "        intervals [{}]:\n", i + 1);
      fmt::format_to(out, "            xmin = {:.6f}\n            xmax = {:.6f}\n",
                     interval.begin_s, interval.end_s);
      fmt::format_to(out, "            text = {}\n", Quoted(interval.label));
    }
  }
  return text;
}

}  // namespace articap
