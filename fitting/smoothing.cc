// SPDX-License-Identifier: MIT
#include "fitting/smoothing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "fitting/normal_equations.h"

namespace articap {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int kMaxSteps = 200;
constexpr double kMostDamping = 1e6;
constexpr double kRelativeTolerance = 1e-8;
constexpr int kRunLength = 512;

// Second differences of frames that follow one another and all have a fit.
constexpr std::array<double, 3> kSecondDifference = {1, -2, 1};

class TakeProblem {
 public:
  TakeProblem(const RigTracks& measured, const FrameFitSetup& setup, const Eigen::VectorXd& weights,
              const FrameFits& fits)
      : measured_(measured), setup_(setup), weights_(weights), equations_(measured.num_frames()) {
    for (int frame = 0; frame < measured.num_frames(); ++frame)
      if (fits.parameters.row(frame).allFinite()) frames_.push_back(frame);
  }

  int num_frames() const { return static_cast<int>(frames_.size()); }
  int frame(int i) const { return frames_[i]; }

  // The objective at y (fitted frames x parameters), keeping each frame's normal equations.
  double Linearize(const Eigen::MatrixXd& y) {
    const int num_runs = (num_frames() + kRunLength - 1) / kRunLength;
    ParallelFor(num_runs, setup_.threads, [&](int run) {
      LinearizedFrame linearized(setup_.evaluator, setup_.loss);
      const Eigen::VectorXd nowhere = Eigen::VectorXd::Zero(y.cols());
      const int end = std::min(num_frames(), (run + 1) * kRunLength);
      for (int i = run * kRunLength; i < end; ++i) {
        linearized.Linearize(measured_.positions_mm(frames_[i]), y.row(i));
        linearized.Build(nowhere, &equations_[i]);
      }
    });
    double objective = 0;
    for (int i = 0; i < num_frames(); ++i) objective += equations_[i].objective;
    ForDifferences([&](int i) { objective += Difference(y, i).cwiseAbs2().dot(weights_); });
    return objective;
  }

  // Gradient of the whole objective, fitted frames x parameters.
  Eigen::MatrixXd Gradient(const Eigen::MatrixXd& y) const {
    Eigen::MatrixXd gradient(y.rows(), y.cols());
    for (int i = 0; i < num_frames(); ++i) gradient.row(i) = equations_[i].gradient;
    ForDifferences([&](int i) {
      const Eigen::VectorXd slope = 2 * weights_.cwiseProduct(Difference(y, i));
      for (int k = 0; k < 3; ++k) gradient.row(i + k) += kSecondDifference[k] * slope.transpose();
    });
    return gradient;
  }

  // Newton's step with the diagonal raised by the part `damping` (Marquardt 1963); `held` unknowns
  // do not move. Not finite where the matrix is not definite.
  Eigen::MatrixXd Step(const Eigen::MatrixXd& gradient, double damping,
                       const std::vector<bool>& held) const {
    const int size = static_cast<int>(gradient.cols());
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int i, int a, int k, int b, double value) {
      const int row = i * size + a, column = k * size + b;
      if (row >= column && !held[row] && !held[column]) entries.emplace_back(row, column, value);
    };
    for (int i = 0; i < num_frames(); ++i) {
      const Eigen::MatrixXd hessian =
          equations_[i].reweighted_hessian + equations_[i].loss_curvature;
      for (int a = 0; a < size; ++a)
        for (int b = 0; b <= a; ++b) add(i, a, i, b, hessian(a, b));
    }
    ForDifferences([&](int i) {
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l <= k; ++l)
          for (int a = 0; a < size; ++a)
            add(i + k, a, i + l, a, 2 * weights_[a] * kSecondDifference[k] * kSecondDifference[l]);
    });
    const int unknowns = num_frames() * size;
    Eigen::VectorXd right(unknowns);
    for (int i = 0; i < num_frames(); ++i)
      for (int a = 0; a < size; ++a) {
        const int row = i * size + a;
        right[row] = held[row] ? 0 : -gradient(i, a);
        entries.emplace_back(row, row, held[row] ? 1 : 1e-12);
      }
    Sparse matrix(unknowns, unknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    matrix.diagonal() *= 1 + damping;
    // Natural order keeps the band.
    Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> factor(matrix);
    if (factor.info() != Eigen::Success) return gradient * std::nan("");
    const Eigen::VectorXd solution = factor.solve(right);
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        solution.data(), num_frames(), size);
  }

 private:
  template <class Work>
  void ForDifferences(Work work) const {
    for (int i = 0; i + 2 < num_frames(); ++i)
      if (frames_[i + 2] == frames_[i] + 2) work(i);
  }
  static Eigen::VectorXd Difference(const Eigen::MatrixXd& y, int i) {
    return (y.row(i) - 2 * y.row(i + 1) + y.row(i + 2)).transpose();
  }

  const RigTracks& measured_;
  const FrameFitSetup& setup_;
  Eigen::VectorXd weights_;
  std::vector<int> frames_;
  std::vector<NormalEquations> equations_;
};

// Undetermined parameters, and those at a bound with the objective falling outwards.
std::vector<bool> Held(const FrameFitSetup& setup, const Eigen::MatrixXd& y,
                       const Eigen::MatrixXd& gradient) {
  std::vector<bool> held(static_cast<std::size_t>(y.size()));
  for (Eigen::Index i = 0; i < y.rows(); ++i)
    for (Eigen::Index a = 0; a < y.cols(); ++a)
      held[static_cast<std::size_t>(i * y.cols() + a)] =
          !setup.determined[a] || (y(i, a) <= setup.lower[a] && gradient(i, a) > 0) ||
          (y(i, a) >= setup.upper[a] && gradient(i, a) < 0);
  return held;
}

}  // namespace

Smoothing SmoothFits(const RigTracks& measured, const FrameFitSetup& setup,
                     const Eigen::VectorXd& weights, FrameFits* fits) {
  TakeProblem problem(measured, setup, weights, *fits);
  if (problem.num_frames() < 3) return {};
  Eigen::MatrixXd y(problem.num_frames(), setup.evaluator.num_parameters());
  for (int i = 0; i < problem.num_frames(); ++i) y.row(i) = fits->parameters.row(problem.frame(i));

  const auto into_box = [&](Eigen::MatrixXd values) -> Eigen::MatrixXd {
    for (Eigen::Index a = 0; a < values.cols(); ++a)
      values.col(a) = values.col(a).cwiseMax(setup.lower[a]).cwiseMin(setup.upper[a]);
    return values;
  };
  double objective = problem.Linearize(y);
  double damping = 0.1;
  Smoothing smoothing{0, false};
  for (; smoothing.steps < kMaxSteps && damping < kMostDamping && !smoothing.converged;
       ++smoothing.steps) {
    const Eigen::MatrixXd gradient = problem.Gradient(y);
    const Eigen::MatrixXd candidate =
        into_box(y + problem.Step(gradient, damping, Held(setup, y, gradient)));
    const double candidate_objective = problem.Linearize(candidate);
    const double decrease = objective - candidate_objective;
    if (!(decrease >= 0)) {
      damping *= 10;
      problem.Linearize(y);
      continue;
    }
    y = candidate;
    objective = candidate_objective;
    damping = std::max(1e-6, 0.2 * damping);
    smoothing.converged = decrease <= kRelativeTolerance * objective;
  }
  for (int i = 0; i < problem.num_frames(); ++i) fits->parameters.row(problem.frame(i)) = y.row(i);
  return smoothing;
}

}  // namespace articap
