// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/check.h"

namespace articap {

// C3D files are made of blocks of 512 bytes, counted from 1.
inline constexpr std::size_t kC3dBlockBytes = 512;
inline constexpr std::uint8_t kC3dKey = 0x50;

// The processor whose numbers a C3D file holds, as its parameter section names it.
enum class C3dProcessor : std::uint8_t { kIntel = 84, kDec = 85, kMips = 86 };

// Numbers of a C3D file; offsets are in bytes and must lie inside.
class C3dBytes {
 public:
  C3dBytes(std::span<const std::byte> bytes, C3dProcessor processor)
      : bytes_(bytes), processor_(processor) {}

  std::size_t size() const { return bytes_.size(); }
  std::span<const std::byte> span() const { return bytes_; }
  C3dProcessor processor() const { return processor_; }

  std::uint8_t U8(std::size_t offset) const {
    return std::to_integer<std::uint8_t>(bytes_[offset]);
  }
  std::uint16_t U16(std::size_t offset) const {
    const unsigned first = U8(offset);
    const unsigned second = U8(offset + 1);
    return static_cast<std::uint16_t>(processor_ == C3dProcessor::kMips ? first << 8 | second
                                                                        : second << 8 | first);
  }
  std::int16_t I16(std::size_t offset) const { return static_cast<std::int16_t>(U16(offset)); }
  float F32(std::size_t offset) const {
    const std::uint32_t first = U16(offset);
    const std::uint32_t second = U16(offset + 2);
    if (processor_ == C3dProcessor::kIntel) return std::bit_cast<float>(second << 16 | first);
    const std::uint32_t bits = first << 16 | second;
    return processor_ == C3dProcessor::kMips ? std::bit_cast<float>(bits) : FromVax(bits);
  }

 private:
  // VAX F floating: (-1)^sign 0.1f 2^(exponent - 128), one quarter of what the same bits mean in
  // IEEE 754. Exponent 0 is zero, or with a sign "reserved", which becomes NaN; there are no
  // infinities.
  static float FromVax(std::uint32_t bits) {
    const std::uint32_t exponent = bits >> 23 & 0xFF;
    if (exponent == 0) return bits >> 31 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
    if (exponent < 255) return std::bit_cast<float>(bits) * 0.25F;
    const float mantissa = std::bit_cast<float>((bits & 0x807FFFFF) | 0x3F800000);
    return std::ldexp(mantissa, 126);
  }

  std::span<const std::byte> bytes_;
  C3dProcessor processor_;
};

}  // namespace articap
