// SPDX-License-Identifier: MIT
#include "calib/calibration_json.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/calibration_report.h"
#include "core/json_text.h"

namespace articap {
namespace {

// Numbers that are not finite are kept here as they are; nlohmann writes them as null.
using Json = nlohmann::ordered_json;

// Corners are found to a hundredth of a pixel at best.
Json RoundedPixels(const std::vector<Eigen::Vector2d>& points_px) {
  const auto rounded = [](double value) {
    return std::round(1e3 * value) / 1e3 + 0.0;  // + 0.0: never "-0.0"
  };
  Json json = Json::array();
  for (const Eigen::Vector2d& point : points_px)
    json.push_back({rounded(point.x()), rounded(point.y())});
  return json;
}

Json ArrayOf(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Json PoseJson(const Rigid3d& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", ArrayOf(pose.translation_mm)}};
}

// For Lens and CameraSigmas, whose fields have the same names.
template <class Values>
Json LensJson(const Values& values) {
  constexpr std::array<const char*, Lens::kNumDistortion> kNames = {"k1", "k2", "p1", "p2",
                                                                    "k3", "k4", "k5", "k6"};
  Json json = {{"fx_px", values.fx_px},
               {"fy_px", values.fy_px},
               {"cx_px", values.cx_px},
               {"cy_px", values.cy_px}};
  for (std::size_t i = 0; i < kNames.size(); ++i) json[kNames[i]] = values.distortion[i];
  return json;
}

Json CameraJson(const Camera& camera) {
  Json json = {{"name", camera.name},
               {"width", camera.width},
               {"height", camera.height},
               {"lens", LensJson(camera.lens)},
               {"lens_sigmas", LensJson(camera.sigmas)},
               {"cam_from_stage", PoseJson(camera.cam_from_stage)}};
  json["cam_from_stage"]["rotation_sigmas_rad"] = ArrayOf(camera.sigmas.rotation_rad);
  json["cam_from_stage"]["translation_sigmas_mm"] = ArrayOf(camera.sigmas.translation_mm);
  json["time_offset_s"] = camera.time_offset_s;
  json["time_offset_sigma_s"] = camera.sigmas.time_offset_s;
  return json;
}

Json MirrorJson(const Mirror& mirror) {
  return {{"name", mirror.name},
          {"camera", mirror.camera},
          {"normal_in_stage", ArrayOf(mirror.normal_in_stage)},
          {"normal_sigma_rad", mirror.normal_sigma_rad},
          {"distance_mm", mirror.distance_mm},
          {"distance_sigma_mm", mirror.distance_sigma_mm},
          {"glass_mm", mirror.glass_mm},
          {"glass_index", mirror.glass_index}};
}

// For Calibration and WandCalibration.
template <class AnyCalibration>
Json ArrayJson(const AnyCalibration& calibration, double rms_px) {
  const CameraArray& array = calibration.array;
  Json json = {{"sigma_px", calibration.sigma_px},
               {"rms_px", rms_px},
               {"cameras", Json::array()},
               {"mirrors", Json::array()}};
  for (const Camera& camera : array.cameras) json["cameras"].push_back(CameraJson(camera));
  for (const Mirror& mirror : array.mirrors) json["mirrors"].push_back(MirrorJson(mirror));
  for (const View& view : array.views())
    (view.mirror < 0 ? json["cameras"][view.camera] : json["mirrors"][view.mirror])["noise_px"] =
        calibration.noise_px[array.IndexOf(view)];
  return json;
}

Json BoardJson(const BoardSpec& board) {
  return {{"name", NameOf(board)},
          {"corner_columns", board.corner_columns()},
          {"corner_rows", board.corner_rows()},
          {"square_mm", board.square_mm}};
}

Json HeldOutJson(const HeldOut& held_out) {
  return {{"views", held_out.views},
          {"rms_px", held_out.rms_px},
          {"rigidity_mm", held_out.rigidity_mm},
          {"expected_rigidity_mm", held_out.expected_rigidity_mm},
          {"distances", held_out.distances}};
}

Json CoverageJson(const Coverage& coverage) {
  return {{"columns", Coverage::kColumns},
          {"rows", Coverage::kRows},
          {"part", coverage.part()},
          {"gaps", coverage.gaps()},
          {"corners_in_field", coverage.corners_in_field}};
}

Json SightingJson(const SightingResult& sighting, const CameraArray& array) {
  return {{"source", sighting.source},
          {"view", array.NameOf(sighting.view)},
          {"camera", sighting.view.camera},
          {"mirror", sighting.view.mirror},
          {"placement", sighting.placement},
          {"used", sighting.used},
          {"reason", sighting.reason},
          {"rms_px", sighting.residuals_px.empty() ? NAN : sighting.rms_px()},
          {"corners", sighting.corners},
          {"points_px", RoundedPixels(sighting.points_px)},
          {"residuals_px", RoundedPixels(sighting.residuals_px)}};
}

std::string WithReport(const StageReport& report, Json calibration) {
  Json json = Json::parse(report.ToJson());
  json["calibration"] = std::move(calibration);
  // The rows of tables, the cameras and the sightings have a line each.
  constexpr int kDeepestIndented = 2;
  return IndentedJson(json, kDeepestIndented);
}

}  // namespace

std::string CalibrationJson(const Calibration& calibration, const StageReport& report) {
  Json json = ArrayJson(calibration, calibration.rms_px());
  for (std::size_t i = 0; i < json["cameras"].size(); ++i)
    json["cameras"][i]["coverage"] = CoverageJson(CoverageOf(calibration, static_cast<int>(i)));
  json["board"] = BoardJson(calibration.board);
  json["degrees_of_freedom"] = calibration.degrees_of_freedom;
  json["held_out"] = HeldOutJson(calibration.held_out);
  json["placements"] = Json::array();
  for (const Placement& placement : calibration.placements)
    json["placements"].push_back(
        {{"stage_from_board", PoseJson(placement.stage_from_board)}, {"time_s", placement.time_s}});
  json["sightings"] = Json::array();
  for (const SightingResult& sighting : calibration.sightings)
    json["sightings"].push_back(SightingJson(sighting, calibration.array));
  return WithReport(report, std::move(json));
}

std::string CalibrationJson(const WandCalibration& calibration, const StageReport& report) {
  Json json = ArrayJson(calibration, calibration.rms_px);
  json["wand"] = {{"instants", calibration.instants},
                  {"mean_length_mm", calibration.mean_length_mm},
                  {"score", calibration.wand_score},
                  {"lengths_mm", calibration.lengths_mm}};
  return WithReport(report, std::move(json));
}

}  // namespace articap
