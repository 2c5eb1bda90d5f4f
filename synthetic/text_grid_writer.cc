// SPDX-License-Identifier: MIT
#include "synthetic/text_grid_writer.h"

#include <fmt/format.h>

#include <iterator>

#include "core/check.h"

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
                 grid.start_s, grid.end_s, grid.tiers.size());
  for (std::size_t t = 0; t < grid.tiers.size(); ++t) {
    const TextGridTier& tier = grid.tiers[t];
    ARTICAP_CHECK(tier.kind == TextGridTier::Kind::kIntervals);
    fmt::format_to(out, "    item [{}]:\n        class = \"IntervalTier\"\n        name = {}\n",
                   t + 1, Quoted(tier.name));
    fmt::format_to(out, "        xmin = {:.6f}\n        xmax = {:.6f}\n", grid.start_s, grid.end_s);
    fmt::format_to(out, "        intervals: size = {}\n", tier.labels.size());
    for (std::size_t i = 0; i < tier.labels.size(); ++i) {
      const TextGridLabel& interval = tier.labels[i];
      fmt::format_to(out, "        intervals [{}]:\n", i + 1);
      fmt::format_to(out, "            xmin = {:.6f}\n            xmax = {:.6f}\n",
                     interval.start_s, interval.end_s);
      fmt::format_to(out, "            text = {}\n", Quoted(interval.text));
    }
  }
  return text;
}

}  // namespace articap
