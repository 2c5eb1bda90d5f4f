// SPDX-License-Identifier: MIT
#pragma once

#include <toml++/toml.h>
#include <CLI/CLI.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/options.h"

namespace articap {

// "max_residual_mm" with the prefix "bind" -> "--bind-max-residual-mm".
std::string FlagOf(const std::string& prefix, const std::string& option_name);
// "use_filled" -> "--no-use-filled".
std::string NegatedFlagOf(const std::string& prefix, const std::string& option_name);

// Makes a flag of every field of an option struct, with its default in the help. The values stay
// with CLI11 until an OptionReader collects them: enumerations are visited through a temporary.
class FlagRegistrar : public OptionVisitor {
 public:
  FlagRegistrar(CLI::App& app, std::string prefix, std::string group);

  void operator()(const char* name, bool& value, const char* help) override;
  void operator()(const char* name, int& value, const char* help) override;
  void operator()(const char* name, double& value, const char* help) override;
  void operator()(const char* name, std::string& value, const char* help) override;
  void operator()(const char* name, std::vector<std::string>& value, const char* help) override;
  void operator()(const char* name, std::optional<double>& value, const char* help) override;
  void Choice(const char* name, int& value, const std::vector<std::string>& choices,
              const char* help) override;

 private:
  CLI::Option* Register(const char* name, const std::string& type, const std::string& fallback,
                        const char* help);

  CLI::App& app_;
  std::string prefix_;
  std::string group_;
};

// Fills an option struct: a flag that was given wins over the TOML table, which wins over the
// default. What cannot be read is kept as an error that names the flag, or the line of the file.
class OptionReader : public OptionVisitor {
 public:
  // `table` may be null.
  OptionReader(const CLI::App& app, std::string prefix, const toml::table* table,
               std::string source_name);

  void operator()(const char* name, bool& value, const char* help) override;
  void operator()(const char* name, int& value, const char* help) override;
  void operator()(const char* name, double& value, const char* help) override;
  void operator()(const char* name, std::string& value, const char* help) override;
  void operator()(const char* name, std::vector<std::string>& value, const char* help) override;
  void operator()(const char* name, std::optional<double>& value, const char* help) override;
  void Choice(const char* name, int& value, const std::vector<std::string>& choices,
              const char* help) override;

  // Errors so far, and one for each key of the table that no option asked for.
  std::vector<std::string> Errors() const;

 private:
  // The flag's texts where it was given, else null.
  const CLI::Option* GivenFlag(const char* name) const;
  // The key's node where the file has it, else null.
  const toml::node* ConfigNode(const char* name);
  void WrongType(const char* name, const toml::node& node, const std::string& expected);

  const CLI::App& app_;
  std::string prefix_;
  const toml::table* table_;
  std::string source_name_;
  std::set<std::string, std::less<>> known_keys_;
  std::vector<std::string> errors_;
};

}  // namespace articap
