// SPDX-License-Identifier: MIT
#include "capture/audio_samples.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/frame.h>
#include <libavutil/samplefmt.h>
}

namespace articap::libav {

static_assert(std::endian::native == std::endian::little, "samples are written as they are");

std::optional<WavFormat> WavFormatOf(const AVCodecContext& codec, const AVFrame& frame) {
  using Kind = WavHeader::SampleKind;
  const auto format = [&](Kind kind, int bits) {
    return WavFormat{kind, bits, frame.ch_layout.nb_channels, frame.sample_rate};
  };
  switch (av_get_packed_sample_fmt(static_cast<AVSampleFormat>(frame.format))) {
    case AV_SAMPLE_FMT_U8:
    case AV_SAMPLE_FMT_S16:
      return format(Kind::kInteger, 16);
    case AV_SAMPLE_FMT_S32:
      return format(Kind::kInteger,
                    codec.bits_per_raw_sample > 0 && codec.bits_per_raw_sample <= 24 ? 24 : 32);
    case AV_SAMPLE_FMT_FLT:
      return format(Kind::kFloat, 32);
    case AV_SAMPLE_FMT_DBL:
      return format(Kind::kFloat, 64);
    default:
      return std::nullopt;
  }
}

std::string InterleavedBytes(const AVFrame& frame, const WavFormat& format, int first) {
  const auto sample_format = static_cast<AVSampleFormat>(frame.format);
  const bool is_planar = av_sample_fmt_is_planar(sample_format) != 0;
  const auto source_bytes = static_cast<std::size_t>(av_get_bytes_per_sample(sample_format));
  const auto bytes = static_cast<std::size_t>(format.bits / 8);
  std::string out;
  for (int i = first; i < frame.nb_samples; ++i)
    for (int channel = 0; channel < format.channels; ++channel) {
      const std::uint8_t* const plane = frame.extended_data[is_planar ? channel : 0];
      const auto at = static_cast<std::size_t>(is_planar ? i : i * format.channels + channel);
      const std::uint8_t* const sample = plane + at * source_bytes;
      if (source_bytes == 1) {  // counted from the middle
        out += '\0';
        out += static_cast<char>(*sample - 128);
        continue;
      }
      // Of 32 bits that hold 24, the upper ones.
      out.append(reinterpret_cast<const char*>(sample) + (source_bytes - bytes), bytes);
    }
  return out;
}

}  // namespace articap::libav
