// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace articap {

// Vector instructions; each has those before it.
enum class SimdLevel : std::uint8_t { kNone, kSse41, kAvx2 };

// The best that this processor and this build have.
SimdLevel BestSimdLevel();
const char* NameOf(SimdLevel level);

}  // namespace articap
