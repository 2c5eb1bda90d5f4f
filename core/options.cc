// SPDX-License-Identifier: MIT
#include "core/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace articap {

Result<void> RequirePositive(NamedNumbers options) {
  for (const auto& [name, value] : options)
    if (!(value > 0)) return Fail(fmt::format("{} is {}; it must be positive", name, value));
  return {};
}

Result<void> RequireNotNegative(NamedNumbers options) {
  for (const auto& [name, value] : options)
    if (!(value >= 0)) return Fail(fmt::format("{} is {}; it must not be negative", name, value));
  return {};
}

void OptionEcho::operator()(const char* name, bool& value, const char*) {
  entries.emplace_back(name, value ? "true" : "false");
}

void OptionEcho::operator()(const char* name, int& value, const char*) {
  entries.emplace_back(name, fmt::format("{}", value));
}

void OptionEcho::operator()(const char* name, double& value, const char*) {
  entries.emplace_back(name, fmt::format("{}", value));
}

void OptionEcho::operator()(const char* name, std::string& value, const char*) {
  entries.emplace_back(name, value);
}

void OptionEcho::operator()(const char* name, std::vector<std::string>& value, const char*) {
  entries.emplace_back(name, fmt::format("{}", fmt::join(value, ",")));
}

void OptionEcho::operator()(const char* name, std::optional<double>& value, const char*) {
  entries.emplace_back(name, value ? fmt::format("{}", *value) : "");
}

void OptionEcho::Choice(const char* name, int& value, const std::vector<std::string>& choices,
                        const char*) {
  entries.emplace_back(name, choices.at(static_cast<std::size_t>(value)));
}

}  // namespace articap
