// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace articap {

// The order in which people number things: take2 before take10. A strict weak order of all texts,
// in which only equal texts are equivalent.
bool NaturallyBefore(std::string_view first, std::string_view second);

}  // namespace articap
