// SPDX-License-Identifier: MIT
#include "core/json_text.h"

#include <string_view>

namespace articap {
namespace {

using Json = nlohmann::ordered_json;

std::string Compact(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void Write(const Json& json, int depth, int deepest_indented, std::string& text) {
  if (depth > deepest_indented || !json.is_structured() || json.empty()) {
    text += Compact(json);
    return;
  }
  const std::string indent(2 * static_cast<std::size_t>(depth), ' ');
  text += json.is_object() ? "{" : "[";
  std::string_view separator = "\n";
  for (const auto& item : json.items()) {
    text += separator;
    text += indent + "  ";
    if (json.is_object()) text += Compact(item.key()) + ": ";
    Write(item.value(), depth + 1, deepest_indented, text);
    separator = ",\n";
  }
  text += "\n" + indent + (json.is_object() ? "}" : "]");
}

}  // namespace

std::string IndentedJson(const Json& json, int deepest_indented) {
  std::string text;
  Write(json, 0, deepest_indented, text);
  return text + "\n";
}

}  // namespace articap
