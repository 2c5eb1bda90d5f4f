// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/camera_io.h"

namespace articap {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector3d EyeOf(const Camera& camera) {
  return camera.cam_from_stage.Inverse().translation_mm;
}

ReportTable LensTable(const CameraArray& array) {
  ReportTable table;
  table.name = "cameras";
  table.columns = {"width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px", "fx_sigma_px"};
  for (const Camera& camera : array.cameras)
    table.rows.push_back(
        {camera.name,
         {static_cast<double>(camera.width), static_cast<double>(camera.height), camera.lens.fx_px,
          camera.lens.fy_px, camera.lens.cx_px, camera.lens.cy_px, camera.sigmas.fx_px}});
  return table;
}

ReportTable PlaceTable(const CameraArray& array) {
  ReportTable table;
  table.name = "places";
  table.columns = {"x_mm", "y_mm", "z_mm", "nearest_camera_mm"};
  for (const Camera& camera : array.cameras) {
    const Eigen::Vector3d eye = EyeOf(camera);
    double nearest_mm = kUnknown;
    for (const Camera& other : array.cameras)
      if (&other != &camera) nearest_mm = std::fmin(nearest_mm, (EyeOf(other) - eye).norm());
    table.rows.push_back({camera.name, {eye.x(), eye.y(), eye.z(), nearest_mm}});
  }
  return table;
}

ReportTable MirrorTable(const CameraArray& array) {
  ReportTable table;
  table.name = "mirrors";
  table.columns = {"normal_x", "normal_y", "normal_z", "distance_mm", "glass_mm"};
  for (const Mirror& mirror : array.mirrors) {
    const Eigen::Vector3d& normal = mirror.normal_in_stage;
    table.rows.push_back(
        {array.cameras.at(mirror.camera).name + "/" + mirror.name,
         {normal.x(), normal.y(), normal.z(), mirror.distance_mm, mirror.glass_mm}});
  }
  return table;
}

// The largest distance of two cameras.
double BaselineOf(const CameraArray& array) {
  double baseline_mm = 0;
  for (const Camera& camera : array.cameras)
    for (const Camera& other : array.cameras)
      baseline_mm = std::max(baseline_mm, (EyeOf(camera) - EyeOf(other)).norm());
  return baseline_mm;
}

}  // namespace

StageReport DescribeCameras(const CameraArray& array, const std::string& source_name) {
  StageReport report;
  report.stage = "cameras";
  report.verdict = fmt::format("{} camera{} and {} mirror{} in {}", array.cameras.size(),
                               array.cameras.size() == 1 ? "" : "s", array.mirrors.size(),
                               array.mirrors.size() == 1 ? "" : "s", source_name);
  report.figures = {{"cameras", static_cast<double>(array.cameras.size())},
                    {"mirrors", static_cast<double>(array.mirrors.size())}};
  if (array.cameras.size() > 1) report.figures.emplace_back("baseline_mm", BaselineOf(array));
  if (!array.source.empty()) report.texts = {{"source", array.source}};
  for (const View& view : array.views())
    if (const auto& region = array.RegionOf(view))
      report.texts.emplace_back("region_of_" + array.NameOf(view), FormatPictureRegion(*region));
  report.tables = {LensTable(array), PlaceTable(array)};
  if (!array.mirrors.empty()) report.tables.push_back(MirrorTable(array));
  return report;
}

}  // namespace articap
