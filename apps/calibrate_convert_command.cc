// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/camera_input.h"
#include "apps/output_set.h"
#include "apps/verbs.h"
#include "core/calibration_toml.h"

namespace articap {
namespace {

Result<CameraFormat> ChosenFormat(const std::string& name, const std::string& path) {
  for (const CameraFormat format :
       {CameraFormat::kArticap, CameraFormat::kCaliscope, CameraFormat::kOpenCvYaml})
    if (name == NameOf(format)) return format;
  if (!name.empty())
    return Fail(
        fmt::format("--format {}: is not written; there are articap (which aniposelib reads "
                    "too), caliscope and opencv",
                    name));
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".toml") return CameraFormat::kArticap;
  if (ending == ".yml" || ending == ".yaml") return CameraFormat::kOpenCvYaml;
  return Fail(fmt::format("{}: cameras are written as .toml or .yml; or say --format", path));
}

// cameras.yml -> cameras_left.yml.
std::filesystem::path PathFor(const Camera& camera, const std::filesystem::path& output) {
  std::string name = camera.name;
  std::ranges::replace_if(
      name, [](char letter) { return std::string_view("\\:*?\"<>| ").find(letter) < 9; }, '_');
  return output.parent_path() / (output.stem().string() + "_" + name + output.extension().string());
}

Result<void> AddOutputs(const CameraArray& array, CameraFormat format, const std::string& output,
                        OutputSet& outputs) {
  if (format == CameraFormat::kArticap) {
    outputs.Add(output, WriteCalibration(array));
  } else if (format == CameraFormat::kCaliscope) {
    outputs.Add(output, WriteCaliscope(array));
  } else if (array.cameras.size() == 1) {
    outputs.Add(output, WriteOpenCvYaml(array.cameras[0]));
  } else {
    for (const Camera& camera : array.cameras) {
      const std::filesystem::path path = PathFor(camera, output);
      if (std::ranges::find(outputs.paths(), path) != outputs.paths().end())
        return Fail(fmt::format("{}: two cameras would be written there; rename one of them",
                                path.string()));
      outputs.Add(path, WriteOpenCvYaml(camera));
    }
  }
  return {};
}

StageReport DescribeConversion(const CameraReading& reading, CameraFormat format,
                               const std::string& input, const OutputSet& outputs) {
  StageReport report = DescribeCameras(reading.array, input);
  report.stage = "convert";
  std::string written;
  for (const std::filesystem::path& path : outputs.paths())
    written += (written.empty() ? "" : ", ") + path.string();
  report.verdict += ", written to " + written;
  report.texts.emplace_back("from", NameOf(reading.format));
  report.texts.emplace_back("to", NameOf(format));
  report.warnings = reading.warnings;
  for (const std::string& loss : LossesOf(reading.array, format)) report.warnings.push_back(loss);
  return report;
}

}  // namespace

ExitCode CalibrateConvertCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap calibrate convert",
      "Between files of calibrated cameras. What was assumed, and what the format of OUT\n"
      "cannot carry, is named. OpenCV's files hold one camera each: several cameras make\n"
      "OUT_<camera>.yml.",
      "articap calibrate convert session.qca.txt calibration.toml");
  std::string input, output, format_name;
  CameraReadOptions options;
  line.Argument(
      "IN", input,
      "calibration of articap, aniposelib, Caliscope, OpenCV (YAML) or Qualisys (QCA text)");
  line.Argument("OUT", output, "file to write: .toml, or .yml for OpenCV");
  line.Flag("--format", format_name, "NAME",
            "articap (which aniposelib reads too), caliscope or opencv, whatever the ending");
  line.Stage("read", options);
  if (const auto exit = line.Parse(arguments)) return *exit;

  const Result<CameraFormat> format = ChosenFormat(format_name, output);
  if (!format) return FailWith(ExitCode::kWrongUsage, format.error().message);
  const Result<CameraReading> reading = ReadCameraFile(input, options);
  if (!reading) return FailWith(reading.error());
  OutputSet outputs;
  if (const auto added = AddOutputs(reading->array, *format, output, outputs); !added)
    return FailWith(added.error());
  if (const auto allowed = outputs.RefuseToOverwrite({input, line.config_path()}); !allowed)
    return FailWith(allowed.error());
  if (const auto written = outputs.Commit(); !written) return FailWith(written.error());
  return line.Finish({DescribeConversion(*reading, *format, input, outputs)});
}

}  // namespace articap
