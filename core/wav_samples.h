// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "core/result.h"
#include "core/wav_header.h"

namespace articap {

// Hands the samples of one channel (from 0), full scale being 1, to `take`, a piece at a time: a
// recording may be longer than memory. The header is the file's own.
Result<void> ReadWavChannel(const std::filesystem::path& path, const WavHeader& header, int channel,
                            const std::function<void(std::span<const float>)>& take);

}  // namespace articap
