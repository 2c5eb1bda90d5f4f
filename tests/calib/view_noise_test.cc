// SPDX-License-Identifier: MIT
#include "calib/view_noise.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "calib/covariance.h"
#include "calib/mirror_calibration.h"
#include "calib/wand_calibration.h"
#include "tests/calib/network_scene.h"
#include "tests/calib/wand_scene.h"

namespace articap {
namespace {

// Rows that each touch all of the cameras' columns and those of one group, of views in turn.
struct RandomArrow {
  ArrowJacobian arrow;
  Eigen::MatrixXd dense;
};

RandomArrow MakeArrow(int rows, int camera_columns, int num_groups, int group_size) {
  std::mt19937 random(1);
  std::normal_distribution<double> gaussian;
  RandomArrow made;
  made.arrow.rows = rows;
  made.arrow.camera_columns = camera_columns;
  made.arrow.group_sizes.assign(num_groups, group_size);
  made.arrow.views = 2;
  made.arrow.row_starts = {0};
  made.dense = Eigen::MatrixXd::Zero(rows, camera_columns + num_groups * group_size);
  for (int row = 0; row < rows; ++row) {
    const int first = camera_columns + group_size * (row % num_groups);
    for (int column = 0; column < made.dense.cols(); ++column) {
      if (column >= camera_columns && (column < first || column >= first + group_size)) continue;
      made.dense(row, column) = gaussian(random);
      made.arrow.columns.push_back(column);
      made.arrow.values.push_back(made.dense(row, column));
    }
    made.arrow.row_starts.push_back(static_cast<int>(made.arrow.columns.size()));
    made.arrow.row_views.push_back(row % 7 == 0 ? -1 : row % 3 % 2);
  }
  return made;
}

TEST(CovarianceTest, IsThatOfTheDenseJacobian) {
  const auto [arrow, dense] = MakeArrow(60, 4, 5, 3);
  const Eigen::MatrixXd inverse = (dense.transpose() * dense).inverse();
  const Eigen::VectorXd leverages = (dense * inverse * dense.transpose()).diagonal();
  std::vector<double> redundancies = {0, 0};
  double of_none = 0;
  for (int row = 0; row < arrow.rows; ++row)
    (arrow.row_views[row] < 0 ? of_none : redundancies[arrow.row_views[row]]) += 1 - leverages(row);
  const ArrowCovariance found = CovarianceOf(arrow);
  EXPECT_LT((found.cameras - inverse.topLeftCorner(4, 4)).norm(), 1e-12);
  ASSERT_EQ(found.redundancies.size(), 2U);
  EXPECT_NEAR(found.redundancies[0], redundancies[0], 1e-10);
  EXPECT_NEAR(found.redundancies[1], redundancies[1], 1e-10);
  EXPECT_NEAR(found.redundancies[0] + found.redundancies[1] + of_none, 60 - 4 - 5 * 3, 1e-10);
}

void AddNoise(int view, int corners, double noise_px, std::mt19937& random, NoiseSums& sums) {
  std::normal_distribution<double> noise(0, noise_px);
  for (int i = 0; i < corners; ++i) sums.Add(view, Eigen::Vector2d{noise(random), noise(random)});
}

TEST(NoiseSumsTest, ViewsThatDoNotTellTheirNoiseAreTakenTogether) {
  constexpr int kMany = 2000, kFew = 10;
  NoiseSums sums({}, {1.9 * kMany, 1.9 * kFew, 0.6 * kMany, 0.8 * kMany});
  std::mt19937 random(2);
  AddNoise(0, kMany, 0.5, random, sums);
  AddNoise(1, kFew, 0.1, random, sums);
  // Parameters take up most of what these two show.
  AddNoise(2, kMany, 0.1 * std::sqrt(0.3), random, sums);
  AddNoise(3, kMany, 0.1 * std::sqrt(0.4), random, sums);
  const std::vector<double> noise_px = sums.NoiseOfViews_px();
  EXPECT_NEAR(noise_px[0], 0.5 * std::sqrt(2 / 1.9), 3.29 * 0.5 / std::sqrt(4.0 * kMany));
  EXPECT_EQ(noise_px[1], noise_px[2]);
  EXPECT_EQ(noise_px[2], noise_px[3]);
  EXPECT_NEAR(noise_px[3], 0.1, 3.29 * 0.1 / std::sqrt(2 * 1.4 * kMany));
}

TEST(NoiseSumsTest, AViewOfFewCornersTakesTheNoiseOfAll) {
  constexpr int kMany = 2000, kFew = 10;
  NoiseSums sums({}, {2.0 * kMany, 2.0 * kFew});
  std::mt19937 random(3);
  AddNoise(0, kMany, 0.2, random, sums);
  AddNoise(1, kFew, 0.5, random, sums);
  const std::vector<double> noise_px = sums.NoiseOfViews_px();
  EXPECT_NEAR(noise_px[0], 0.2, 3.29 * 0.2 / std::sqrt(4.0 * kMany));
  EXPECT_EQ(noise_px[1], sums.PooledNoise_px());
}

// Outliers, and what Huber's loss leaves of Gaussian residuals, leave the scale as it is.
TEST(NoiseSumsTest, HubersLossLeavesTheScaleOfGaussianNoise) {
  constexpr int kCorners = 100000;
  for (double huber_sigmas : {1.0, 2.0, 3.0}) {
    AdjustOptions options;
    options.huber_px = 0.1 * huber_sigmas;
    NoiseSums sums(options, {2.0 * kCorners});
    std::mt19937 random(4);
    AddNoise(0, kCorners, 0.1, random, sums);
    // Of an M-estimator it is the scatter that is estimated, which is larger by its efficiency:
    // (1 - exp(-k^2 / 2)) / slope^2 for residuals in the plane.
    const double k = huber_sigmas;
    const double beyond = std::sqrt(2 * M_PI) * std::erfc(k / std::sqrt(2.0)) / 2;
    const double slope = 1 - std::exp(-k * k / 2) + k * beyond / 2;
    const double scatter = std::sqrt(1 - std::exp(-k * k / 2)) / slope;
    EXPECT_NEAR(sums.NoiseOfViews_px()[0], 0.1 * scatter, 0.1 * 3.29 / std::sqrt(4.0 * kCorners))
        << huber_sigmas;
  }
}

// A mirror that is dusty, or out of focus.
TEST(ViewNoiseTest, AMirrorIsNoisierThanWhatIsSeenDirectly) {
  double normal2 = 0, distance2 = 0;
  constexpr int kSeeds = 8;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const NetworkScene scene = MirrorScene(seed, 20);
    CameraSightings seen = SeeBoards(scene, 0.05, 100 + seed)[0];
    const CameraSightings noisy = SeeBoards(scene, 0.25, 100 + seed)[0];
    for (std::size_t i = 0; i < seen.sightings.size(); ++i)
      if (seen.sightings[i].mirrored) seen.sightings[i] = noisy.sightings[i];
    const auto found = CalibrateMirror(scene.board, seen, {}, {});
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_EQ(found->output.noise_px.size(), 2U);
    // 20 placements of 54 corners.
    EXPECT_NEAR(found->output.noise_px[0], 0.05, 3.29 * 0.05 / std::sqrt(2 * 0.9 * 2160));
    EXPECT_NEAR(found->output.noise_px[1], 0.25, 3.29 * 0.25 / std::sqrt(2 * 0.9 * 2160));
    const Mirror& mirror = found->output.array.mirrors[0];
    const Mirror& truth = scene.array.mirrors[0];
    normal2 += std::pow(
        mirror.normal_in_stage.cross(truth.normal_in_stage).norm() / mirror.normal_sigma_rad, 2);
    distance2 += std::pow((mirror.distance_mm - truth.distance_mm) / mirror.distance_sigma_mm, 2);
  }
  std::printf("normal %.2f, distance %.2f (squares over sigmas squared)\n", normal2 / kSeeds,
              distance2 / kSeeds);
  // The normal has two components, of which the sigma is the larger one's.
  EXPECT_LT(normal2 / kSeeds, 2 * (1 + 3.29 / std::sqrt(2.0 * kSeeds)));
  EXPECT_NEAR(distance2 / kSeeds, 1, 3.29 * std::sqrt(2.0 / kSeeds));
}

// Synchronous cameras: between frames the noise of the wand's motion comes in.
TEST(ViewNoiseTest, ACameraOfAWandMayBeNoisierThanTheOthers) {
  constexpr int kNoisy = 2;
  WandOptions options;
  options.length_mm = kWandLength_mm;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    WandScene scene = WaveWand(4, 400, 0.1, seed, /*synchronous=*/true);
    scene.videos[kNoisy] = WaveWand(4, 400, 0.5, seed, /*synchronous=*/true).videos[kNoisy];
    const auto wand = CalibrateWand(scene.videos, options);
    ASSERT_TRUE(wand) << wand.error().message;
    for (int i = 0; i < 4; ++i) {
      const Camera& found = wand->output.array.cameras[i];
      const Camera& truth = scene.array.cameras[i];
      const double noise_px = i == kNoisy ? 0.5 : 0.1;
      // Half of what a camera shows is left to tell its noise.
      EXPECT_NEAR(wand->output.noise_px[i], noise_px,
                  3.29 * noise_px / std::sqrt(2 * 0.5 * 4 * 400))
          << seed << " cam" << i;
      if (i == 0) continue;
      EXPECT_LT((found.cam_from_stage.translation_mm - truth.cam_from_stage.translation_mm).norm(),
                4 * found.sigmas.translation_mm.norm())
          << seed << " cam" << i;
      EXPECT_NEAR(found.time_offset_s, truth.time_offset_s, 4 * found.sigmas.time_offset_s);
    }
    EXPECT_GT(wand->output.array.cameras[kNoisy].sigmas.rotation_rad.norm(),
              2 * wand->output.array.cameras[1].sigmas.rotation_rad.norm());
  }
}

}  // namespace
}  // namespace articap
