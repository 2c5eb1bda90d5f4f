// SPDX-License-Identifier: MIT
#include "synthetic/random.h"

#include <cmath>

#include "core/check.h"

namespace articap {
namespace {

// Sebastiano Vigna's SplitMix64: neighbouring seeds and streams become unrelated states.
std::uint64_t SplitMix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

RandomGenerator::RandomGenerator(std::uint64_t seed, std::uint64_t stream)
    : engine_(SplitMix64(SplitMix64(seed) + stream)) {}

double RandomGenerator::Uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

int RandomGenerator::Index(int count) {
  ARTICAP_CHECK_GT(count, 0);
  return static_cast<int>(Uniform() * count);
}

double RandomGenerator::Normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  double x = 0, y = 0, square = 0;
  do {
    x = Uniform(-1, 1);
    y = Uniform(-1, 1);
    square = x * x + y * y;
  } while (square >= 1 || square == 0);
  const double factor = std::sqrt(-2 * std::log(square) / square);
  spare_normal_ = y * factor;
  has_spare_normal_ = true;
  return x * factor;
}

int RandomGenerator::Poisson(double mean) {
  ARTICAP_CHECK(mean >= 0 && mean <= 1e9);
  // Below this the products of few uniform numbers are quickest (Knuth).
  constexpr double kFew = 10;
  if (mean < kFew) {
    int count = 0;
    for (double product = Uniform(); product > std::exp(-mean); product *= Uniform()) ++count;
    return count;
  }
  // W. Hörmann, "The transformed rejection method for generating Poisson random variables",
  // Insurance: Mathematics and Economics 12, 1993: algorithm PTRS, with its names and constants.
  const double b = 0.931 + 2.53 * std::sqrt(mean);
  const double a = -0.059 + 0.02483 * b;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
  const double v_r = 0.9277 - 3.6224 / (b - 2);
  for (;;) {
    const double u = Uniform() - 0.5;
    const double v = 1 - Uniform();  // never 0
    const double u_s = 0.5 - std::abs(u);
    const double k = std::floor((2 * a / u_s + b) * u + mean + 0.43);
    if (u_s >= 0.07 && v <= v_r) return static_cast<int>(k);
    if (k < 0 || (u_s < 0.013 && v > u_s)) continue;
    if (std::log(v * inverse_alpha / (a / (u_s * u_s) + b)) <=
        k * std::log(mean) - mean - std::lgamma(k + 1))
      return static_cast<int>(k);
  }
}

Eigen::Vector3d RandomGenerator::NormalVector() {
  const double x = Normal();
  const double y = Normal();
  const double z = Normal();
  return {x, y, z};
}

Eigen::Vector3d RandomGenerator::Direction() { return NormalVector().normalized(); }

}  // namespace articap
