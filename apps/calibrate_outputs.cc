// SPDX-License-Identifier: MIT
#include "apps/calibrate_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "apps/output_names.h"
#include "apps/output_set.h"
#include "calib/calibration_json.h"
#include "calib/stage_frame.h"
#include "core/calibration_toml.h"
#include "report/calibration_page.h"

namespace articap {
namespace {

Result<Rigid3d> ChooseStage(const Calibration& calibration, const std::string& stage) {
  if (stage == "first") return Rigid3d{};
  const auto rest_of = [&](const char* prefix) -> std::optional<std::string> {
    if (!stage.starts_with(prefix)) return std::nullopt;
    return stage.substr(std::string(prefix).size());
  };
  if (const auto camera = rest_of("camera:")) return StageOfCamera(calibration.array, *camera);
  if (const auto picture = rest_of("board:")) return StageOfBoard(calibration, *picture);
  return Fail(fmt::format(
      "--stage {}: is none of first (the first camera), camera:NAME, board:PICTURE", stage));
}

Result<void> WriteAll(const CameraArray& array, const StageReport& report, const std::string& json,
                      const CalibrationOutput& output, const std::vector<std::string>& inputs) {
  OutputSet outputs;
  if (report.IsUsable()) outputs.Add(output.path, WriteCalibration(array));
  outputs.Add(Beside(output.path, ".report.json"), json);
  outputs.Add(Beside(output.path, ".report.html"), CalibrationPage(json));
  if (const auto allowed = outputs.RefuseToOverwrite({inputs.begin(), inputs.end()}); !allowed)
    return allowed;
  return outputs.Commit();
}

}  // namespace

Result<void> WriteCalibrationOutputs(Calibration& calibration, const StageReport& report,
                                     const CalibrationOutput& output,
                                     const std::vector<std::string>& inputs) {
  const Result<Rigid3d> stage = ChooseStage(calibration, output.stage);
  if (!stage) return tl::unexpected(stage.error());
  MoveStage(*stage, calibration);
  calibration.array.source = fmt::format("articap {}", report.stage);
  return WriteAll(calibration.array, report, CalibrationJson(calibration, report), output, inputs);
}

Result<void> WriteWandOutputs(const WandCalibration& wand, const StageReport& report,
                              const CalibrationOutput& output,
                              const std::vector<std::string>& inputs) {
  return WriteAll(wand.array, report, CalibrationJson(wand, report), output, inputs);
}

std::string WithReasons(const std::string& message, const std::vector<std::string>& set_aside) {
  constexpr std::size_t kMostNamed = 10;
  std::string text = message;
  for (std::size_t i = 0; i < std::min(kMostNamed, set_aside.size()); ++i)
    text += "\n  " + set_aside[i];
  if (set_aside.size() > kMostNamed)
    text += fmt::format("\n  and {} more", set_aside.size() - kMostNamed);
  return text;
}

void AddWarnings(const std::vector<std::string>& set_aside, StageReport& report) {
  report.warnings.insert(report.warnings.begin(), set_aside.begin(), set_aside.end());
}

}  // namespace articap
