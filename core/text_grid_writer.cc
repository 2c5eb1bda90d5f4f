// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iterator>

#include "core/text_grid.h"

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

std::string IntervalText(const TextGridLabel& label, std::size_t number) {
  return fmt::format(
      "        intervals [{}]:\n            xmin = {:.6f}\n            xmax = {:.6f}\n"
      "            text = {}\n",
      number, label.start_s, label.end_s, Quoted(label.text));
}

std::string PointText(const TextGridLabel& label, std::size_t number) {
  return fmt::format("        points [{}]:\n            number = {:.6f}\n            mark = {}\n",
                     number, label.start_s, Quoted(label.text));
}

}  // namespace

std::string WriteTextGrid(const TextGrid& grid) {
  std::string text = "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n";
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "xmin = {:.6f}\nxmax = {:.6f}\ntiers? <exists>\nsize = {}\nitem []:\n",
                 grid.start_s, grid.end_s, grid.tiers.size());
  for (std::size_t t = 0; t < grid.tiers.size(); ++t) {
    const TextGridTier& tier = grid.tiers[t];
    const bool intervals = tier.kind == TextGridTier::Kind::kIntervals;
    fmt::format_to(out, "    item [{}]:\n        class = \"{}\"\n        name = {}\n", t + 1,
                   intervals ? "IntervalTier" : "TextTier", Quoted(tier.name));
    fmt::format_to(out, "        xmin = {:.6f}\n        xmax = {:.6f}\n        {}: size = {}\n",
                   grid.start_s, grid.end_s, intervals ? "intervals" : "points",
                   tier.labels.size());
    for (std::size_t i = 0; i < tier.labels.size(); ++i)
      text += intervals ? IntervalText(tier.labels[i], i + 1) : PointText(tier.labels[i], i + 1);
  }
  return text;
}

}  // namespace articap
