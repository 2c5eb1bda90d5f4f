// SPDX-License-Identifier: MIT
#include "core/io/units.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/io/text.h"

namespace articap {

const std::vector<LengthUnit>& AllLengthUnits() {
  static const std::vector<LengthUnit> kUnits = {
      {"mm", 1}, {"cm", 10}, {"dm", 100}, {"m", 1000}, {"um", 0.001}, {"in", 25.4}, {"ft", 304.8}};
  return kUnits;
}

std::optional<LengthUnit> ParseLengthUnit(std::string_view text) {
  static const std::vector<std::pair<std::string_view, std::string_view>> kSpellings = {
      {"millimeter", "mm"}, {"millimetre", "mm"}, {"centimeter", "cm"}, {"centimetre", "cm"},
      {"decimeter", "dm"},  {"decimetre", "dm"},  {"meter", "m"},       {"metre", "m"},
      {"micrometer", "um"}, {"micrometre", "um"}, {"micron", "um"},     {"\xc2\xb5m", "um"},
      {"\xce\xbcm", "um"},  {"inch", "in"},       {"inche", "in"},      {"foot", "ft"},
      {"feet", "ft"}};
  std::string name = ToLower(Trim(text));
  for (const LengthUnit& unit : AllLengthUnits())
    if (unit.name == name) return unit;
  if (name.size() > 3 && name.back() == 's') name.pop_back();
  for (const auto& [spelling, unit_name] : kSpellings)
    if (spelling == name) return ParseLengthUnit(unit_name);
  return std::nullopt;
}

namespace {

Result<LengthUnit> ParseOption(const std::string& text, const char* option) {
  if (const auto unit = ParseLengthUnit(text)) return *unit;
  return Fail(
      fmt::format("{} {}: not a unit of length; use mm, cm, dm, m, um, in or ft", option, text));
}

}  // namespace

Result<LengthUnit> ResolveUnit(std::string_view file_unit, const MarkerReadOptions& options,
                               const std::string& source_name, std::vector<std::string>& warnings) {
  const auto named = ParseLengthUnit(file_unit);
  if (!options.force_unit.empty()) {
    const auto forced = ParseOption(options.force_unit, "--force-unit");
    if (forced && !file_unit.empty() && !(named && named->name == forced->name))
      warnings.push_back(fmt::format("The file's unit \"{}\" was overruled: read as {}.",
                                     Printable(file_unit), forced->name));
    return forced;
  }
  if (!file_unit.empty() && !named)
    return Fail(
        fmt::format("{}: \"{}\" is not a unit of length; if you know the unit, overrule it with "
                    "--force-unit mm",
                    source_name, Printable(file_unit)));
  if (options.unit.empty()) {
    if (named) return *named;
    return Fail(fmt::format(
        "{}: the file does not say its unit of length; give it with --unit mm (or cm, m, um, in)",
        source_name));
  }
  const auto given = ParseOption(options.unit, "--unit");
  if (given && named && given->name != named->name)
    return Fail(fmt::format(
        "{}: the file says its unit is {}, the option says {}; leave --unit out, or overrule a "
        "wrong file with --force-unit {}",
        source_name, named->name, given->name, given->name));
  return given;
}

}  // namespace articap
