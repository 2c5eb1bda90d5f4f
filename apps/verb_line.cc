// SPDX-License-Identifier: MIT
#include "apps/verb_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <iostream>
#include <string_view>
#include <utility>

#include "core/file_io.h"

namespace articap {
namespace {

// One file of options serves all verbs; each verb reads the tables of its own stages.
constexpr std::array<std::string_view, 10> kStageNames = {
    "read", "stabilize", "map", "bind", "fit", "synthesize", "noise", "render", "import", "split"};

Result<toml::table> ReadToml(const std::string& path) {
  const Result<std::string> text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  try {
    return toml::parse(*text, path);
  } catch (const toml::parse_error& error) {
    return Fail(fmt::format("{}:{}: {}", path, error.source().begin.line, error.description()));
  }
}

Result<void> CheckTables(const toml::table& config, const std::string& path) {
  for (const auto& [key, node] : config) {
    const bool known =
        std::find(kStageNames.begin(), kStageNames.end(), key.str()) != kStageNames.end();
    if (!known || !node.is_table())
      return Fail(
          fmt::format("{}:{}: {} is not the table of a stage; options stand in the tables "
                      "[{}]",
                      path, node.source().begin.line, key.str(), fmt::join(kStageNames, "], [")));
  }
  return {};
}

}  // namespace

ExitCode FailWith(ExitCode code, const std::string& message) {
  fmt::print(stderr, "articap: error: {}\n", message);
  return code;
}

VerbLine::VerbLine(const std::string& name, const std::string& summary, const std::string& example)
    : app_(summary, name) {
  app_.footer("Example:\n  " + example);
  app_.get_formatter()->column_width(38);
  app_.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::Throw);
}

void VerbLine::Argument(const std::string& name, std::string& value, const std::string& help) {
  app_.add_option(name, value, help)->required()->type_name("");
}

CLI::Option* VerbLine::Flag(const std::string& flags, std::string& value, const std::string& type,
                            const std::string& help) {
  return app_.add_option(flags, value, help)->type_name(type);
}

CLI::Option* VerbLine::Arguments(const std::string& name, std::vector<std::string>& values,
                                 const std::string& help) {
  return app_.add_option(name, values, help)
      ->required()
      ->type_name("")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

CLI::Option* VerbLine::Flag(const std::string& flags, double& value, const std::string& type,
                            const std::string& help) {
  return app_.add_option(flags, value, help)->type_name(type);
}

CLI::Option* VerbLine::Flag(const std::string& flags, bool& value, const std::string& help) {
  return app_.add_flag(flags, value, help);
}

CLI::Option* VerbLine::Flag(const std::string& flags, std::vector<std::string>& values,
                            const std::string& type, const std::string& help) {
  return app_.add_option(flags, values, help)
      ->type_name(type)
      ->delimiter(',')
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
}

void VerbLine::AddStage(const std::string& stage, const std::string& prefix,
                        std::function<void(OptionVisitor&)> visit) {
  FlagRegistrar registrar(app_, prefix, stage);
  visit(registrar);
  stages_.push_back({stage, prefix, std::move(visit)});
}

std::optional<ExitCode> VerbLine::Parse(std::vector<std::string> arguments) {
  app_.add_option("--config", config_path_, "options of the stages, TOML; flags win over it")
      ->type_name("FILE");
  app_.add_flag("--json", json_, "print the report as JSON");
  std::reverse(arguments.begin(), arguments.end());
  try {
    app_.parse(arguments);
  } catch (const CLI::CallForHelp&) {
    std::cout << app_.help();
    return ExitCode::kUsable;
  } catch (const CLI::ParseError& error) {
    return FailWith(ExitCode::kWrongUsage, fmt::format("{}\nRun '{} --help' for how to use it.",
                                                       error.what(), app_.get_name()));
  }
  if (const Result<void> read = ReadOptions(); !read)
    return FailWith(ExitCode::kWrongUsage, read.error().message);
  return std::nullopt;
}

Result<void> VerbLine::ReadOptions() {
  toml::table config;
  if (!config_path_.empty()) {
    Result<toml::table> read = ReadToml(config_path_);
    if (!read) return tl::unexpected(read.error());
    config = std::move(*read);
    if (const Result<void> checked = CheckTables(config, config_path_); !checked) return checked;
  }
  std::vector<std::string> errors;
  for (const StageOptions& stage : stages_) {
    OptionReader reader(app_, stage.prefix, config[stage.stage].as_table(), config_path_);
    stage.visit(reader);
    for (std::string& error : reader.Errors()) errors.push_back(std::move(error));
  }
  if (!errors.empty()) return Fail(fmt::format("{}", fmt::join(errors, "\n")));
  return {};
}

ExitCode VerbLine::Finish(const std::vector<StageReport>& reports) const {
  bool usable = true;
  for (const StageReport& report : reports) {
    usable = usable && report.IsUsable();
    // The tables of the verb's own stage; those of the stages around it are in the files.
    const bool own = reports.size() == 1 || app_.get_name().ends_with(" " + report.stage);
    constexpr int kTableRows = 50;
    if (!json_) fmt::print("{}", report.BriefReport(own ? kTableRows : 0));
  }
  if (json_)
    fmt::print("{}", reports.size() == 1 ? reports.front().ToJson() : ReportsToJson(reports));
  for (const StageReport& report : reports)
    if (!report.IsUsable()) FailWith(ExitCode::kNotUsable, report.stage + ": " + report.verdict);
  return usable ? ExitCode::kUsable : ExitCode::kNotUsable;
}

}  // namespace articap
