// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "core/wav_writer.h"

struct AVCodecContext;
struct AVFrame;

namespace articap::libav {

// The WAV format that keeps all that a decoder gives; nothing for samples that WAV does not hold.
std::optional<WavFormat> WavFormatOf(const AVCodecContext& codec, const AVFrame& frame);

// The frame's samples in that format, from sample `first` on: channels in turn, little-endian.
std::string InterleavedBytes(const AVFrame& frame, const WavFormat& format, int first);

}  // namespace articap::libav
