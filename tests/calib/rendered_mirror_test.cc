// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "calib/board_detector.h"
#include "calib/board_pattern.h"
#include "calib/lens_model.h"
#include "calib/mirror_calibration.h"
#include "calib/stage_frame.h"
#include "core/alignment.h"
#include "core/triangulation.h"
#include "synthetic/board_scene.h"
#include "synthetic/camera_rigs.h"
#include "tests/calib/second_camera.h"

// The set-up of Rademan and Niesler from pictures: one camera of 1280 x 720 pixels and a mirror at
// 45 degrees, rendered with a lens, noise and blur, its board of 12 mm squares found and measured.
namespace articap {
namespace {

struct MirrorPictures {
  CameraArray truth;  // in the camera's frame
  BoardSpec board;
  std::vector<Rigid3d> cam_from_board;
  CameraSightings seen;
};

std::vector<Rigid3d> PosesOf(const Studio& studio, const BoardSpec& board,
                             const BoardPattern& pattern) {
  // Where both ways show the board, and, for the lens, all over the picture.
  const BoardPoseOptions both_ways = {.center_in_stage_mm = {-10, 0, 10},
                                      .reach_mm = {30, 40, 40},
                                      .facing_in_stage = {1, 0, 1},
                                      .most_tilt_deg = 25,
                                      .whole_in_views = 2};
  const BoardPoseOptions directly = {.reach_mm = {170, 90, 150}};
  std::vector<Rigid3d> poses = RandomBoardPoses(studio, board, pattern, both_ways, 12, 1).value();
  const std::vector<Rigid3d> more =
      RandomBoardPoses(studio, board, pattern, directly, 6, 2).value();
  poses.insert(poses.end(), more.begin(), more.end());
  return poses;
}

MirrorPictures TakePictures() {
  const Studio studio(MirrorSetUp(0, 1), 4);
  MirrorPictures pictures;
  pictures.truth = studio.cameras().array;
  const Rigid3d cam_from_stage = pictures.truth.cameras[0].cam_from_stage;
  MoveStage({}, {}, cam_from_stage, pictures.truth);
  pictures.board = ParseBoardSpec("chessboard:8x5:12").value();
  const Camera& camera = pictures.truth.cameras[0];
  pictures.seen = {camera.name, camera.width, camera.height, {}, {}};
  const BoardPattern pattern = PatternOf(pictures.board).value();
  SensorOptions sensor;
  sensor.blur_px = 0.7;
  DetectorOptions detect;
  detect.look_in_mirror = true;
  detect.thorough = false;
  std::int64_t number = 0;
  for (const Rigid3d& pose : PosesOf(studio, pictures.board, pattern)) {
    const Image picture =
        studio.Photograph(BoardScene(studio, pattern, pose), 0, sensor, 100 + number);
    for (const DetectedBoard& board :
         DetectBoard(picture.view(), {}, pictures.board, detect).boards)
      pictures.seen.sightings.push_back({std::to_string(number) + ".png",
                                         number,
                                         {},
                                         board.mirrored,
                                         board.corners,
                                         board.points_px});
    pictures.cam_from_board.push_back(cam_from_stage * pose);
    ++number;
  }
  return pictures;
}

// Corners that are seen both ways: as triangulated, and where they truly were in the camera's
// frame.
struct CornerPairs {
  std::vector<Eigen::Vector3d> found_mm;
  std::vector<Eigen::Vector3d> true_mm;
};

CornerPairs TriangulateCorners(const MirrorPictures& pictures, const Calibration& found) {
  std::map<std::pair<std::string, int>, std::vector<Sight>> sights;
  for (const SightingResult& sighting : found.sightings)
    for (std::size_t i = 0; i < sighting.corners.size() && sighting.used; ++i)
      sights[{sighting.source, sighting.corners[i]}].push_back(
          {sighting.view, sighting.points_px[i]});
  CornerPairs pairs;
  for (const auto& [key, of_corner] : sights) {
    const auto point = Triangulate(found.array, of_corner);
    if (!point) continue;
    const Rigid3d& cam_from_board = pictures.cam_from_board[std::stoul(key.first)];
    pairs.found_mm.push_back(point->point_in_stage_mm);
    pairs.true_mm.push_back(cam_from_board * pictures.board.corner_in_board_mm(key.second));
  }
  return pairs;
}

TEST(RenderedMirrorTest, TheMirrorAndWhatItShowsAreMeasured) {
  const MirrorPictures pictures = TakePictures();
  const auto found = CalibrateMirror(pictures.board, pictures.seen, {}, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->report.IsUsable()) << found->report.BriefReport();
  const Calibration& calibration = found->output;
  const double angle_deg = calibration.array.mirrors[0]
                               .normal_in_stage.cross(pictures.truth.mirrors[0].normal_in_stage)
                               .norm() *
                           180 / M_PI;
  const CornerPairs corners = TriangulateCorners(pictures, calibration);
  ASSERT_GT(corners.found_mm.size(), 400U);
  // The stage is anybody's choice: all corners of all pictures may be moved as one.
  const double corners_mm = AlignmentRms(AlignRigid(corners.found_mm, corners.true_mm),
                                         corners.found_mm, corners.true_mm);
  // In the camera's own frame the errors of its focal length and axis come in as well.
  const double in_camera_mm = AlignmentRms(Rigid3d{}, corners.found_mm, corners.true_mm);

  AdjustOptions options;
  options.lenses = {FreedomOf(LensModel::kBrown5, {}), LensFreedom{}};
  const AdjustedNetwork free = Adjust(WithFreeSecondCamera(calibration), options);
  std::printf(
      "normal to %.4f degrees (sigma %.4f), corners to %.4f mm RMS (%.4f in the camera's frame), "
      "held-out rigidity %.4f "
      "mm, %.4f px RMS; a free second camera %.4f px\n",
      angle_deg, calibration.array.mirrors[0].normal_sigma_rad * 180 / M_PI, corners_mm,
      in_camera_mm, calibration.held_out.rigidity_mm, calibration.rms_px(), free.rms_px());
  EXPECT_LT(angle_deg, 0.05);
  EXPECT_LT(corners_mm, 0.1);
  EXPECT_LT(calibration.rms_px(), 1.05 * free.rms_px());
}

}  // namespace
}  // namespace articap
