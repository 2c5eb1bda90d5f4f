// SPDX-License-Identifier: MIT
#include "fitting/box_qp.h"

#include <gtest/gtest.h>

#include <random>

namespace articap {
namespace {

struct BoxQp {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient, lower, upper;
};

BoxQp RandomBoxQp(std::mt19937& random, int size) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
  BoxQp qp{root * root.transpose() + 0.01 * Eigen::MatrixXd::Identity(size, size),
           Eigen::VectorXd::NullaryExpr(size, [&] { return 3 * normal(random); }),
           Eigen::VectorXd::NullaryExpr(size, [&] { return -unit(random); }),
           Eigen::VectorXd::NullaryExpr(size, [&] { return unit(random); })};
  if (size > 2) qp.lower[1] = qp.upper[1] = 0;
  return qp;
}

// The Karush-Kuhn-Tucker conditions, which for a convex problem are all there is to the minimum.
TEST(BoxQpTest, SatisfiesTheOptimalityConditions) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 500; ++trial) {
    const int size = 1 + trial % 20;
    const BoxQp qp = RandomBoxQp(random, size);
    const Eigen::VectorXd x = SolveBoxQp(qp.hessian, qp.gradient, qp.lower, qp.upper);
    const Eigen::VectorXd slope = qp.gradient + qp.hessian * x;
    for (int i = 0; i < size; ++i) {
      ASSERT_GE(x[i], qp.lower[i]);
      ASSERT_LE(x[i], qp.upper[i]);
      if (qp.lower[i] == qp.upper[i]) continue;
      if (x[i] > qp.lower[i]) {
        ASSERT_LT(slope[i], 1e-8) << "trial " << trial;
      }
      if (x[i] < qp.upper[i]) {
        ASSERT_GT(slope[i], -1e-8) << "trial " << trial;
      }
    }
  }
}

}  // namespace
}  // namespace articap
