// SPDX-License-Identifier: MIT
#pragma once

#include <ceres/loss_function.h>

#include "fitting/marker_loss.h"

namespace articap {

// MarkerLoss in Ceres' convention, whose cost is half the sum of rho(|r|^2).
class CeresMarkerLoss : public ceres::LossFunction {
 public:
  explicit CeresMarkerLoss(const MarkerLoss& loss) : loss_(loss) {}

  void Evaluate(double squared_distance, double rho[3]) const override {
    const MarkerLoss::Value value = loss_(squared_distance);
    rho[0] = 2 * value.cost;
    rho[1] = 2 * value.first;
    rho[2] = 2 * value.second;
  }

 private:
  MarkerLoss loss_;
};

}  // namespace articap
