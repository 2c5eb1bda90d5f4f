// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>
#include "core/result.h"

namespace articap {

// Parses TOML text; the message names the source and the line.
Result<toml::table> ParseToml(std::string_view text, std::string_view source);

// Typed access to one table of a TOML file. The first fault is kept for all readers of a file, so
// that a parser can read everything and then ask once.
class TomlReader {
 public:
  TomlReader(const toml::table& table, std::string where, std::optional<Error>& fault)
      : table_(table), where_(std::move(where)), fault_(fault) {}

  bool Has(std::string_view key) const { return table_.contains(key); }
  std::string Text(std::string_view key) const;
  std::string Text(std::string_view key, std::string_view otherwise) const;
  double Number(std::string_view key) const;
  double Number(std::string_view key, double otherwise) const;
  int Integer(std::string_view key) const;
  int Integer(std::string_view key, int otherwise) const;
  // Counts and times in ns, which an int does not hold.
  std::int64_t Integer64(std::string_view key) const;
  Eigen::Vector3d Vector(std::string_view key) const;
  // Absent lists are empty.
  std::vector<std::string> Texts(std::string_view key) const;
  std::vector<double> Numbers(std::string_view key) const;
  std::vector<Eigen::Vector2d> Points2d(std::string_view key) const;
  // The tables of an array, and one table; nothing where absent.
  std::vector<TomlReader> Tables(std::string_view key) const;
  std::optional<TomlReader> Table(std::string_view key) const;

  // Refuses keys that are none of these: they are misspelt.
  void AllowOnly(std::initializer_list<std::string_view> keys) const;
  void Fault(std::string_view key, std::string_view what) const;
  const toml::table& table() const { return table_; }

 private:
  const toml::array* Array(std::string_view key) const;

  const toml::table& table_;
  std::string where_;
  std::optional<Error>& fault_;
};

// A TOML basic string with its quotes, and a float that always looks like one.
std::string QuotedToml(std::string_view text);
std::string TomlFloat(double value);

}  // namespace articap
