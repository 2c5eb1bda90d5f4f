// SPDX-License-Identifier: MIT
#include "core/camera_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/file_io.h"
#include "core/io/calibration_keys.h"
#include "core/io/camera_formats.h"
#include "core/io/camera_parts.h"
#include "core/io/opencv_yaml.h"
#include "core/io/text.h"

namespace articap {
namespace {

// Where a file begins, behind blanks, comments and a byte-order mark.
std::string_view BeginningOf(std::string_view text) {
  LineReader lines(text);
  while (const auto line = lines.Next()) {
    const std::string_view content = Trim(*line);
    if (!content.empty() && !content.starts_with('#')) return content;
  }
  return {};
}

// "name:" or "name: value", which no line of TOML is.
bool IsYaml(std::string_view line) {
  const std::size_t end = std::min(line.find_first_of(":=[{\"'<"), line.size());
  return line.starts_with("%YAML") || line == "---" || (end > 0 && line.substr(end, 1) == ":");
}

bool IsPairOfOpenCv(const std::string& text) {
  const auto document = OpenCvDocument::Parse(text, "");
  return document && document->Has("M1") && !document->Has("R");
}

// The second file that OpenCV's stereo sample writes; empty where it is not there.
Result<std::string> ReadExtrinsicsBeside(const std::filesystem::path& path) {
  for (const char* name : {"extrinsics.yml", "extrinsics.yaml"}) {
    const std::filesystem::path beside = path.parent_path() / name;
    std::error_code error;
    if (std::filesystem::is_regular_file(beside, error)) return ReadFile(beside);
  }
  return std::string();
}

bool KnowsSigmas(CameraSigmas sigmas) {
  return std::ranges::any_of(KeyedSigmas(sigmas),
                             [](const auto& keyed) { return std::isfinite(*keyed.second); });
}

}  // namespace

const char* NameOf(CameraFormat format) {
  switch (format) {
    case CameraFormat::kArticap:
      return "articap";
    case CameraFormat::kAniposelib:
      return "aniposelib";
    case CameraFormat::kCaliscope:
      return "caliscope";
    case CameraFormat::kOpenCvYaml:
      return "opencv";
    case CameraFormat::kQualisys:
      return "qualisys";
  }
  return "";
}

bool MayHoldCameras(const std::filesystem::path& path) {
  const std::string name = ToLower(path.filename().string());
  return std::ranges::any_of(
      std::initializer_list<const char*>{".toml", ".yml", ".yaml", ".xml", ".qca", ".qca.txt"},
      [&](const char* ending) { return name.ends_with(ending); });
}

Result<CameraReading> ParseCameras(const std::string& text, const std::string& source_name,
                                   const CameraReadOptions& options,
                                   const std::string& extrinsics_text) {
  const std::string_view beginning = BeginningOf(text);
  if (beginning.empty()) return Fail(fmt::format("{}: there is nothing in it", source_name));
  auto reading = beginning.starts_with('<') ? ReadQualisysCameras(text, source_name, options)
                 : IsYaml(beginning)
                     ? ReadOpenCvCameras(text, extrinsics_text, source_name, options)
                     : ReadCameraToml(text, source_name, options);
  if (reading && reading->format != CameraFormat::kArticap) {
    const std::string name = std::filesystem::path(source_name).filename().string();
    reading->array.source =
        fmt::format("{}, read as {}", IsUtf8(name) ? name : "a file", NameOf(reading->format));
  }
  return reading;
}

Result<CameraReading> ReadCameraFile(const std::filesystem::path& path,
                                     const CameraReadOptions& options) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  Result<std::string> extrinsics;
  if (IsPairOfOpenCv(*text)) extrinsics = ReadExtrinsicsBeside(path);
  if (!extrinsics) return tl::unexpected(extrinsics.error());
  return ParseCameras(*text, path.string(), options, *extrinsics);
}

Result<CameraArray> ReadCameras(const std::filesystem::path& path,
                                const CameraReadOptions& options) {
  auto reading = ReadCameraFile(path, options);
  if (!reading) return tl::unexpected(std::move(reading.error()));
  return std::move(reading->array);
}

std::vector<std::string> LossesOf(const CameraArray& array, CameraFormat format) {
  std::vector<std::string> losses;
  const auto any = [&](const auto& has) { return std::ranges::any_of(array.cameras, has); };
  if (any([](const Camera& camera) { return DistortionList(camera.lens).size() > 5; }) &&
      format != CameraFormat::kOpenCvYaml)
    losses.emplace_back(
        "newer versions of aniposelib and Caliscope take five distortion "
        "coefficients alone, not the eight of this lens");
  if (format == CameraFormat::kArticap) return losses;
  if (!array.mirrors.empty())
    losses.push_back(
        fmt::format("{} mirrors are not in {} files", array.mirrors.size(), NameOf(format)));
  if (any([](const Camera& camera) { return KnowsSigmas(camera.sigmas); }))
    losses.push_back(fmt::format("standard deviations are not in {} files", NameOf(format)));
  if (any([](const Camera& camera) { return camera.time_offset_s != 0; }))
    losses.push_back(fmt::format("time offsets are not in {} files", NameOf(format)));
  if (format == CameraFormat::kCaliscope)
    losses.emplace_back("the names of the cameras are not in caliscope files: they are numbered");
  if (!array.source.empty())
    losses.push_back(
        fmt::format("how they were made ('{}') is not in {} files", array.source, NameOf(format)));
  return losses;
}

}  // namespace articap
