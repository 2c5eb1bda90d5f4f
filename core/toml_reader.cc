// SPDX-License-Identifier: MIT
#include "core/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace articap {
namespace {

std::optional<double> FiniteNumber(const toml::node* node) {
  const auto value = node ? node->value<double>() : std::nullopt;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

Result<toml::table> ParseToml(std::string_view text, std::string_view source) {
  try {
    return toml::parse(text, source);
  } catch (const toml::parse_error& error) {
    return Fail(
        fmt::format("{}, line {}: {}", source, error.source().begin.line, error.description()));
  }
}

void TomlReader::Fault(std::string_view key, std::string_view what) const {
  if (!fault_) fault_ = Error{fmt::format("{}: '{}' {}", where_, key, what)};
}

std::string TomlReader::Text(std::string_view key) const {
  if (!Has(key)) Fault(key, "is missing");
  return Text(key, "");
}

std::string TomlReader::Text(std::string_view key, std::string_view otherwise) const {
  if (!Has(key)) return std::string(otherwise);
  const auto value = table_.get(key)->value_exact<std::string>();
  if (!value) Fault(key, "is not a text");
  return value.value_or("");
}

double TomlReader::Number(std::string_view key) const {
  if (!Has(key)) Fault(key, "is missing");
  return Number(key, 0.0);
}

double TomlReader::Number(std::string_view key, double otherwise) const {
  if (!Has(key)) return otherwise;
  const auto value = FiniteNumber(table_.get(key));
  if (!value) Fault(key, "is not a finite number");
  return value.value_or(0.0);
}

int TomlReader::Integer(std::string_view key) const {
  if (!Has(key)) Fault(key, "is missing");
  return Integer(key, 0);
}

int TomlReader::Integer(std::string_view key, int otherwise) const {
  if (!Has(key)) return otherwise;
  const auto value = table_.get(key)->value_exact<int64_t>();
  const bool fits = value && *value >= std::numeric_limits<int>::min() &&
                    *value <= std::numeric_limits<int>::max();
  if (!fits) Fault(key, "is not a whole number");
  return fits ? static_cast<int>(*value) : 0;
}

std::int64_t TomlReader::Integer64(std::string_view key) const {
  const toml::node* node = table_.get(key);
  const auto value = node ? node->value_exact<int64_t>() : std::nullopt;
  if (!value) Fault(key, node ? "is not a whole number" : "is missing");
  return value.value_or(0);
}

const toml::array* TomlReader::Array(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (!node) return nullptr;
  if (!node->is_array()) Fault(key, "is not a list");
  return node->as_array();
}

std::vector<double> TomlReader::Numbers(std::string_view key) const {
  std::vector<double> numbers;
  if (const toml::array* array = Array(key))
    for (const toml::node& node : *array) {
      const auto value = FiniteNumber(&node);
      if (!value) Fault(key, "holds something that is not a finite number");
      numbers.push_back(value.value_or(0.0));
    }
  return numbers;
}

Eigen::Vector3d TomlReader::Vector(std::string_view key) const {
  const std::vector<double> numbers = Numbers(key);
  if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
  Fault(key, "is not a list of three numbers");
  return Eigen::Vector3d::Zero();
}

std::vector<std::string> TomlReader::Texts(std::string_view key) const {
  std::vector<std::string> texts;
  if (const toml::array* array = Array(key))
    for (const toml::node& node : *array) {
      const auto value = node.value_exact<std::string>();
      if (!value) Fault(key, "holds something that is not a text");
      texts.push_back(value.value_or(""));
    }
  return texts;
}

std::vector<Eigen::Vector2d> TomlReader::Points2d(std::string_view key) const {
  std::vector<Eigen::Vector2d> points;
  if (const toml::array* array = Array(key))
    for (const toml::node& node : *array) {
      const toml::array* pair = node.as_array();
      const auto x = pair && pair->size() == 2 ? FiniteNumber(pair->get(0)) : std::nullopt;
      const auto y = x ? FiniteNumber(pair->get(1)) : std::nullopt;
      if (!y) Fault(key, "holds something that is not a pair of numbers");
      points.emplace_back(x.value_or(0.0), y.value_or(0.0));
    }
  return points;
}

std::vector<TomlReader> TomlReader::Tables(std::string_view key) const {
  std::vector<TomlReader> tables;
  if (const toml::array* array = Array(key))
    for (const toml::node& node : *array) {
      if (!node.is_table()) {
        Fault(key, "holds something that is not a table");
        continue;
      }
      tables.emplace_back(*node.as_table(),
                          fmt::format("{}, {} {}", where_, key, tables.size() + 1), fault_);
    }
  return tables;
}

std::optional<TomlReader> TomlReader::Table(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (!node) return std::nullopt;
  if (!node->is_table()) {
    Fault(key, "is not a table");
    return std::nullopt;
  }
  return TomlReader(*node->as_table(), fmt::format("{}, {}", where_, key), fault_);
}

void TomlReader::AllowOnly(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, node] : table_)
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
      Fault(key.str(), fmt::format("is no key that belongs here; there are {}",
                                   fmt::join(keys.begin(), keys.end(), ", ")));
}

std::string QuotedToml(std::string_view text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\')
      quoted += {'\\', letter};
    else if (letter == '\n')
      quoted += "\\n";
    else if (letter == '\t')
      quoted += "\\t";
    else if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7F)
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned char>(letter));
    else
      quoted += letter;
  }
  return quoted + "\"";
}

std::string TomlFloat(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace articap
