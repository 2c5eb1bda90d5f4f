// SPDX-License-Identifier: MIT
#include "apps/calibrate_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "apps/output_names.h"
#include "apps/output_set.h"
#include "calib/calibration_json.h"
#include "calib/calibration_report.h"
#include "calib/stage_frame.h"
#include "core/calibration_toml.h"
#include "report/calibration_page.h"

namespace articap {
namespace {

constexpr const char* kReportEndings[] = {".report.json", ".report.html"};

// "left" of "camera:left"; nothing where the text does not begin so.
std::optional<std::string> RestOf(const std::string& text, const std::string& prefix) {
  if (!text.starts_with(prefix)) return std::nullopt;
  return text.substr(prefix.size());
}

Result<Rigid3d> ChooseStage(const Calibration& calibration, const std::string& stage) {
  if (const auto camera = RestOf(stage, "camera:"))
    return StageOfCamera(calibration.array, *camera);
  if (const auto picture = RestOf(stage, "board:")) return StageOfBoard(calibration, *picture);
  return Rigid3d{};
}

Result<void> WriteAll(const CameraArray& array, bool usable, const std::string& json,
                      const CalibrationOutput& output) {
  OutputSet outputs;
  if (usable) outputs.Add(output.path, WriteCalibration(array));
  outputs.Add(Beside(output.path, kReportEndings[0]), json);
  outputs.Add(Beside(output.path, kReportEndings[1]), CalibrationPage(json));
  return outputs.Commit();
}

// After a failure that may come of them: what became of the pictures.
std::string WithReasons(const std::string& message, const SeenCamera& seen) {
  constexpr std::size_t kMostNamed = 10;
  std::string text = message;
  for (const std::string& note : seen.notes) text += "\n  " + note;
  for (std::size_t i = 0; i < std::min(kMostNamed, seen.set_aside.size()); ++i)
    text += "\n  " + seen.set_aside[i];
  if (seen.set_aside.size() > kMostNamed)
    text += fmt::format("\n  and {} more", seen.set_aside.size() - kMostNamed);
  return text;
}

// As warnings, notes and part of the figure "set_aside" of a report.
void AddWhatWasSeen(const SeenCamera& seen, StageReport& report) {
  report.warnings.insert(report.warnings.begin(), seen.set_aside.begin(), seen.set_aside.end());
  for (const std::string& note : seen.notes) report.texts.emplace_back("note", note);
  for (auto& [name, value] : report.figures)
    if (name == "set_aside") value += static_cast<double>(seen.set_aside.size());
}

Result<void> WriteCalibrationOutputs(Calibration& calibration, StageReport& report,
                                     const CalibrationOutput& output) {
  const Result<Rigid3d> stage = ChooseStage(calibration, output.stage);
  if (!stage) return tl::unexpected(stage.error());
  MoveStage(*stage, calibration);
  DescribePlacesAnew(calibration.array, report);
  calibration.array.source = fmt::format("articap {}", report.stage);
  WarnOfEarlierOutput(output.path, report);
  return WriteAll(calibration.array, report.IsUsable(), CalibrationJson(calibration, report),
                  output);
}

}  // namespace

void WarnOfEarlierOutput(const std::string& path, StageReport& report) {
  std::error_code error;
  if (!report.IsUsable() && std::filesystem::exists(path, error))
    report.warnings.push_back(fmt::format(
        "{} is of an earlier calibration and stays as it was; this report is not about it", path));
}

ExitCode RunOnBoard(const VerbLine& line, const BoardInput& input, const CalibrationOutput& output,
                    const std::function<Result<StageReport>(const BoardSpec&)>& run) {
  const Result<BoardSpec> board = ParseBoardSpec(input.board);
  if (!board) return FailWith(ExitCode::kWrongUsage, board.error().message);
  if (const auto stage = CheckStageName(output); !stage)
    return FailWith(ExitCode::kWrongUsage, stage.error().message);
  if (const auto kept = RefuseToReplaceInputs(output, InputFiles(input.paths, input.lenses)); !kept)
    return FailWith(kept.error());
  const Result<StageReport> report = run(*board);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

Result<StageReport> Conclude(Result<StageResult<Calibration>> calibration, const SeenCamera& seen,
                             const CalibrationOutput& output) {
  if (!calibration) return Fail(WithReasons(calibration.error().message, seen));
  AddWhatWasSeen(seen, calibration->report);
  const auto written = WriteCalibrationOutputs(calibration->output, calibration->report, output);
  if (!written) return tl::unexpected(written.error());
  return calibration->report;
}

Result<void> CheckStageName(const CalibrationOutput& output, bool has_l_frame) {
  const std::string& stage = output.stage;
  const auto camera = RestOf(stage, "camera:");
  const auto picture = RestOf(stage, "board:");
  if (stage == "first" || (camera && !camera->empty())) return {};
  if (has_l_frame ? stage == "l-frame" : picture && !picture->empty()) return {};
  return Fail(fmt::format("--stage {}: is none of first (the first camera), camera:NAME, {}", stage,
                          has_l_frame ? "l-frame" : "board:PICTURE"));
}

Result<void> RefuseToReplaceInputs(const CalibrationOutput& output,
                                   const std::vector<std::filesystem::path>& inputs) {
  OutputSet outputs;
  outputs.Add(output.path, "");
  for (const char* ending : kReportEndings) outputs.Add(Beside(output.path, ending), "");
  return outputs.RefuseToOverwrite(inputs);
}

Result<void> WriteWandOutputs(const WandCalibration& wand, StageReport& report,
                              const CalibrationOutput& output) {
  DescribePlacesAnew(wand.array, report);
  WarnOfEarlierOutput(output.path, report);
  return WriteAll(wand.array, report.IsUsable(), CalibrationJson(wand, report), output);
}

}  // namespace articap
