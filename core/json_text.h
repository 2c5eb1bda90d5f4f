// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace articap {

// A text with a line for everything down to `deepest_indented` levels below the whole, what is
// deeper being on the line of what it is part of: long lists of numbers stay readable, and short.
// Numbers that are not finite become null; what is not UTF-8 in names from files is replaced.
std::string IndentedJson(const nlohmann::ordered_json& json, int deepest_indented);

}  // namespace articap
