// SPDX-License-Identifier: MIT
#include "apps/option_binding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace articap {
namespace {

std::string Kebab(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

// Without a description, which the help would repeat after the type.
CLI::Validator IsNumber() { return CLI::TypeValidator<double>("").description(""); }
CLI::Validator IsInteger() { return CLI::TypeValidator<int>("").description(""); }

// What a switch does when it is on, and when it is off: "hold it" of "adjust it; false: hold it",
// or "do not adjust it".
std::pair<std::string, std::string> BothWays(const std::string& help) {
  const std::string otherwise = "; false: ";
  const std::size_t at = help.find(otherwise);
  if (at == std::string::npos) return {help, "do not " + help};
  return {help.substr(0, at), help.substr(at + otherwise.size())};
}

}  // namespace

std::string FlagOf(const std::string& prefix, const std::string& option_name) {
  return "--" + (prefix.empty() ? "" : Kebab(prefix) + "-") + Kebab(option_name);
}

std::string NegatedFlagOf(const std::string& prefix, const std::string& option_name) {
  return "--no-" + FlagOf(prefix, option_name).substr(2);
}

FlagRegistrar::FlagRegistrar(CLI::App& app, std::string prefix, std::string group)
    : app_(app), prefix_(std::move(prefix)), group_(std::move(group)) {}

CLI::Option* FlagRegistrar::Register(const char* name, const std::string& type,
                                     const std::string& fallback, const char* help) {
  CLI::Option* option = app_.add_option(FlagOf(prefix_, name));
  option->description(help)->type_name(type)->group(group_);
  if (!fallback.empty()) option->default_str(fallback);
  return option;
}

void FlagRegistrar::operator()(const char* name, bool& value, const char* help) {
  // Both ways can be said, since a file of options may differ from the default; the help shows the
  // one that changes it.
  const std::string hidden;
  const auto [if_true, if_false] = BothWays(help);
  app_.add_flag(FlagOf(prefix_, name))->description(if_true)->group(value ? hidden : group_);
  app_.add_flag(NegatedFlagOf(prefix_, name))
      ->description(if_false)
      ->group(value ? group_ : hidden);
}

void FlagRegistrar::operator()(const char* name, int& value, const char* help) {
  Register(name, "INT", fmt::format("{}", value), help)->check(IsInteger());
}

void FlagRegistrar::operator()(const char* name, double& value, const char* help) {
  Register(name, "NUMBER", fmt::format("{}", value), help)->check(IsNumber());
}

void FlagRegistrar::operator()(const char* name, std::string& value, const char* help) {
  Register(name, "TEXT", value, help);
}

void FlagRegistrar::operator()(const char* name, std::vector<std::string>& value,
                               const char* help) {
  Register(name, "A,B,...", fmt::format("{}", fmt::join(value, ",")), help)
      ->delimiter(',')
      ->expected(1, std::numeric_limits<int>::max())
      ->allow_extra_args(false);
}

void FlagRegistrar::operator()(const char* name, std::optional<double>& value, const char* help) {
  Register(name, "NUMBER", value ? fmt::format("{}", *value) : "", help)->check(IsNumber());
}

void FlagRegistrar::Choice(const char* name, int& value, const std::vector<std::string>& choices,
                           const char* help) {
  Register(name, fmt::format("{}", fmt::join(choices, "|")),
           choices.at(static_cast<std::size_t>(value)), help)
      ->check(CLI::IsMember(choices).description(""));
}

OptionReader::OptionReader(const CLI::App& app, std::string prefix, const toml::table* table,
                           std::string source_name)
    : app_(app), prefix_(std::move(prefix)), table_(table), source_name_(std::move(source_name)) {}

const CLI::Option* OptionReader::GivenFlag(const char* name) const {
  const CLI::Option* option = app_.get_option_no_throw(FlagOf(prefix_, name));
  return option != nullptr && option->count() > 0 ? option : nullptr;
}

const toml::node* OptionReader::ConfigNode(const char* name) {
  known_keys_.insert(name);
  return table_ == nullptr ? nullptr : table_->get(name);
}

void OptionReader::WrongType(const char* name, const toml::node& node,
                             const std::string& expected) {
  errors_.push_back(
      fmt::format("{}:{}: {} must be {}", source_name_, node.source().begin.line, name, expected));
}

void OptionReader::operator()(const char* name, bool& value, const char*) {
  const toml::node* node = ConfigNode(name);
  const bool is_on = GivenFlag(name) != nullptr;
  const bool is_off = app_.count(NegatedFlagOf(prefix_, name)) > 0;
  if (is_on && is_off)
    errors_.push_back(fmt::format("{} and {} contradict one another; give one of them",
                                  FlagOf(prefix_, name), NegatedFlagOf(prefix_, name)));
  if (is_on || is_off) {
    value = is_on;
  } else if (node != nullptr) {
    if (const auto read = node->value_exact<bool>())
      value = *read;
    else
      WrongType(name, *node, "true or false");
  }
}

void OptionReader::operator()(const char* name, int& value, const char*) {
  const toml::node* node = ConfigNode(name);
  if (const CLI::Option* flag = GivenFlag(name)) {
    value = flag->as<int>();
  } else if (node != nullptr) {
    const auto read = node->value_exact<std::int64_t>();
    if (read && std::in_range<int>(*read))
      value = static_cast<int>(*read);
    else
      WrongType(name, *node, "a whole number");
  }
}

void OptionReader::operator()(const char* name, double& value, const char*) {
  const toml::node* node = ConfigNode(name);
  if (const CLI::Option* flag = GivenFlag(name)) {
    value = flag->as<double>();
  } else if (node != nullptr) {
    if (node->is_number())
      value = node->value<double>().value();
    else
      WrongType(name, *node, "a number");
  }
}

void OptionReader::operator()(const char* name, std::string& value, const char*) {
  const toml::node* node = ConfigNode(name);
  if (const CLI::Option* flag = GivenFlag(name)) {
    value = flag->as<std::string>();
  } else if (node != nullptr) {
    if (const auto read = node->value_exact<std::string>())
      value = *read;
    else
      WrongType(name, *node, "a text in quotes");
  }
}

void OptionReader::operator()(const char* name, std::vector<std::string>& value, const char*) {
  const toml::node* node = ConfigNode(name);
  if (const CLI::Option* flag = GivenFlag(name)) {
    value = flag->as<std::vector<std::string>>();
    return;
  }
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr || !(array->empty() || array->is_homogeneous<std::string>()))
    return WrongType(name, *node, "a list of texts, [\"A\", \"B\"]");
  value.clear();
  for (const toml::node& entry : *array) value.push_back(entry.value_or(std::string()));
}

void OptionReader::operator()(const char* name, std::optional<double>& value, const char* help) {
  double number = 0;
  const bool given =
      GivenFlag(name) != nullptr || (table_ != nullptr && table_->get(name) != nullptr);
  const std::size_t errors_before = errors_.size();
  (*this)(name, number, help);
  if (given && errors_.size() == errors_before) value = number;
}

void OptionReader::Choice(const char* name, int& value, const std::vector<std::string>& choices,
                          const char* help) {
  std::string chosen = choices.at(static_cast<std::size_t>(value));
  const std::size_t errors_before = errors_.size();
  (*this)(name, chosen, help);
  if (errors_.size() != errors_before) return;
  const auto found = std::find(choices.begin(), choices.end(), chosen);
  if (found == choices.end())
    WrongType(name, *table_->get(name), fmt::format("one of {}", fmt::join(choices, ", ")));
  else
    value = static_cast<int>(found - choices.begin());
}

std::vector<std::string> OptionReader::Errors() const {
  std::vector<std::string> errors = errors_;
  if (table_ == nullptr) return errors;
  for (const auto& [key, node] : *table_)
    if (!known_keys_.contains(key.str()))
      errors.push_back(fmt::format("{}:{}: unknown option {}; known are {}", source_name_,
                                   node.source().begin.line, key.str(),
                                   fmt::join(known_keys_, ", ")));
  return errors;
}

}  // namespace articap
