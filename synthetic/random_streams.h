// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

// The uses of a seed; see RandomGenerator.
namespace articap::random_streams {

inline constexpr std::uint64_t kText = 1;
inline constexpr std::uint64_t kArticulation = 2;
inline constexpr std::uint64_t kIdentity = 3;
inline constexpr std::uint64_t kHeadMotion = 4;
inline constexpr std::uint64_t kAttachment = 5;
inline constexpr std::uint64_t kStage = 6;
inline constexpr std::uint64_t kNoise = 7;
inline constexpr std::uint64_t kDropouts = 8;
inline constexpr std::uint64_t kOutliers = 9;
inline constexpr std::uint64_t kSwaps = 10;
inline constexpr std::uint64_t kGaps = 11;
inline constexpr std::uint64_t kSensor = 12;
inline constexpr std::uint64_t kCameras = 13;
inline constexpr std::uint64_t kBoardPoses = 14;
inline constexpr std::uint64_t kWandPath = 15;
inline constexpr std::uint64_t kClocks = 16;

}  // namespace articap::random_streams
