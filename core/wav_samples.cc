// SPDX-License-Identifier: MIT
#include "core/wav_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/file_io.h"

namespace articap {
namespace {

std::uint64_t LittleEndian(const char* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = count; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
  return value;
}

float SampleAt(const char* bytes, const WavHeader& header) {
  const int count = (header.bits + 7) / 8;
  const std::uint64_t value = LittleEndian(bytes, count);
  if (header.sample_kind == WavHeader::SampleKind::kFloat)
    return count == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(value))
                      : static_cast<float>(std::bit_cast<double>(value));
  // Samples of up to 8 bits are counted from the middle, all others have a sign. Fewer bits than
  // bytes hold stand at the upper end.
  if (count == 1) return (static_cast<float>(value) - 128.0F) / 128.0F;
  const auto shifted =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(value) << (32 - 8 * count));
  return static_cast<float>(shifted) / 2147483648.0F;
}

}  // namespace

Result<void> ReadWavChannel(const std::filesystem::path& path, const WavHeader& header, int channel,
                            const std::function<void(std::span<const float>)>& take) {
  ARTICAP_CHECK(0 <= channel && channel < header.channels);
  Result<std::ifstream> stream = OpenFile(path);
  if (!stream) return tl::unexpected(stream.error());
  stream->seekg(header.data_start);
  constexpr std::int64_t kPiece = 1 << 14;
  const int offset = channel * (header.bytes_per_frame / header.channels);
  std::string bytes;
  std::vector<float> samples;
  for (std::int64_t left = header.frames; left > 0;) {
    const std::int64_t frames = std::min(left, kPiece);
    bytes.resize(static_cast<std::size_t>(frames * header.bytes_per_frame));
    if (!stream->read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
      return Fail(fmt::format("{}: reading its samples failed half-way", path.string()));
    samples.resize(static_cast<std::size_t>(frames));
    for (std::int64_t i = 0; i < frames; ++i)
      samples[static_cast<std::size_t>(i)] =
          SampleAt(bytes.data() + i * header.bytes_per_frame + offset, header);
    take(samples);
    left -= frames;
  }
  return {};
}

}  // namespace articap
