// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <pugixml.hpp>

#include "core/io/camera_formats.h"
#include "core/io/camera_parts.h"
#include "core/io/text.h"

// The calibration that Qualisys Track Manager exports (QCA as text, and what its real-time server
// sends): lengths in mm, lenses in 1/64 px but for the distortion, which has no unit. (x, y, z) is
// where the camera stands, and the rows of r11..r33 are its axes in the stage: x to the right, y
// up, z backwards.
namespace articap {
namespace {

constexpr double kSubpixels = 64;

// The attributes of one element; the first fault stays.
class Attributes {
 public:
  Attributes(pugi::xml_node node, std::string where) : node_(node), where_(std::move(where)) {}

  double Number(const char* name) {
    const auto number = ParseNumber(node_.attribute(name).value());
    if ((!number || !std::isfinite(*number)) && fault_.empty())
      fault_ = fmt::format("{}: '{}' of <{}> is missing or not a finite number", where_, name,
                           node_.name());
    return number.value_or(0.0);
  }
  Result<void> Checked() const {
    if (fault_.empty()) return {};
    return Fail(fault_);
  }

 private:
  pugi::xml_node node_;
  std::string where_;
  std::string fault_;
};

class QualisysCamera {
 public:
  QualisysCamera(pugi::xml_node node, std::string where) : node_(node), where_(std::move(where)) {}

  Result<Camera> Read(const CameraReadOptions& options) const {
    Camera camera;
    camera.name = node_.attribute("serial").value();
    auto read = ReadLens(camera);
    if (read) read = ReadPicture(options, camera);
    if (read) read = ReadPose(camera);
    if (!read) return tl::unexpected(read.error());
    return camera;
  }

 private:
  Result<void> ReadLens(Camera& camera) const {
    Attributes intrinsic(node_.child("intrinsic"), where_);
    Eigen::Matrix3d matrix;
    matrix << intrinsic.Number("focalLengthU"), intrinsic.Number("skew"),
        intrinsic.Number("centerPointU"), 0, intrinsic.Number("focalLengthV"),
        intrinsic.Number("centerPointV"), 0, 0, kSubpixels;
    const std::vector<double> distortion = {
        intrinsic.Number("radialDistortion1"), intrinsic.Number("radialDistortion2"),
        intrinsic.Number("tangentalDistortion1"), intrinsic.Number("tangentalDistortion2"),
        intrinsic.Number("radialDistortion3")};
    if (auto checked = intrinsic.Checked(); !checked) return checked;
    const auto lens = LensFromMatrix(matrix / kSubpixels, where_);
    if (!lens) return tl::unexpected(lens.error());
    camera.lens = *lens;
    return SetDistortion(distortion, where_, camera.lens);
  }

  // The sensor's area was calibrated, fov_video is what of it is in the pictures.
  Result<void> ReadPicture(const CameraReadOptions& options, Camera& camera) const {
    Attributes intrinsic(node_.child("intrinsic"), where_);
    const double sensor_width = (intrinsic.Number("sensorMaxU") + 1) / kSubpixels;
    const double sensor_height = (intrinsic.Number("sensorMaxV") + 1) / kSubpixels;
    const bool begins_at_0 =
        intrinsic.Number("sensorMinU") == 0 && intrinsic.Number("sensorMinV") == 0;
    if (auto checked = intrinsic.Checked(); !checked) return checked;
    if (!begins_at_0 || sensor_width != std::floor(sensor_width) ||
        sensor_height != std::floor(sensor_height))
      return Fail(
          fmt::format("{}: a sensor of {} x {} is none in 1/64 px; was the file written by "
                      "another program than Qualisys Track Manager?",
                      where_, sensor_width * kSubpixels, sensor_height * kSubpixels));
    const pugi::xml_node area = node_.child("fov_video");
    if (!area) return SetSize(sensor_width, sensor_height, options, where_, camera);
    Attributes fov(area, where_);
    const double left = fov.Number("left"), top = fov.Number("top");
    const double right = fov.Number("right"), bottom = fov.Number("bottom");
    if (auto checked = fov.Checked(); !checked) return checked;
    if (left < 0 || top < 0 || right >= sensor_width || bottom >= sensor_height)
      return Fail(
          fmt::format("{}: its video reaches from ({}, {}) to ({}, {}) px, beyond the {} x "
                      "{} px that were calibrated; were the pictures turned?",
                      where_, left, top, right, bottom, sensor_width, sensor_height));
    camera.lens.cx_px -= left;
    camera.lens.cy_px -= top;
    return SetSize(right - left + 1, bottom - top + 1, options, where_, camera);
  }

  Result<void> ReadPose(Camera& camera) const {
    Attributes transform(node_.child("transform"), where_);
    const Eigen::Vector3d eye_mm(transform.Number("x"), transform.Number("y"),
                                 transform.Number("z"));
    Eigen::Matrix3d axes;
    axes << transform.Number("r11"), transform.Number("r12"), transform.Number("r13"),
        transform.Number("r21"), transform.Number("r22"), transform.Number("r23"),
        transform.Number("r31"), transform.Number("r32"), transform.Number("r33");
    if (auto checked = transform.Checked(); !checked) return checked;
    // From x right, y up, z backwards to x right, y down, z ahead.
    const Eigen::Vector3d flipped(1, -1, -1);
    const auto rotation = RotationFromMatrix(flipped.asDiagonal() * axes, where_);
    if (!rotation) return tl::unexpected(rotation.error());
    camera.cam_from_stage = {*rotation, -(*rotation * eye_mm)};
    return {};
  }

  pugi::xml_node node_;
  std::string where_;
};

std::optional<std::string> WhyLeftOut(pugi::xml_node camera) {
  if (camera.attribute("active") && !camera.attribute("active").as_bool())
    return "it was not active";
  if (camera.attribute("calibrated") && !camera.attribute("calibrated").as_bool())
    return "it is not calibrated";
  return std::nullopt;
}

void WarnOfTurnedView(pugi::xml_node node, const Camera& camera, CameraReading& reading) {
  const int turned_deg = node.attribute("viewrotation").as_int();
  if (turned_deg != 0)
    reading.warnings.push_back(fmt::format(
        "camera '{}' is shown turned by {} degrees (viewrotation); its calibration is of pictures "
        "of {}x{} px as the sensor sees them: turn videos that were exported turned back",
        camera.name, turned_deg, camera.width, camera.height));
}

Result<void> RefuseOtherWriters(pugi::xml_node calibration, const std::string& source_name) {
  if (!calibration)
    return Fail(
        fmt::format("{}: is XML, but no calibration of Qualisys Track Manager; OpenCV's "
                    "files are read as YAML (.yml) alone",
                    source_name));
  if (std::string_view(calibration.attribute("qtm-version").value()) == "none")
    return Fail(
        fmt::format("{}: was written by Pose2Sim, which scales the distortion by 64; "
                    "convert the TOML that it was made from",
                    source_name));
  return {};
}

}  // namespace

Result<CameraReading> ReadQualisysCameras(const std::string& text, const std::string& source_name,
                                          const CameraReadOptions& options) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    return Fail(fmt::format("{}: byte {}: {}", source_name, parsed.offset, parsed.description()));
  const pugi::xml_node root = document.document_element();
  const pugi::xml_node calibration =
      std::string_view(root.name()) == "calibration" ? root : root.child("calibration");
  if (auto refused = RefuseOtherWriters(calibration, source_name); !refused)
    return tl::unexpected(refused.error());

  CameraReading reading;
  reading.format = CameraFormat::kQualisys;
  for (const pugi::xml_node node : calibration.child("cameras").children("camera")) {
    const std::string serial = Printable(node.attribute("serial").value());
    if (const auto why = WhyLeftOut(node)) {
      reading.warnings.push_back(fmt::format("camera '{}' is left out: {}", serial, *why));
      continue;
    }
    auto camera =
        QualisysCamera(node, fmt::format("{}, camera '{}'", source_name, serial)).Read(options);
    if (!camera) return tl::unexpected(camera.error());
    WarnOfTurnedView(node, *camera, reading);
    reading.array.cameras.push_back(*std::move(camera));
  }
  reading.warnings.emplace_back(
      "Qualisys does not say whether its pixels begin at 0 or have their centre there; taken as "
      "the "
      "latter: the principal points may be half a pixel off");
  if (auto converted = ConvertToMm("mm", options, source_name, reading); !converted)
    return tl::unexpected(converted.error());
  if (auto checked = CheckCameras(reading.array, source_name); !checked)
    return tl::unexpected(checked.error());
  return reading;
}

}  // namespace articap
