// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <vector>

namespace articap {

// Random numbers that are the same everywhere: the standard fixes std::mt19937_64 to the bit, but
// not its distributions. `stream` separates the uses of one seed (speech, head motion, noise, ...),
// so that changing how one is drawn leaves the others as they were.
class RandomGenerator {
 public:
  RandomGenerator(std::uint64_t seed, std::uint64_t stream);

  double Uniform();  // in [0, 1), 53 bits
  double Uniform(double min, double max) { return min + (max - min) * Uniform(); }
  bool Happens(double probability) { return Uniform() < probability; }
  int Index(int count);      // 0 .. count - 1
  double Normal();           // mean 0, SD 1 (Marsaglia's polar method)
  int Poisson(double mean);  // mean at most 1e9
  Eigen::Vector3d NormalVector();
  Eigen::Vector3d Direction();  // uniform on the unit sphere

  // Fisher-Yates.
  template <class T>
  void Shuffle(std::vector<T>& items) {
    for (int i = static_cast<int>(items.size()) - 1; i > 0; --i)
      std::swap(items[i], items[Index(i + 1)]);
  }

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0;
  bool has_spare_normal_ = false;
};

}  // namespace articap
