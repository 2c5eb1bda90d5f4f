// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "tracking/simd_level.h"

namespace articap {

// What a row is compared with: the rows above and below at the same columns, and itself distance_x
// to both sides. All are readable from distance_x before `row` to distance_x and one vector (32
// bytes) behind row + width.
template <class Integer>
struct ScanRow {
  const Integer* row = nullptr;
  const Integer* above = nullptr;
  const Integer* below = nullptr;
  int width = 0;
  int distance_x = 0;
  Integer margin = 0;
};

// Sets bit x % 32 of word x / 32 where the pixel is brighter than at least three of the four by
// more than the margin; `words` has room for (width + 31) / 32. Bits beyond the width are 0.
template <class Integer>
void MarkOutstanding(const ScanRow<Integer>& row, SimdLevel level, std::uint32_t* words);

}  // namespace articap
