// SPDX-License-Identifier: MIT
#include "calib/covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>

#include "core/check.h"

namespace articap {
namespace {

// The blocks of J'J that one group of columns touches.
struct GroupBlocks {
  Eigen::MatrixXd own;    // group x group
  Eigen::MatrixXd mixed;  // group x cameras
};

struct NormalEquations {
  Eigen::MatrixXd cameras;
  std::vector<GroupBlocks> groups;
};

NormalEquations AccumulateNormalEquations(const ArrowJacobian& jacobian) {
  const int num_camera = jacobian.camera_columns;
  NormalEquations normal{Eigen::MatrixXd::Zero(num_camera, num_camera), {}};
  std::vector<int> group_of, column_in_group;
  for (int size : jacobian.group_sizes) {
    for (int i = 0; i < size; ++i) {
      group_of.push_back(static_cast<int>(normal.groups.size()));
      column_in_group.push_back(i);
    }
    normal.groups.push_back(
        {Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, num_camera)});
  }
  for (int row = 0; row < jacobian.rows; ++row)
    for (int i = jacobian.row_starts[row]; i < jacobian.row_starts[row + 1]; ++i)
      for (int j = jacobian.row_starts[row]; j < jacobian.row_starts[row + 1]; ++j) {
        const double product = jacobian.values[i] * jacobian.values[j];
        const int a = jacobian.columns[i], b = jacobian.columns[j];
        if (a < num_camera && b < num_camera) {
          normal.cameras(a, b) += product;
        } else if (a >= num_camera) {
          GroupBlocks& group = normal.groups[group_of[a - num_camera]];
          const int own = column_in_group[a - num_camera];
          if (b < num_camera)
            group.mixed(own, b) += product;
          else
            group.own(own, column_in_group[b - num_camera]) += product;
        }
      }
  return normal;
}

}  // namespace

Eigen::MatrixXd CameraCovariance(const ArrowJacobian& jacobian) {
  if (jacobian.camera_columns == 0) return {};
  NormalEquations normal = AccumulateNormalEquations(jacobian);
  Eigen::MatrixXd& schur = normal.cameras;
  for (const GroupBlocks& group : normal.groups) {
    const Eigen::LDLT<Eigen::MatrixXd> solver(group.own);
    if (solver.info() == Eigen::Success && solver.isPositive())
      schur -= group.mixed.transpose() * solver.solve(group.mixed);
  }
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
  Eigen::MatrixXd covariance = vectors * inverse.asDiagonal() * vectors.transpose();
  for (int i = 0; i < values.size(); ++i)
    for (int column = 0; column < jacobian.camera_columns; ++column)
      if (!(values(i) > kNothing) && std::abs(eigen.eigenvectors()(column, i)) > 1e-3)
        covariance(column, column) = std::numeric_limits<double>::infinity();
  return covariance;
}

}  // namespace articap
