// SPDX-License-Identifier: MIT
#include "fitting/determination.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace articap {

Eigen::VectorXd UnitSigmas(const Eigen::MatrixXd& information, const std::vector<bool>& free) {
  const int size = static_cast<int>(information.rows());
  Eigen::VectorXd sigmas = Eigen::VectorXd::Constant(size, std::numeric_limits<double>::infinity());
  std::vector<int> index;
  // A parameter that no marker sees has no information at all.
  for (int i = 0; i < size; ++i)
    if (free[i] && information(i, i) > 0) index.push_back(i);
  const int num_free = static_cast<int>(index.size());
  if (num_free == 0) return sigmas;

  // Scaled to a unit diagonal, so that rad and mm meet on equal terms.
  Eigen::MatrixXd correlation(num_free, num_free);
  for (int i = 0; i < num_free; ++i)
    for (int k = 0; k < num_free; ++k)
      correlation(i, k) =
          information(index[i], index[k]) /
          std::sqrt(information(index[i], index[i]) * information(index[k], index[k]));
  // Keeps the factor of parameters that cannot be told apart definite; their sigmas come out as
  // some 1e5 times those of a parameter alone.
  correlation.diagonal().array() += 1e-10;
  const Eigen::LLT<Eigen::MatrixXd> factor(correlation);
  if (factor.info() != Eigen::Success) return sigmas;
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(num_free, num_free));
  for (int i = 0; i < num_free; ++i)
    sigmas[index[i]] = std::sqrt(inverse(i, i) / information(index[i], index[i]));
  return sigmas;
}

Determination::Determination(const VirtualMarkerEvaluator& evaluator,
                             const Eigen::VectorXd& parameters, const Eigen::VectorXd& ranges,
                             double sigma_mm, double max_sigma_of_range)
    : ranges_(ranges), sigma_mm_(sigma_mm), max_sigma_of_range_(max_sigma_of_range) {
  const Eigen::MatrixXd jacobian =
      evaluator.DenseJacobian({parameters.data(), static_cast<std::size_t>(parameters.size())});
  for (int i = 0; i < evaluator.num_markers(); ++i) {
    const auto rows = jacobian.middleRows<3>(3 * i);
    information_.push_back(rows.transpose() * rows);
  }
}

std::vector<bool> Determination::Determined(std::span<const bool> seen) const {
  const int size = static_cast<int>(ranges_.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < information_.size(); ++i)
    if (seen[i]) information += information_[i];

  std::vector<bool> determined(size);
  for (int i = 0; i < size; ++i) determined[i] = information(i, i) > 0;
  while (true) {
    const Eigen::VectorXd sigmas = sigma_mm_ * UnitSigmas(information, determined);
    int worst = -1;
    double worst_part = max_sigma_of_range_;
    for (int i = 0; i < size; ++i)
      if (determined[i] && sigmas[i] / ranges_[i] > worst_part) {
        worst_part = sigmas[i] / ranges_[i];
        worst = i;
      }
    if (worst < 0) return determined;
    determined[worst] = false;
  }
}

Eigen::VectorXd Determination::Sigmas() const {
  const int size = static_cast<int>(ranges_.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  for (const Eigen::MatrixXd& marker : information_) information += marker;
  return sigma_mm_ * UnitSigmas(information, std::vector<bool>(size, true));
}

}  // namespace articap
