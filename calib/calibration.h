// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "calib/board_sighting.h"
#include "calib/network.h"
#include "core/camera.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

// What one camera saw of a board, and what is known of the camera.
struct CameraSightings {
  std::string camera;
  int width = 0;  // of the pictures, px
  int height = 0;
  std::vector<BoardSighting> sightings;
  std::optional<Lens> lens;  // where it was calibrated before
};

// That camera with a lens, at the origin of the stage.
Camera CameraWith(const CameraSightings& sightings, const Lens& lens);

// What became of a sighting.
struct SightingResult {
  std::string source;
  View view;
  int placement = -1;
  bool used = true;
  std::string reason;  // why it was set aside
  std::vector<int> corners;
  std::vector<Eigen::Vector2d> points_px;
  std::vector<Eigen::Vector2d> residuals_px;  // seen - expected; empty where no pose was found

  double rms_px() const { return RmsOf(residuals_px); }
};

// How well the calibration predicts what it was not made from. NaN where it cannot be said.
struct HeldOut {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  int views = 0;
  double rms_px = kUnknown;
  // Distances between corners that two views or more see, against the board: root mean square of
  // the differences, the same as expected from sigma_px alone, and how many distances.
  double rigidity_mm = kUnknown;
  double expected_rigidity_mm = kUnknown;
  int distances = 0;
};

// What the pictures say of a lens that was held: the focal length that would fit them best, over
// the lens' own, and its standard deviation.
struct HeldLens {
  int camera = 0;
  double focal_ratio = 1;
  double focal_ratio_sigma = 0;
};

// A calibration with everything that says how good it is.
struct Calibration {
  CameraArray array;
  BoardSpec board;
  std::vector<Placement> placements;
  std::vector<SightingResult> sightings;
  // Standard deviation of one coordinate of a corner: of all views together, and of each of
  // CameraArray::views().
  double sigma_px = 0;
  std::vector<double> noise_px;
  std::vector<double> local_noise_px;  // LocalNoiseOfViews_px()
  int degrees_of_freedom = 0;
  // Of the free parameters, in the gauge of the first camera.
  std::vector<CameraParameter> parameters;
  Eigen::MatrixXd covariance;
  std::vector<HeldLens> held_lenses;
  HeldOut held_out;

  double rms_px() const;  // over the sightings that were used
};

// Refuses boards that look the same upside down: two views of it cannot agree which corner is
// which.
Result<void> RequireToldCorners(const BoardSpec& board);

// Which sighting of which camera.
struct SightingKey {
  int camera = 0;
  int sighting = 0;

  friend bool operator<(const SightingKey& a, const SightingKey& b) {
    return std::tie(a.camera, a.sighting) < std::tie(b.camera, b.sighting);
  }
};

// Sightings that a calibration leaves out, and why.
using LeftOutSightings = std::map<SightingKey, std::string>;

// Gathers what an adjusted network says, and what became of the sightings that are not in it.
Calibration MakeCalibration(const std::vector<CameraSightings>& inputs,
                            const AdjustedNetwork& adjusted, const LeftOutSightings& set_aside);

}  // namespace articap
