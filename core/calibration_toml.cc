// SPDX-License-Identifier: MIT
#include "core/calibration_toml.h"

#include <fmt/format.h>

#include <cmath>

#include "core/check.h"
#include "core/file_io.h"
#include "core/io/calibration_keys.h"
#include "core/io/camera_formats.h"
#include "core/io/camera_parts.h"
#include "core/toml_reader.h"

namespace articap {
namespace {

constexpr char kHead[] =
    R"(# A calibrated set of cameras, written by articap in the layout of aniposelib's CameraGroup.
# Lengths in mm, angles in rad, pixels from the centre of the top left one. The camera frame has x
# to the right, y down and z ahead: x_cam = R x_stage + translation, R of the rotation vector
# (Rodrigues) rotation. distortions are k1 k2 p1 p2 k3 (k4 k5 k6) in OpenCV's order and sign.
# sigmas are standard deviations: 0 where a value was held, left out where nothing is known.
)";

// What is not known, or not determined at all, is left out.
std::string SigmaTable(const std::string& table, CameraSigmas sigmas) {
  std::string lines;
  for (const auto& [key, sigma] : KeyedSigmas(sigmas))
    if (std::isfinite(*sigma)) lines += fmt::format("{} = {}\n", key, TomlFloat(*sigma));
  return lines.empty() ? "" : fmt::format("\n[{}.sigmas]\n{}", table, lines);
}

std::string RegionLine(const std::optional<PictureRegion>& region) {
  if (!region) return "";
  return fmt::format("region = {}\n", QuotedToml(FormatPictureRegion(*region)));
}

std::string CameraTable(const Camera& camera, const std::string& table) {
  return fmt::format(
      "\n[{}]\nname = {}\nsize = [{}, {}]\nmatrix = {}\ndistortions = {}\nrotation = {}\n"
      "translation = {}\nfisheye = false\ntime_offset_s = {}\n{}{}",
      table, QuotedToml(camera.name), camera.width, camera.height,
      TomlMatrix(MatrixOf(camera.lens)), TomlList(DistortionList(camera.lens)),
      TomlList(SettledRotationVector(camera.cam_from_stage.rotation)),
      TomlList(camera.cam_from_stage.translation_mm), TomlFloat(camera.time_offset_s),
      RegionLine(camera.region), SigmaTable(table, camera.sigmas));
}

std::string MirrorTable(const Mirror& mirror, const std::string& camera_name, std::size_t number) {
  std::string text = fmt::format(
      "\n[metadata.mirror_{}]\nname = {}\ncamera = {}\nnormal = {}\ndistance_mm = {}\n"
      "glass_mm = {}\nglass_index = {}\n",
      number, QuotedToml(mirror.name), QuotedToml(camera_name), TomlList(mirror.normal_in_stage),
      TomlFloat(mirror.distance_mm), TomlFloat(mirror.glass_mm), TomlFloat(mirror.glass_index));
  text += RegionLine(mirror.region);
  if (std::isfinite(mirror.normal_sigma_rad))
    text += fmt::format("normal_sigma_rad = {}\n", TomlFloat(mirror.normal_sigma_rad));
  if (std::isfinite(mirror.distance_sigma_mm))
    text += fmt::format("distance_sigma_mm = {}\n", TomlFloat(mirror.distance_sigma_mm));
  return text;
}

}  // namespace

std::string WriteCalibration(const CameraArray& array) {
  ARTICAP_CHECK(!array.cameras.empty());
  std::string text = kHead;
  // aniposelib sorts the tables by name; with equally many digits that is our order.
  const std::size_t digits = std::to_string(array.cameras.size() - 1).size();
  for (std::size_t i = 0; i < array.cameras.size(); ++i)
    text += CameraTable(array.cameras[i], fmt::format("cam_{:0{}}", i, digits));
  text += fmt::format("\n[metadata]\nlayout = {}\nunit = \"mm\"\n", QuotedToml(kCalibrationLayout));
  if (!array.source.empty()) text += fmt::format("source = {}\n", QuotedToml(array.source));
  for (std::size_t i = 0; i < array.mirrors.size(); ++i) {
    const Mirror& mirror = array.mirrors[i];
    text += MirrorTable(mirror, array.cameras.at(mirror.camera).name, i);
  }
  return text;
}

Result<CameraArray> ParseCalibration(const std::string& toml_text, const std::string& source_name) {
  auto reading = ReadCameraToml(toml_text, source_name, {});
  if (!reading) return tl::unexpected(std::move(reading.error()));
  return std::move(reading->array);
}

Result<CameraArray> ReadCalibration(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseCalibration(*text, path.string());
}

}  // namespace articap
