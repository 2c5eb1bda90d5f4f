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

Eigen::Vector3d RandomGenerator::NormalVector() {
  const double x = Normal();
  const double y = Normal();
  const double z = Normal();
  return {x, y, z};
}

Eigen::Vector3d RandomGenerator::Direction() { return NormalVector().normalized(); }

}  // namespace articap
