// SPDX-License-Identifier: MIT
#include "tests/tracking/dot_trial.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace articap {
namespace {

constexpr int kDotsPerSide = 10;
constexpr std::uint64_t kStream = 100;

struct TrialPicture {
  std::vector<PaintedDot> dots;
  Image image;
};

TrialPicture PaintTrial(const DotTrial& trial, RandomGenerator& random) {
  const int cell = static_cast<int>(std::ceil(4 * trial.dot.semi_axes_px.maxCoeff())) + 24;
  const int side = kDotsPerSide * cell;
  LightPicture light(side, side, trial.background);
  TrialPicture picture;
  for (int row = 0; row < kDotsPerSide; ++row)
    for (int column = 0; column < kDotsPerSide; ++column) {
      PaintedDot dot = trial.dot;
      const Eigen::Vector2d corner(column * cell, row * cell);
      dot.center_px = corner + Eigen::Vector2d::Constant(0.5 * cell) +
                      Eigen::Vector2d{random.Uniform(), random.Uniform()};
      if (trial.turns) dot.angle_rad = random.Uniform(0, std::numbers::pi);
      for (int y = row * cell; y < (row + 1) * cell; ++y)
        for (int x = column * cell; x < (column + 1) * cell; ++x)
          light.at(x, y) += trial.slope_per_px.dot(Eigen::Vector2d(x, y) - dot.center_px);
      light.Add(dot);
      picture.dots.push_back(dot);
    }
  picture.image = TakePicture(light, trial.sensor, random);
  return picture;
}

// Each dot to the nearest that was found.
void Compare(const std::vector<PaintedDot>& truth, const std::vector<Dot>& found,
             DotTrialResult& result) {
  int matched = 0;
  for (const PaintedDot& dot : truth) {
    const auto nearest =
        std::min_element(found.begin(), found.end(), [&](const Dot& a, const Dot& b) {
          return (a.center_px - dot.center_px).norm() < (b.center_px - dot.center_px).norm();
        });
    if (nearest == found.end() || (nearest->center_px - dot.center_px).norm() > 1) {
      ++result.missed;
      continue;
    }
    ++matched;
    result.samples.push_back({dot, *nearest, nearest->center_px - dot.center_px});
  }
  result.extra += static_cast<int>(found.size()) - matched;
}

}  // namespace

double DotTrialResult::rmse_px() const {
  double sum = 0;
  for (const Sample& sample : samples) sum += sample.error_px.squaredNorm();
  return std::sqrt(sum / (2.0 * static_cast<double>(samples.size())));
}

double DotTrialResult::rms_over_sigma() const {
  double sum = 0;
  for (const Sample& sample : samples)
    sum += sample.error_px.dot(sample.found.covariance_px2.inverse() * sample.error_px);
  return std::sqrt(sum / (2.0 * static_cast<double>(samples.size())));
}

double DotTrialResult::largest_phase_bias_px() const {
  constexpr int kBins = 10;
  double largest = 0;
  for (int axis = 0; axis < 2; ++axis) {
    std::array<double, kBins> sums{}, counts{};
    for (const Sample& sample : samples) {
      const double at = sample.truth.center_px[axis];
      const int bin = static_cast<int>(kBins * (at - std::floor(at)));
      sums[bin] += sample.error_px[axis];
      counts[bin] += 1;
    }
    for (int bin = 0; bin < kBins; ++bin)
      if (counts[bin] > 0) largest = std::max(largest, std::abs(sums[bin] / counts[bin]));
  }
  return largest;
}

double DotTrialResult::mean_diameter_px() const {
  double sum = 0;
  for (const Sample& sample : samples) sum += sample.found.diameter_px();
  return sum / static_cast<double>(samples.size());
}

double DotTrialResult::mean_misfit() const {
  double sum = 0;
  for (const Sample& sample : samples) sum += sample.found.misfit;
  return sum / static_cast<double>(samples.size());
}

DotTrialResult RunTrial(const DotTrial& trial, std::uint64_t seed) {
  RandomGenerator random(seed, kStream);
  DotDetector detector(trial.options);
  DotTrialResult result;
  for (int done = 0; done < trial.count; done += kDotsPerSide * kDotsPerSide) {
    const TrialPicture picture = PaintTrial(trial, random);
    Compare(picture.dots, detector.Detect(picture.image.view(), {}), result);
  }
  return result;
}

double BoundOf(const DotTrial& trial) {
  RandomGenerator random(1, kStream + 1);
  constexpr int kPlaces = 10;
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) {
    PaintedDot dot = trial.dot;
    dot.center_px = {random.Uniform(), random.Uniform()};
    if (trial.turns) dot.angle_rad = random.Uniform(0, std::numbers::pi);
    sum += CenterBound(dot, trial.background, !trial.slope_per_px.isZero(0), trial.sensor).trace();
  }
  return std::sqrt(sum / (2 * kPlaces));
}

}  // namespace articap
