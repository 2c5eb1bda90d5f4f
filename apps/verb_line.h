// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/option_binding.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

// Exit codes of every verb.
enum class ExitCode : int { kUsable = 0, kNotUsable = 1, kWrongUsage = 2 };

// Prints "articap: error: ..." on stderr.
ExitCode FailWith(ExitCode code, const std::string& message);
inline ExitCode FailWith(const Error& error) {
  return FailWith(ExitCode::kNotUsable, error.message);
}

// The command line of one verb: its arguments, the flags of the option structs of its stages, and
// what all verbs share (--help with an example, --config, --json).
//
//   VerbLine line("articap stabilize", "factor the head out", "articap stabilize a.c3d b.c3d");
//   line.Argument("IN", input, "marker file");
//   StabilizeOptions options;
//   line.Stage("stabilize", options);
//   if (const auto exit = line.Parse(arguments)) return *exit;
class VerbLine {
 public:
  VerbLine(const std::string& name, const std::string& summary, const std::string& example);
  VerbLine(const VerbLine&) = delete;
  VerbLine& operator=(const VerbLine&) = delete;

  // A required argument without a flag; the referred value must live until Parse().
  void Argument(const std::string& name, std::string& value, const std::string& help);
  // One or more of them, to the end of the line.
  CLI::Option* Arguments(const std::string& name, std::vector<std::string>& values,
                         const std::string& help);
  // An option of the verb itself, e.g. "--binding" or "-o,--output".
  CLI::Option* Flag(const std::string& flags, std::string& value, const std::string& type,
                    const std::string& help);
  CLI::Option* Flag(const std::string& flags, double& value, const std::string& type,
                    const std::string& help);
  CLI::Option* Flag(const std::string& flags, bool& value, const std::string& help);
  // A list, its entries separated by commas.
  CLI::Option* Flag(const std::string& flags, std::vector<std::string>& values,
                    const std::string& type, const std::string& help);

  // Every field of a stage's option struct becomes a flag, `prefix` before its name; the file of
  // --config holds them in the table [stage].
  template <class Options>
  void Stage(const std::string& stage, Options& options, const std::string& prefix = "") {
    AddStage(stage, prefix, [&options](OptionVisitor& visit) { VisitOptions(options, visit); });
  }

  // An exit code where the verb has nothing more to do: --help, or wrong usage (already printed).
  std::optional<ExitCode> Parse(std::vector<std::string> arguments);

  bool json() const { return json_; }
  const std::string& config_path() const { return config_path_; }  // empty where none is given
  // Prints the reports as --json asks; kNotUsable where one of them is not usable.
  ExitCode Finish(const std::vector<StageReport>& reports) const;

 private:
  struct StageOptions {
    std::string stage;
    std::string prefix;
    std::function<void(OptionVisitor&)> visit;
  };

  void AddStage(const std::string& stage, const std::string& prefix,
                std::function<void(OptionVisitor&)> visit);
  Result<void> ReadOptions();

  CLI::App app_;
  std::string config_path_;
  bool json_ = false;
  std::vector<StageOptions> stages_;
};

}  // namespace articap
