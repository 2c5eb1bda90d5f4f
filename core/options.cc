// SPDX-License-Identifier: MIT
#include "core/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace articap {

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
