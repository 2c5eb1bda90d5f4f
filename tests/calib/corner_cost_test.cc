// SPDX-License-Identifier: MIT
#include "calib/cost_functions/corner_cost.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

namespace articap {
namespace {

const std::array<double, kLensSize> kLens = {1200,  1.01,   640,  355,  -0.2,  0.07,
                                             0.001, -0.002, 0.01, 0.03, -0.02, 0.004};
const std::array<double, kPoseSize> kCamFromStage = {0.1, -0.3, 0.05, 0.947364, 20, -30, 900};
const std::array<double, kPoseSize> kStageFromBoard = {-0.2, 0.1, 0.3, 0.927362, -50, 20, 15};
const double kOffset_s = 0.004;
const Eigen::Vector3d kCorner{75, 50, 0};
const Eigen::Vector2d kSeen{700, 400};

// The derivatives that were worked out against those that Ceres works out.
template <int kFirst, int kSecond, int... kSizes, class Cost>
void ExpectSameDerivatives(const Cost& cost, const std::vector<const double*>& blocks) {
  const std::unique_ptr<ceres::CostFunction> by_hand(cost.Create());
  const ceres::AutoDiffCostFunction<Cost, 2, kFirst, kSecond, kSizes...> automatic(new Cost(cost));
  std::array<std::vector<std::vector<double>>, 2> jacobians;
  std::array<Eigen::Vector2d, 2> residuals;
  int which = 0;
  for (const ceres::CostFunction* function :
       {static_cast<const ceres::CostFunction*>(by_hand.get()),
        static_cast<const ceres::CostFunction*>(&automatic)}) {
    std::vector<double*> pointers;
    for (int size : function->parameter_block_sizes()) jacobians[which].emplace_back(2 * size);
    for (auto& jacobian : jacobians[which]) pointers.push_back(jacobian.data());
    ASSERT_TRUE(function->Evaluate(blocks.data(), residuals[which].data(), pointers.data()));
    ++which;
  }
  EXPECT_LT((residuals[0] - residuals[1]).norm(), 1e-10);
  for (std::size_t block = 0; block < jacobians[0].size(); ++block)
    for (std::size_t i = 0; i < jacobians[0][block].size(); ++i)
      EXPECT_NEAR(jacobians[0][block][i], jacobians[1][block][i],
                  1e-9 * (1 + std::abs(jacobians[1][block][i])))
          << "block " << block << ", entry " << i;
}

TEST(CornerCostTest, DirectCornersHaveTheRightDerivatives) {
  ExpectSameDerivatives<kLensSize, kPoseSize, kPoseSize>(
      DirectCornerCost{kCorner, kSeen},
      {kLens.data(), kCamFromStage.data(), kStageFromBoard.data()});
}

TEST(CornerCostTest, MovingCornersHaveTheRightDerivatives) {
  const PointMotion motion = {{120, -80, 40}, {900, 300, -500}, 0.003};
  ExpectSameDerivatives<kLensSize, kPoseSize, 1, kPoseSize>(
      MovingCornerCost{kCorner, kSeen, motion},
      {kLens.data(), kCamFromStage.data(), &kOffset_s, kStageFromBoard.data()});
}

TEST(CornerCostTest, MotionRunsThroughItsThreePoints) {
  const std::array<TimedPoint, 3> path = {
      {{1.00, {0, 0, 0}}, {1.04, {4, -2, 1}}, {1.07, {9, 0, 1.5}}}};
  for (const TimedPoint& from : path)
    for (const TimedPoint& to : path) {
      const PointMotion motion = MotionThrough(path, from.time_s);
      const Eigen::Vector3d arrives = from.point_mm + motion.After(to.time_s - from.time_s);
      EXPECT_LT((arrives - to.point_mm).norm(), 1e-9) << from.time_s << " to " << to.time_s;
    }
}

}  // namespace
}  // namespace articap
