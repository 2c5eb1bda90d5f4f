// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/io/camera_parts.h"
#include "core/io/text.h"
#include "core/view_regions.h"

namespace articap {
namespace {

// The larger of how far cameras stand from the origin of the stage, and from one another; mm.
double ReachOf(const CameraArray& array) {
  double reach_mm = 0;
  for (const Camera& camera : array.cameras) {
    const Eigen::Vector3d eye = camera.cam_from_stage.Inverse().translation_mm;
    reach_mm = std::max(reach_mm, eye.norm());
    for (const Camera& other : array.cameras)
      reach_mm = std::max(reach_mm, (eye - other.cam_from_stage.Inverse().translation_mm).norm());
  }
  return reach_mm;
}

// Why these places of cameras, read as mm, cannot be; or nothing.
std::optional<std::string> ImplausibleReach(double reach_mm) {
  constexpr double kNearest_mm = 25;     // two cameras do not stand closer, nor one to what it sees
  constexpr double kFarthest_mm = 25e3;  // larger than any room for it
  if (reach_mm == 0 || (reach_mm >= kNearest_mm && reach_mm <= kFarthest_mm)) return std::nullopt;
  return fmt::format("the cameras stand {} {:.4g} mm from the stage's origin and one another",
                     reach_mm < kNearest_mm ? "all within" : "as far as", reach_mm);
}

Result<void> CheckName(const std::string& name, const std::string& where) {
  if (name.empty() || !IsUtf8(name) || CleanText(name) != name || name.find('/') < name.size())
    return Fail(fmt::format("{}: '{}' is no name: it must be a line of text without a slash", where,
                            Printable(name)));
  return {};
}

// Sigmas are positive, 0 or unknown.
bool IsSigma(double sigma) { return std::isnan(sigma) || (sigma >= 0 && std::isfinite(sigma)); }

bool AreSigmas(const CameraSigmas& sigmas) {
  return IsSigma(sigmas.fx_px) && IsSigma(sigmas.fy_px) && IsSigma(sigmas.cx_px) &&
         IsSigma(sigmas.cy_px) && IsSigma(sigmas.time_offset_s) &&
         std::all_of(sigmas.distortion.begin(), sigmas.distortion.end(), IsSigma) &&
         sigmas.rotation_rad.unaryExpr(&IsSigma).all() &&
         sigmas.translation_mm.unaryExpr(&IsSigma).all();
}

Result<void> CheckCamera(const Camera& camera, const std::string& where) {
  const Lens& lens = camera.lens;
  if (!std::isfinite(lens.cx_px) || !std::isfinite(lens.cy_px))
    return Fail(fmt::format("{}: the principal point is not finite", where));
  // From a picture of 174 degrees to a telescope.
  const double relative = std::min(lens.fx_px / camera.width, lens.fy_px / camera.height);
  const double largest = std::max(lens.fx_px / camera.width, lens.fy_px / camera.height);
  if (!(relative >= 0.025) || !(largest <= 1000))
    return Fail(
        fmt::format("{}: focal lengths of {:.6g} and {:.6g} px are absurd for a picture of "
                    "{}x{} px; are they in mm?",
                    where, lens.fx_px, lens.fy_px, camera.width, camera.height));
  constexpr double kFarthest_mm = 1e6;
  if (!(camera.cam_from_stage.translation_mm.norm() <= kFarthest_mm))
    return Fail(
        fmt::format("{}: its translation is not finite, or longer than a kilometre", where));
  if (!std::isfinite(camera.time_offset_s))
    return Fail(fmt::format("{}: the time offset is not finite", where));
  if (!AreSigmas(camera.sigmas))
    return Fail(fmt::format("{}: a standard deviation is negative or not finite", where));
  return {};
}

Result<void> CheckMirror(const Mirror& mirror, const CameraArray& array, const std::string& where) {
  if (mirror.camera < 0 || mirror.camera >= static_cast<int>(array.cameras.size()))
    return Fail(fmt::format("{}: belongs to none of the cameras", where));
  constexpr double kUnit = 1e-12;
  if (!(std::abs(mirror.normal_in_stage.norm() - 1) <= kUnit))
    return Fail(fmt::format("{}: the normal is not one long", where));
  if (!std::isfinite(mirror.distance_mm))
    return Fail(fmt::format("{}: the distance is not finite", where));
  if (!(mirror.glass_mm >= 0) || !std::isfinite(mirror.glass_mm))
    return Fail(fmt::format("{}: glass of {} mm", where, mirror.glass_mm));
  if (!(mirror.glass_index >= 1) || !(mirror.glass_index <= 4))
    return Fail(fmt::format("{}: glass has no refractive index of {}; about 1.5 is usual", where,
                            mirror.glass_index));
  if (!IsSigma(mirror.normal_sigma_rad) || !IsSigma(mirror.distance_sigma_mm))
    return Fail(fmt::format("{}: a standard deviation is negative or not finite", where));
  return {};
}

}  // namespace

Result<void> ConvertToMm(const std::string& named_unit, const CameraReadOptions& options,
                         const std::string& source_name, CameraReading& reading) {
  for (const std::string& unit : {options.unit, named_unit})
    if (!unit.empty() && unit != "mm" && unit != "m")
      return Fail(fmt::format("{}: the unit '{}' is not known; there are mm and m", source_name,
                              Printable(unit)));
  if (!named_unit.empty() && !options.unit.empty() && named_unit != options.unit)
    return Fail(fmt::format("{}: its lengths are in {}, not in {}; leave the unit out", source_name,
                            named_unit, options.unit));
  const bool is_assumed = named_unit.empty() && options.unit.empty();
  if (named_unit == "m" || options.unit == "m")
    for (Camera& camera : reading.array.cameras) camera.cam_from_stage.translation_mm *= 1000;

  const double reach_mm = ReachOf(reading.array);
  const auto implausible = ImplausibleReach(reach_mm);
  if (implausible && is_assumed)
    return Fail(fmt::format("{}: read as mm, {}; say which it is in: --unit m, or mm", source_name,
                            *implausible));
  if (implausible && named_unit.empty()) reading.warnings.push_back(*implausible);
  if (is_assumed && reach_mm > 0)
    reading.warnings.push_back("the file does not say which unit its lengths are in; taken as mm");
  return {};
}

Result<void> CheckCameras(const CameraArray& array, const std::string& source_name) {
  if (array.cameras.empty())
    return Fail(fmt::format("{}: there are no cameras in it", source_name));
  std::set<std::string> names;
  for (const Camera& camera : array.cameras) {
    if (auto name = CheckName(camera.name, source_name + ", the name of a camera"); !name)
      return name;
    const std::string where = fmt::format("{}, camera '{}'", source_name, camera.name);
    if (!names.insert(camera.name).second) return Fail(where + ": the name is there twice");
    if (auto checked = CheckCamera(camera, where); !checked) return checked;
  }
  names.clear();
  for (const Mirror& mirror : array.mirrors) {
    if (auto name = CheckName(mirror.name, source_name + ", the name of a mirror"); !name)
      return name;
    const std::string where = fmt::format("{}, mirror '{}'", source_name, mirror.name);
    if (auto checked = CheckMirror(mirror, array, where); !checked) return checked;
    if (!names.insert(array.cameras[mirror.camera].name + "/" + mirror.name).second)
      return Fail(where + ": the camera has two of that name");
  }
  if (const auto checked = CheckRegions(array); !checked)
    return Fail(fmt::format("{}: {}", source_name, checked.error().message));
  return {};
}

}  // namespace articap
