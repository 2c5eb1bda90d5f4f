// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace articap {

// The order in which people number things: take2 before take10. A strict weak order of all texts,
// in which only equal texts are equivalent.
bool NaturallyBefore(std::string_view first, std::string_view second);

// The last number in a file's name, its ending apart: 3 of "left03.jpg". Nothing where there is
// none, or one of more than 17 digits.
std::optional<std::int64_t> LastNumberIn(std::string_view file_name);

}  // namespace articap
