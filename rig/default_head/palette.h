// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace articap::palette {

// sRGB, 0xRRGGBB
inline constexpr std::uint32_t kSkin = 0xd9a98c;
inline constexpr std::uint32_t kBlush = 0xd08f7c;
inline constexpr std::uint32_t kLips = 0xb86d66;
inline constexpr std::uint32_t kHair = 0x3a2920;
inline constexpr std::uint32_t kBrow = 0x4a352a;
inline constexpr std::uint32_t kLash = 0x33221d;
inline constexpr std::uint32_t kCaruncle = 0xc9837a;
inline constexpr std::uint32_t kSclera = 0xece7e2;
inline constexpr std::uint32_t kIris = 0x6a705c;
inline constexpr std::uint32_t kIrisRim = 0x2f3029;
inline constexpr std::uint32_t kPupil = 0x0a0808;
inline constexpr std::uint32_t kMouthInside = 0x6b2d2c;
inline constexpr std::uint32_t kThroat = 0x2a0d0d;
inline constexpr std::uint32_t kTooth = 0xeee6d6;
inline constexpr std::uint32_t kToothGap = 0xa58f78;
inline constexpr std::uint32_t kGum = 0xc06a6a;
inline constexpr std::uint32_t kTongue = 0xb85c5c;
inline constexpr std::uint32_t kSpectacles = 0x26262b;
inline constexpr std::uint32_t kSpectacleMarker = 0xe8e8e8;

}  // namespace articap::palette
