// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/result.h"
#include "core/wav_header.h"

namespace articap {

struct WavFormat {
  WavHeader::SampleKind sample_kind = WavHeader::SampleKind::kInteger;
  int bits = 16;  // 16, 24 or 32; of float 32 or 64
  int channels = 1;
  std::int64_t rate_hz = 48000;

  int bytes_per_frame() const { return channels * bits / 8; }
};

// Writes a WAV file a piece at a time, beside its place under a temporary name until it is
// finished; nothing is left where it is not. RIFF, or RF64 where its size needs more than 32 bits.
class WavWriter {
 public:
  static constexpr std::int64_t kLargestRiff_bytes = 0xFFFFFFFF;

  // `largest_riff_bytes`: from which size on it is RF64; for tests.
  static Result<WavWriter> Create(const std::filesystem::path& path, const WavFormat& format,
                                  std::int64_t largest_riff_bytes = kLargestRiff_bytes);
  ~WavWriter();
  WavWriter(WavWriter&& other) noexcept;
  WavWriter& operator=(WavWriter&&) = delete;

  // Whole frames: a sample of every channel, little-endian.
  Result<void> Write(std::string_view frames);
  Result<void> WriteSilence(std::int64_t num_frames);
  // Completes the header and moves the file, once it is on the disk, to its place.
  Result<void> Finish();

  const WavFormat& format() const { return format_; }
  std::int64_t num_frames() const { return data_bytes_ / format_.bytes_per_frame(); }

 private:
  WavWriter() = default;
  std::string Header() const;
  tl::unexpected<Error> CannotWrite() const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;  // empty once the file is in its place, or another's
  WavFormat format_;
  std::int64_t largest_riff_bytes_ = kLargestRiff_bytes;
  std::ofstream stream_;
  std::int64_t data_bytes_ = 0;
};

}  // namespace articap
