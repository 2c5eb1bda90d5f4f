// SPDX-License-Identifier: MIT
#include "calib/corner_fit.h"

#include <ceres/tiny_solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace articap {
namespace {

struct Sample {
  Eigen::Vector2d from_expected_px;
  double brightness;
};

enum Parameter {
  kX,  // of the corner, from where it is expected, px
  kY,
  kAngle1,  // of the normal of the edge between columns, rad
  kAngle2,  // of the normal of the edge between rows
  kBlur,    // of the optics
  kBend1,   // half the edge's curvature, 1/px
  kBend2,
  kLevel,
  kLevelX,
  kLevelY,
  kAmplitude,
  kAmplitudeX,
  kAmplitudeY,
  kNumParameters
};
using Parameters = Eigen::Matrix<double, kNumParameters, 1>;
// Few pixels do not determine everything: up to here the edges are straight, and up to the other
// the light is even too.
constexpr int kPixelsForBends = 80;
constexpr int kPixelsForGradients = 40;
constexpr int kFewestPixels = 16;

// Pixels are squares: they blur by 1/12 px2, whatever the optics do.
double WithPixels(double optical_blur) { return std::sqrt(optical_blur * optical_blur + 1.0 / 12); }

// One edge at a pixel: the step across it, and its derivatives.
struct EdgeStep {
  double value;
  Eigen::Vector2d by_offset;
  double by_angle, by_bend, by_blur;
};

EdgeStep StepOf(const Eigen::Vector2d& offset_px, double angle, double bend, double optical_blur) {
  const double blur = WithPixels(optical_blur);
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle)), tangent(-normal.y(), normal.x());
  const double across = normal.dot(offset_px), along = tangent.dot(offset_px);
  const double scaled = (across + bend * along * along) / (std::numbers::sqrt2 * blur);
  const double slope = std::sqrt(2 / std::numbers::pi) / blur * std::exp(-scaled * scaled);
  return {.value = std::erf(scaled),
          .by_offset = slope * (normal + 2 * bend * along * tangent),
          .by_angle = slope * (along - 2 * bend * along * across),
          .by_bend = slope * along * along,
          .by_blur = -slope * std::numbers::sqrt2 * scaled * optical_blur / blur};
}

class CrossingEdges {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = kNumParameters };  // NOLINT: Ceres' names

  explicit CrossingEdges(const std::vector<Sample>& samples) : samples_(samples) {
    const int pixels = NumResiduals();
    has_gradients_ = pixels >= kPixelsForGradients;
    has_bends_ = pixels >= kPixelsForBends;
  }
  int NumResiduals() const { return static_cast<int>(samples_.size()); }
  int NumFree() const { return kNumParameters - (has_gradients_ ? 0 : 4) - (has_bends_ ? 0 : 2); }
  bool IsFree(int parameter) const {
    if (parameter == kBend1 || parameter == kBend2) return has_bends_;
    if (parameter == kLevelX || parameter == kLevelY || parameter == kAmplitudeX ||
        parameter == kAmplitudeY)
      return has_gradients_;
    return true;
  }

  bool operator()(const double* p, double* residuals, double* jacobian) const {
    for (int i = 0; i < NumResiduals(); ++i) {
      const Eigen::Vector2d offset = samples_[i].from_expected_px - Eigen::Vector2d(p[kX], p[kY]);
      const EdgeStep first = StepOf(offset, p[kAngle1], p[kBend1], p[kBlur]);
      const EdgeStep second = StepOf(offset, p[kAngle2], p[kBend2], p[kBlur]);
      const double amplitude =
          p[kAmplitude] + p[kAmplitudeX] * offset.x() + p[kAmplitudeY] * offset.y();
      const double cross = first.value * second.value;
      residuals[i] = p[kLevel] + p[kLevelX] * offset.x() + p[kLevelY] * offset.y() +
                     amplitude * cross - samples_[i].brightness;
      if (jacobian == nullptr) continue;
      Parameters row;
      row.head<2>() = -Eigen::Vector2d(p[kLevelX], p[kLevelY]) -
                      cross * Eigen::Vector2d(p[kAmplitudeX], p[kAmplitudeY]) -
                      amplitude * (first.by_offset * second.value + second.by_offset * first.value);
      row[kAngle1] = amplitude * first.by_angle * second.value;
      row[kAngle2] = amplitude * second.by_angle * first.value;
      row[kBlur] = amplitude * (first.by_blur * second.value + second.by_blur * first.value);
      row[kBend1] = amplitude * first.by_bend * second.value;
      row[kBend2] = amplitude * second.by_bend * first.value;
      row.segment<3>(kLevel) << 1, offset;
      row.segment<3>(kAmplitude) << cross, cross * offset;
      for (int k = 0; k < kNumParameters; ++k)
        jacobian[k * NumResiduals() + i] = IsFree(k) ? row[k] : 0;
    }
    return true;
  }

 private:
  const std::vector<Sample>& samples_;
  bool has_gradients_ = false;
  bool has_bends_ = false;
};

std::vector<Sample> SamplesOf(const GrayPicture& picture, const Eigen::Vector2d& center_px,
                              const CornerWindow& window) {
  const Eigen::Matrix2d squares_from_px = window.px_from_squares.inverse();
  const Eigen::Vector2d half =
      window.half_side_px > 0
          ? Eigen::Vector2d::Constant(window.half_side_px)
          : Eigen::Vector2d(window.reach * window.px_from_squares.cwiseAbs().rowwise().sum());
  const auto is_inside = [&](const Eigen::Vector2d& offset_px) {
    if (window.half_side_px > 0) return true;
    const Eigen::Array2d squares = (squares_from_px * offset_px).array().abs();
    return squares.maxCoeff() <= window.reach && squares.minCoeff() <= window.arm;
  };
  std::vector<Sample> samples;
  const int bottom = std::min(picture.height - 1, static_cast<int>(center_px.y() + half.y()));
  const int right = std::min(picture.width - 1, static_cast<int>(center_px.x() + half.x()));
  for (int y = std::max(0, static_cast<int>(std::ceil(center_px.y() - half.y()))); y <= bottom; ++y)
    for (int x = std::max(0, static_cast<int>(std::ceil(center_px.x() - half.x()))); x <= right;
         ++x) {
      const Eigen::Vector2d offset_px = Eigen::Vector2d(x, y) - center_px;
      if (is_inside(offset_px)) samples.push_back({offset_px, picture.at(x, y)});
    }
  return samples;
}

// Angle of the normal of the edge along `direction`, on the side of `ahead`.
double NormalAngle(const Eigen::Vector2d& direction, const Eigen::Vector2d& ahead) {
  const Eigen::Vector2d normal(-direction.y(), direction.x());
  const double side = normal.dot(ahead) < 0 ? -1 : 1;
  return std::atan2(side * normal.y(), side * normal.x());
}

// The levels follow from the edges' rough places by linear least squares.
Parameters Start(const std::vector<Sample>& samples, const Eigen::Matrix2d& px_from_squares,
                 double spacing_px) {
  Parameters start = Parameters::Zero();
  start[kAngle1] = NormalAngle(px_from_squares.col(1), px_from_squares.col(0));
  start[kAngle2] = NormalAngle(px_from_squares.col(0), px_from_squares.col(1));
  start[kBlur] = std::max(0.7, 0.05 * spacing_px);
  Eigen::Matrix2d normal_matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right_side = Eigen::Vector2d::Zero();
  for (const Sample& sample : samples) {
    const Eigen::Vector2d row(
        1, StepOf(sample.from_expected_px, start[kAngle1], 0, start[kBlur]).value *
               StepOf(sample.from_expected_px, start[kAngle2], 0, start[kBlur]).value);
    normal_matrix += row * row.transpose();
    right_side += sample.brightness * row;
  }
  const Eigen::Vector2d levels = normal_matrix.ldlt().solve(right_side);
  start[kLevel] = levels[0];
  start[kAmplitude] = levels[1];
  return start;
}

// The larger standard deviation of the corner's place.
double SigmaOf(const CrossingEdges& edges, const Parameters& parameters) {
  Eigen::VectorXd residuals(edges.NumResiduals());
  Eigen::Matrix<double, Eigen::Dynamic, kNumParameters> jacobian(edges.NumResiduals(),
                                                                 int{kNumParameters});
  edges(parameters.data(), residuals.data(), jacobian.data());
  Eigen::Matrix<double, kNumParameters, kNumParameters> information =
      jacobian.transpose() * jacobian;
  for (int k = 0; k < kNumParameters; ++k)
    if (!edges.IsFree(k)) information(k, k) = 1;
  const double variance =
      residuals.squaredNorm() / std::max(1, edges.NumResiduals() - edges.NumFree());
  const Eigen::Matrix2d covariance = variance * information.inverse().topLeftCorner<2, 2>();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[1]);
}

}  // namespace

std::optional<CornerFit> FitCorner(const GrayPicture& picture, const Eigen::Vector2d& expected_px,
                                   const CornerWindow& window) {
  const double spacing_px = window.px_from_squares.colwise().norm().minCoeff();
  // The window moves with the corner, until it stays within a pixel: some three times.
  constexpr int kMostMoves = 4;
  constexpr double kSettled_px = 0.3;
  Eigen::Vector2d center_px = expected_px;
  for (int move = 0; move < kMostMoves; ++move) {
    const std::vector<Sample> samples = SamplesOf(picture, center_px, window);
    if (static_cast<int>(samples.size()) < kFewestPixels) return std::nullopt;
    const CrossingEdges edges(samples);
    Parameters parameters = Start(samples, window.px_from_squares, spacing_px);
    ceres::TinySolver<CrossingEdges> solver;
    solver.options.max_num_iterations = 40;
    solver.Solve(edges, &parameters);
    const Eigen::Vector2d moved_px = parameters.head<2>();
    if (!parameters.allFinite() || moved_px.norm() > 0.25 * spacing_px) return std::nullopt;
    center_px += moved_px;
    if (moved_px.norm() > kSettled_px) continue;
    const double sigma_px = SigmaOf(edges, parameters);
    if (!std::isfinite(sigma_px)) return std::nullopt;
    // At the picture's border the four sides of a corner must be seen, beyond their blur.
    const Eigen::Vector2d inward_px = Eigen::Vector2d::Constant(3 * WithPixels(parameters[kBlur]));
    if (!picture.Contains(center_px - inward_px) || !picture.Contains(center_px + inward_px))
      return std::nullopt;
    return CornerFit{.point_px = center_px,
                     .sigma_px = sigma_px,
                     .blur_px = WithPixels(parameters[kBlur]),
                     .level = parameters[kLevel],
                     .amplitude = parameters[kAmplitude]};
  }
  return std::nullopt;
}

}  // namespace articap
