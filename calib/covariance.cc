// SPDX-License-Identifier: MIT
#include "calib/covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>
#include <map>
#include <optional>

#include "core/check.h"

namespace articap {
namespace {

// The blocks of J'J that one group of columns touches.
struct GroupBlocks {
  Eigen::MatrixXd own;    // group x group
  Eigen::MatrixXd mixed;  // group x cameras
};

// J'J of the rows of one view, or of none (-1).
struct PartialNormal {
  Eigen::MatrixXd cameras;
  std::map<int, GroupBlocks> groups;
};

struct NormalEquations {
  std::map<int, PartialNormal> of_views;
  Eigen::MatrixXd cameras;
  std::vector<GroupBlocks> groups;
};

// Which group each column behind the cameras' is of.
struct GroupColumns {
  explicit GroupColumns(const std::vector<int>& sizes) {
    for (int group = 0; group < static_cast<int>(sizes.size()); ++group)
      for (int i = 0; i < sizes[group]; ++i) {
        group_of.push_back(group);
        column_in_group.push_back(i);
      }
  }

  std::vector<int> group_of, column_in_group;
};

void AddRow(const ArrowJacobian& jacobian, const GroupColumns& columns, int row,
            PartialNormal& part) {
  const int num_camera = jacobian.camera_columns;
  const int begin = jacobian.row_starts[row], end = jacobian.row_starts[row + 1];
  for (int i = begin; i < end; ++i) {
    const int a = jacobian.columns[i];
    if (a < num_camera) {
      for (int j = begin; j < end; ++j)
        if (jacobian.columns[j] < num_camera)
          part.cameras(a, jacobian.columns[j]) += jacobian.values[i] * jacobian.values[j];
      continue;
    }
    const int index = columns.group_of[a - num_camera];
    const int own = columns.column_in_group[a - num_camera];
    const auto [found, is_new] = part.groups.try_emplace(index);
    GroupBlocks& group = found->second;
    if (is_new) {
      const int size = jacobian.group_sizes[index];
      group = {Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, num_camera)};
    }
    for (int j = begin; j < end; ++j) {
      const int b = jacobian.columns[j];
      (b < num_camera ? group.mixed(own, b)
                      : group.own(own, columns.column_in_group[b - num_camera])) +=
          jacobian.values[i] * jacobian.values[j];
    }
  }
}

NormalEquations AccumulateNormalEquations(const ArrowJacobian& jacobian) {
  const int num_camera = jacobian.camera_columns;
  const GroupColumns columns(jacobian.group_sizes);
  NormalEquations normal;
  for (int row = 0; row < jacobian.rows; ++row) {
    const auto [found, is_new] = normal.of_views.try_emplace(jacobian.row_views[row]);
    if (is_new) found->second.cameras = Eigen::MatrixXd::Zero(num_camera, num_camera);
    AddRow(jacobian, columns, row, found->second);
  }
  normal.cameras = Eigen::MatrixXd::Zero(num_camera, num_camera);
  for (int size : jacobian.group_sizes)
    normal.groups.push_back(
        {Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, num_camera)});
  for (const auto& [view, part] : normal.of_views) {
    normal.cameras += part.cameras;
    for (const auto& [index, group] : part.groups) {
      normal.groups[index].own += group.own;
      normal.groups[index].mixed += group.mixed;
    }
  }
  return normal;
}

// The groups, eliminated.
class Elimination {
 public:
  explicit Elimination(const NormalEquations& normal) : schur_(normal.cameras) {
    for (const GroupBlocks& group : normal.groups) {
      auto& solver = solvers_.emplace_back(group.own);
      if (solver && !(solver->info() == Eigen::Success && solver->isPositive())) solver.reset();
      follows_.push_back(group.mixed);
      if (!solver || schur_.size() == 0) continue;
      follows_.back() = solver->solve(group.mixed);
      schur_ -= group.mixed.transpose() * follows_.back();
    }
  }

  const Eigen::MatrixXd& schur() const { return schur_; }

  // The trace of J (J'J)^-1 J' over the rows of one part: those of a row (a, b), a of the cameras
  // and b of a group with own and mixed blocks G and M, have b'G^-1 b + c'S^-1 c there, where
  // c = a - M'G^-1 b and S is the Schur complement.
  double LeverageOf(const PartialNormal& part, const Eigen::MatrixXd& inverse_of_schur) const {
    double leverage = inverse_of_schur.cwiseProduct(part.cameras).sum();
    for (const auto& [index, group] : part.groups) {
      if (!solvers_[index]) continue;
      leverage += solvers_[index]->solve(group.own).trace();
      if (schur_.size() == 0) continue;                 // all cameras are held
      const Eigen::MatrixXd& follow = follows_[index];  // G^-1 M
      const Eigen::MatrixXd spread = follow * inverse_of_schur;
      leverage -= 2 * spread.cwiseProduct(group.mixed).sum();
      leverage += (spread * follow.transpose()).cwiseProduct(group.own).sum();
    }
    return leverage;
  }

 private:
  Eigen::MatrixXd schur_;
  std::vector<std::optional<Eigen::LDLT<Eigen::MatrixXd>>> solvers_;  // none: undetermined
  std::vector<Eigen::MatrixXd> follows_;  // G^-1 M of those that are determined
};

// An inverse, and which of its rows are in directions of which nothing is known.
struct PartialInverse {
  Eigen::MatrixXd inverse;  // 0 in these directions
  std::vector<bool> unknown;
};

PartialInverse Invert(const Eigen::MatrixXd& schur) {
  // Scaled to a unit diagonal, so that pixels, radians and coefficients can be compared.
  const Eigen::VectorXd scale =
      schur.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1.0; });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * schur * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  ARTICAP_CHECK(eigen.info() == Eigen::Success);
  // Below this, of 1, the rounding of the elimination is all there is.
  constexpr double kNothing = 1e-13;
  const Eigen::ArrayXd values = eigen.eigenvalues().array();
  const Eigen::VectorXd inverse = (values > kNothing).select(1 / values, 0).matrix();
  const Eigen::MatrixXd vectors = scale.asDiagonal() * eigen.eigenvectors();
  PartialInverse result = {vectors * inverse.asDiagonal() * vectors.transpose(),
                           std::vector<bool>(static_cast<std::size_t>(schur.rows()), false)};
  for (int i = 0; i < values.size(); ++i)
    for (int column = 0; column < schur.cols(); ++column)
      if (!(values(i) > kNothing) && std::abs(eigen.eigenvectors()(column, i)) > 1e-3)
        result.unknown[column] = true;
  return result;
}

}  // namespace

ArrowCovariance CovarianceOf(const ArrowJacobian& jacobian) {
  const NormalEquations normal = AccumulateNormalEquations(jacobian);
  const Elimination elimination(normal);
  PartialInverse inverse;
  if (jacobian.camera_columns > 0) inverse = Invert(elimination.schur());
  ArrowCovariance covariance;
  covariance.redundancies.assign(jacobian.views, 0);
  for (int view : jacobian.row_views)
    if (view >= 0) ++covariance.redundancies[view];
  for (const auto& [view, part] : normal.of_views)
    if (view >= 0) covariance.redundancies[view] -= elimination.LeverageOf(part, inverse.inverse);
  covariance.cameras = std::move(inverse.inverse);
  for (int i = 0; i < static_cast<int>(inverse.unknown.size()); ++i)
    if (inverse.unknown[i]) covariance.cameras(i, i) = std::numeric_limits<double>::infinity();
  return covariance;
}

}  // namespace articap
