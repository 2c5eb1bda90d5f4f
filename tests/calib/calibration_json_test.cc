// SPDX-License-Identifier: MIT
#include "calib/calibration_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "calib/lens_calibration.h"
#include "calib/mirror_calibration.h"
#include "tests/calib/network_scene.h"
#include "tests/calib/wand_scene.h"

namespace articap {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

constexpr double kNoise_px = 0.1;
constexpr double kRounding_px = 0.5001e-3;

StageResult<Calibration> LensWithABadView() {
  const NetworkScene scene = LensScene(7, 20);
  CameraSightings camera = SeeBoards(scene, kNoise_px, 3)[0];
  camera.sightings[4].points_px[12] += Eigen::Vector2d{6, -3};
  camera.sightings[4].source = "caf\xe9.png";  // Latin-1, not UTF-8
  return CalibrateLens(scene.board, camera, {}).value();
}

StageResult<Calibration> MirrorCalibration() {
  const NetworkScene scene = MirrorScene(5, 15);
  return CalibrateMirror(scene.board, SeeBoards(scene, kNoise_px, 11)[0], {}, {}).value();
}

TEST(CalibrationJsonTest, ExtendsTheReport) {
  const auto [calibration, report] = LensWithABadView();
  Json json = Json::parse(CalibrationJson(calibration, report));
  ASSERT_TRUE(json.contains("calibration"));
  json.erase("calibration");
  EXPECT_EQ(json.dump(), Json::parse(report.ToJson()).dump()) << "keys, order and values";
}

TEST(CalibrationJsonTest, TheSameCalibrationGivesTheSameBytes) {
  // A copy, and not solved anew: the threads of the adjustment leave the last digits open.
  const auto first = LensWithABadView();
  const auto copy = first;
  EXPECT_EQ(CalibrationJson(first.output, first.report), CalibrationJson(copy.output, copy.report));
}

TEST(CalibrationJsonTest, HoldsTheLensAndItsSigmas) {
  const auto [calibration, report] = LensWithABadView();
  const Camera& camera = calibration.array.cameras[0];
  const Json json = Json::parse(CalibrationJson(calibration, report))["calibration"];
  EXPECT_EQ(json["sigma_px"], calibration.sigma_px);
  EXPECT_EQ(json["rms_px"], calibration.rms_px());
  EXPECT_EQ(json["board"]["name"], "chessboard:9x6:25");
  EXPECT_EQ(json["held_out"]["rms_px"], calibration.held_out.rms_px);
  EXPECT_TRUE(json["held_out"]["rigidity_mm"].is_null()) << "one camera says nothing of distances";
  const Json& written = json["cameras"][0];
  EXPECT_EQ(written["width"], 640);
  EXPECT_EQ(written["noise_px"], calibration.noise_px[0]);
  EXPECT_EQ(written["lens"]["fx_px"], camera.lens.fx_px);
  EXPECT_EQ(written["lens"]["k2"], camera.lens.distortion[Lens::kK2]);
  EXPECT_EQ(written["lens_sigmas"]["fx_px"], camera.sigmas.fx_px);
  EXPECT_EQ(written["lens_sigmas"]["k2"], camera.sigmas.distortion[Lens::kK2]);
}

TEST(CalibrationJsonTest, HoldsEverySightingToAThousandthOfAPixel) {
  const auto [calibration, report] = LensWithABadView();
  const Json json = Json::parse(CalibrationJson(calibration, report))["calibration"]["sightings"];
  ASSERT_EQ(json.size(), calibration.sightings.size());
  int set_aside = 0;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const SightingResult& sighting = calibration.sightings[i];
    EXPECT_EQ(json[i]["used"], sighting.used);
    EXPECT_EQ(json[i]["rms_px"], sighting.rms_px());
    ASSERT_EQ(json[i]["corners"].size(), sighting.corners.size());
    for (std::size_t k = 0; k < sighting.corners.size(); ++k)
      for (int axis : {0, 1}) {
        EXPECT_NEAR(json[i]["points_px"][k][axis].get<double>(), sighting.points_px[k](axis),
                    kRounding_px);
        EXPECT_NEAR(json[i]["residuals_px"][k][axis].get<double>(), sighting.residuals_px[k](axis),
                    kRounding_px);
      }
    if (sighting.used) continue;
    ++set_aside;
    EXPECT_EQ(json[i]["source"], "caf\uFFFD.png") << "what is not UTF-8 is replaced";
    EXPECT_THAT(json[i]["reason"].get<std::string>(), HasSubstr("corner 12"));
  }
  EXPECT_EQ(set_aside, 1);
}

TEST(CalibrationJsonTest, CoverageCountsTheCornersThatWereUsed) {
  const auto [calibration, report] = LensWithABadView();
  const Json json = Json::parse(CalibrationJson(calibration, report))["calibration"];
  const Json& coverage = json["cameras"][0]["coverage"];
  const auto counts = coverage["corners_in_field"].get<std::vector<int>>();
  EXPECT_EQ(counts.size(), coverage["columns"].get<std::size_t>() * coverage["rows"].get<int>());
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 19 * 54);
}

TEST(CalibrationJsonTest, HoldsMirrorsAndWhichViewSawTheBoard) {
  const auto [calibration, report] = MirrorCalibration();
  const Json json = Json::parse(CalibrationJson(calibration, report))["calibration"];
  const Mirror& mirror = calibration.array.mirrors[0];
  ASSERT_EQ(json["mirrors"].size(), 1u);
  EXPECT_EQ(json["mirrors"][0]["distance_mm"], mirror.distance_mm);
  EXPECT_EQ(json["mirrors"][0]["normal_in_stage"][2], mirror.normal_in_stage.z());
  EXPECT_EQ(json["mirrors"][0]["normal_sigma_rad"], mirror.normal_sigma_rad);
  EXPECT_EQ(json["held_out"]["rigidity_mm"], calibration.held_out.rigidity_mm);
  int mirrored = 0;
  for (const Json& sighting : json["sightings"]) {
    EXPECT_EQ(sighting["view"], sighting["mirror"] == 0 ? "camera/mirror" : "camera");
    EXPECT_LT(sighting["placement"], json["placements"].size());
    mirrored += sighting["mirror"] == 0;
  }
  EXPECT_EQ(mirrored, 15);
}

TEST(CalibrationJsonTest, HoldsTheLengthsOfAWand) {
  WandOptions options;
  options.length_mm = kWandLength_mm;
  const auto [wand, report] = CalibrateWand(WaveWand(2, 200, kNoise_px, 1).videos, options).value();
  const Json json = Json::parse(CalibrationJson(wand, report))["calibration"];
  EXPECT_EQ(json["wand"]["lengths_mm"].get<std::vector<double>>(), wand.lengths_mm);
  EXPECT_EQ(json["wand"]["score"], wand.wand_score);
  EXPECT_EQ(json["cameras"][1]["time_offset_s"], wand.array.cameras[1].time_offset_s);
  EXPECT_FALSE(json.contains("sightings"));
}

// A line a sighting: what changed between two calibrations is found by diff.
TEST(CalibrationJsonTest, EverySightingHasALineOfItsOwn) {
  const auto [calibration, report] = LensWithABadView();
  const std::string text = CalibrationJson(calibration, report);
  for (const SightingResult& sighting : calibration.sightings) {
    if (!sighting.used) continue;
    EXPECT_THAT(text, HasSubstr("\n      {\"source\":\"" + sighting.source + "\",\"view\""));
  }
}

}  // namespace
}  // namespace articap
