// SPDX-License-Identifier: MIT
#include "render/shapes.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "render/lens_view.h"
#include "render/render.h"

namespace articap {
namespace {

constexpr float kWhite = 0.8f, kBlack = 0.1f;
constexpr int kSamplesPerSide = 4;
constexpr double kPlain = 0.002;  // RenderOptions::one_sample_below

Camera SmallCamera() {
  Camera camera;
  camera.width = 400;
  camera.height = 300;
  camera.lens = {420, 415, 204, 146, {-0.25, 0.08, 0.002, -0.001, 0, 0, 0, 0}};
  return camera;
}

// In uniform light, so that albedo is what the picture shows.
LinearPicture PictureOf(RenderMesh mesh, const Camera& camera, double one_sample_below) {
  Scene scene;
  scene.lights.clear();
  scene.ambient = Eigen::Vector3f::Ones();
  scene.background = Eigen::Vector3f::Constant(0.4f);
  scene.meshes = {std::move(mesh)};
  return RenderLinear(scene, LensView(camera),
                      {.samples_per_side = kSamplesPerSide,
                       .one_sample_below = one_sample_below,
                       .occlusion_mm = 0});
}

float LightAt(const LinearPicture& picture, int x, int y) {
  return picture.rgb[static_cast<std::size_t>(y) * picture.width + x].x();
}

// The point of the segment from a to b that is shown at this height of the picture.
std::optional<Eigen::Vector2d> CrossingOf(const Camera& camera, const Eigen::Vector3d& a_mm,
                                          const Eigen::Vector3d& b_mm, double y_px) {
  double low = 0, high = 1;
  const auto shown = [&](double part) {
    return Project(camera.lens, camera.cam_from_stage * (a_mm + part * (b_mm - a_mm))).value();
  };
  if (!(shown(low).y() < y_px && y_px < shown(high).y())) return std::nullopt;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = (low + high) / 2;
    (shown(middle).y() < y_px ? low : high) = middle;
  }
  return shown(low);
}

// Over a row of pixels across an edge, the missing light is the length of the dark part: that
// places the edge without a model of its profile. Averaged over many rows the samples' own spread,
// less than a quarter of a pixel each, has gone.
struct EdgeErrors {
  double mean_px = 0;
  double rms_px = 0;
  int count = 0;
};

EdgeErrors MeasureLeftEdges(const LinearPicture& picture, const Camera& camera,
                            const BoardPattern& pattern, const Rigid3d& stage_from_board) {
  constexpr int kReach_px = 5;
  EdgeErrors errors;
  for (const BoardRectangle& dark : pattern.dark) {
    // Away from the corners, where other squares begin.
    const double margin_mm = 0.25 * (dark.max_mm - dark.min_mm).y();
    const Eigen::Vector3d top(dark.min_mm.x(), dark.min_mm.y() + margin_mm, 0);
    const Eigen::Vector3d bottom(dark.min_mm.x(), dark.max_mm.y() - margin_mm, 0);
    for (int y = 0; y < picture.height; ++y) {
      const auto truth = CrossingOf(camera, stage_from_board * top, stage_from_board * bottom, y);
      if (!truth) continue;
      const int first = static_cast<int>(std::lround(truth->x())) - kReach_px;
      double white_px = 0;
      for (int x = first; x < first + 2 * kReach_px; ++x)
        white_px += (LightAt(picture, x, y) - kBlack) / (kWhite - kBlack);
      const double error_px = first - 0.5 + white_px - truth->x();
      errors.mean_px += error_px;
      errors.rms_px += error_px * error_px;
      ++errors.count;
    }
  }
  errors.mean_px /= errors.count;
  errors.rms_px = std::sqrt(errors.rms_px / errors.count);
  return errors;
}

Rigid3d BoardPose(double angle_rad, const Eigen::Vector3d& axis) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized())), {-60, -55, 330}};
}

// A sample stands for a sixteenth of a pixel: an error of 1/4/sqrt(12) px a row at the worst, and
// its standard error in the mean.
TEST(ShapesTest, EdgesOfABoardAreWhereTheLensShowsThem) {
  const Camera camera = SmallCamera();
  const BoardPattern pattern = SquaresOf({.columns = 5, .rows = 4, .square_mm = 25});
  const double worst_rms_px = 0.25 / std::sqrt(12.0);
  for (const Rigid3d& stage_from_board :
       {BoardPose(0.0, {0, 0, 1}), BoardPose(0.5, {0.2, 1, 0.1}), BoardPose(0.4, {1, -0.6, 0.3})}) {
    const RenderMesh board = BoardMesh(pattern, stage_from_board, kWhite, kBlack);
    const LinearPicture picture = PictureOf(board, camera, kPlain);
    const EdgeErrors errors = MeasureLeftEdges(picture, camera, pattern, stage_from_board);
    EXPECT_GT(errors.count, 150);
    EXPECT_LT(errors.rms_px, worst_rms_px);
    EXPECT_LT(std::abs(errors.mean_px), 4 * worst_rms_px / std::sqrt(errors.count));
  }
}

TEST(ShapesTest, PlainPixelsAreTheSameWithOneSample) {
  const Camera camera = SmallCamera();
  const RenderMesh board = BoardMesh(SquaresOf({.columns = 5, .rows = 4, .square_mm = 25}),
                                     BoardPose(0.5, {0.2, 1, 0.1}), kWhite, kBlack);
  const LinearPicture all = PictureOf(board, camera, 0);
  const LinearPicture few = PictureOf(board, camera, kPlain);
  float largest = 0;
  for (std::size_t i = 0; i < all.rgb.size(); ++i)
    largest = std::max(largest, (all.rgb[i] - few.rgb[i]).cwiseAbs().maxCoeff());
  EXPECT_LT(largest, 1e-5);  // no edge has been overlooked
}

TEST(ShapesTest, PaperIsWhiteToItsEdgeAndItsBackIsPlain) {
  const Camera camera = SmallCamera();
  const BoardPattern pattern = SquaresOf({.columns = 5, .rows = 4, .square_mm = 25});
  Rigid3d pose = BoardPose(0.0, {0, 0, 1});
  const auto light = [&](const Rigid3d& stage_from_board, double x_mm, double y_mm) {
    const LinearPicture picture =
        PictureOf(BoardMesh(pattern, stage_from_board, kWhite, kBlack), camera, kPlain);
    const auto at = Project(camera.lens, stage_from_board * Eigen::Vector3d(x_mm, y_mm, 0));
    return LightAt(picture, static_cast<int>(std::lround(at->x())),
                   static_cast<int>(std::lround(at->y())));
  };
  EXPECT_NEAR(light(pose, -12, -12), kBlack, 1e-5);
  EXPECT_NEAR(light(pose, 12, -12), kWhite, 1e-5);
  EXPECT_NEAR(light(pose, -48, -48), kWhite, 1e-5);
  EXPECT_NEAR(light(pose, -52, -48), 0.4, 1e-5);
  const Eigen::AngleAxisd about(3.14159, Eigen::Vector3d::UnitY());
  pose = {Eigen::Quaterniond(about), {60, -55, 330}};
  EXPECT_NEAR(light(pose, -12, -12), kWhite, 1e-5);
}

}  // namespace
}  // namespace articap
