// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"

namespace articap {

// Visits the fields of an option struct. Each struct lists its fields once,
//   void VisitOptions(StabilizeOptions& options, OptionVisitor& visit) {
//     visit("max_residual_mm", options.max_residual_mm, "frames above this are marked; mm");
//   }
// and that one table makes the command line's flags, reads TOML, and echoes into reports.
class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;
  // "hold the lens; false: adjust the lens" where the contrary has words of its own.
  virtual void operator()(const char* name, bool& value, const char* help) = 0;
  virtual void operator()(const char* name, int& value, const char* help) = 0;
  virtual void operator()(const char* name, double& value, const char* help) = 0;
  virtual void operator()(const char* name, std::string& value, const char* help) = 0;
  virtual void operator()(const char* name, std::vector<std::string>& value, const char* help) = 0;
  virtual void operator()(const char* name, std::optional<double>& value, const char* help) = 0;
  // One of `choices` (the texts shown to people), kept as its index.
  virtual void Choice(const char* name, int& value, const std::vector<std::string>& choices,
                      const char* help) = 0;

  template <class Enum>
  void Enumeration(const char* name, Enum& value, const std::vector<std::string>& choices,
                   const char* help) {
    int index = static_cast<int>(value);
    Choice(name, index, choices, help);
    value = static_cast<Enum>(index);
  }
};

// Names and values as text, for StageReport::options.
class OptionEcho : public OptionVisitor {
 public:
  void operator()(const char* name, bool& value, const char* help) override;
  void operator()(const char* name, int& value, const char* help) override;
  void operator()(const char* name, double& value, const char* help) override;
  void operator()(const char* name, std::string& value, const char* help) override;
  void operator()(const char* name, std::vector<std::string>& value, const char* help) override;
  void operator()(const char* name, std::optional<double>& value, const char* help) override;
  void Choice(const char* name, int& value, const std::vector<std::string>& choices,
              const char* help) override;

  std::vector<std::pair<std::string, std::string>> entries;
};

// Fails with the name and the value of the first that is not positive, or that is negative or not a
// number.
using NamedNumbers = std::initializer_list<std::pair<const char*, double>>;
Result<void> RequirePositive(NamedNumbers options);
Result<void> RequireNotNegative(NamedNumbers options);

template <class Options>
std::vector<std::pair<std::string, std::string>> EchoOptions(Options options) {
  OptionEcho echo;
  VisitOptions(options, echo);
  return std::move(echo.entries);
}

}  // namespace articap
