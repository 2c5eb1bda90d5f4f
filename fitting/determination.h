// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "rig/virtual_marker_evaluator.h"

namespace articap {

// Which parameters a set of markers can determine, and how well, to first order about a pose: with
// the Jacobian J of the markers seen and isotropic noise of standard deviation sigma a coordinate,
// the covariance of the least-squares estimate, and the Cramer-Rao bound, is sigma^2 (J^T J)^-1.
class Determination {
 public:
  // `ranges`: of each parameter, max - min. `sigma_mm`: mm of the rig.
  Determination(const VirtualMarkerEvaluator& evaluator, const Eigen::VectorXd& parameters,
                const Eigen::VectorXd& ranges, double sigma_mm, double max_sigma_of_range);

  // The parameters that the markers seen determine: starting from all, the one with the largest
  // standard deviation over its range is dropped until none exceeds max_sigma_of_range. Those
  // dropped are assumed known by the others.
  std::vector<bool> Determined(std::span<const bool> seen) const;
  // Standard deviations with all markers seen and every parameter free; infinite where there is
  // none.
  Eigen::VectorXd Sigmas() const;

 private:
  std::vector<Eigen::MatrixXd> information_;  // J^T J of each marker
  Eigen::VectorXd ranges_;
  double sigma_mm_;
  double max_sigma_of_range_;
};

// Square roots of the diagonal of (J^T J)^-1 restricted to the parameters marked; infinite for
// others and where the restricted matrix is singular.
Eigen::VectorXd UnitSigmas(const Eigen::MatrixXd& information, const std::vector<bool>& free);

}  // namespace articap
