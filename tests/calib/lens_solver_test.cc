// SPDX-License-Identifier: MIT
#include "calib/lens_solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calib/view_screening.h"
#include "tests/calib/network_scene.h"

namespace articap {
namespace {

using testing::HasSubstr;

TEST(LensSolverTest, PerfectCornersGiveTheLensBack) {
  const NetworkScene scene = LensScene(1, 12);
  const auto solved = SolveLens(scene.board, SeeBoards(scene, 0, 1)[0], {});
  ASSERT_TRUE(solved) << solved.error().message;
  const Lens& truth = scene.array.cameras[0].lens;
  const Lens& lens = solved->adjusted.network.array.cameras[0].lens;
  EXPECT_NEAR(lens.fx_px, truth.fx_px, 1e-4);
  EXPECT_NEAR(lens.fy_px, truth.fy_px, 1e-4);
  EXPECT_NEAR(lens.cx_px, truth.cx_px, 1e-4);
  EXPECT_NEAR(lens.cy_px, truth.cy_px, 1e-4);
  for (int i = 0; i < Lens::kNumDistortion; ++i)
    EXPECT_NEAR(lens.distortion[i], truth.distortion[i], 1e-5) << i;
  EXPECT_EQ(solved->model, LensModel::kBrown5);
}

}  // namespace
}  // namespace articap
