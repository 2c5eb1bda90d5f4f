// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/marker_io.h"

namespace articap {

// A unit of length as files and people write it ("mm", "Millimeters", "MM ", "m"), or nothing.
struct LengthUnit {
  std::string_view name;  // "mm", "cm", "dm", "m", "um", "in", "ft"
  double mm_per_unit = 1;
};
std::optional<LengthUnit> ParseLengthUnit(std::string_view text);
const std::vector<LengthUnit>& AllLengthUnits();

// The unit that holds for a file that names `file_unit` (empty: it names none) under the options;
// fails where it is unknown, contradicted or not given. Warnings go to `warnings`.
Result<LengthUnit> ResolveUnit(std::string_view file_unit, const MarkerReadOptions& options,
                               const std::string& source_name, std::vector<std::string>& warnings);

}  // namespace articap
