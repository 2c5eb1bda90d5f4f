// SPDX-License-Identifier: MIT
#include "core/wav_writer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/check.h"
#include "core/file_io.h"

namespace articap {
namespace {

void AppendLittleEndian(std::string& bytes, std::int64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
}

// The format in its extensible form, which more than two channels or 16 bits ask for.
std::string FormatChunk(const WavFormat& format) {
  constexpr int kPcm = 1, kIeeeFloat = 3, kExtensible = 0xFFFE;
  constexpr std::string_view kGuidTail("\x00\x00\x00\x00\x10\x00\x80\x00\x00\xAA\x00\x38\x9B\x71",
                                       14);
  const int coding = format.sample_kind == WavHeader::SampleKind::kFloat ? kIeeeFloat : kPcm;
  const bool plain = coding == kPcm && format.bits == 16 && format.channels <= 2;
  std::string chunk = "fmt ";
  AppendLittleEndian(chunk, plain ? 16 : 40, 4);
  AppendLittleEndian(chunk, plain ? coding : kExtensible, 2);
  AppendLittleEndian(chunk, format.channels, 2);
  AppendLittleEndian(chunk, format.rate_hz, 4);
  AppendLittleEndian(chunk, format.rate_hz * format.bytes_per_frame(), 4);
  AppendLittleEndian(chunk, format.bytes_per_frame(), 2);
  AppendLittleEndian(chunk, format.bits, 2);
  if (plain) return chunk;
  AppendLittleEndian(chunk, 22, 2);  // what follows
  AppendLittleEndian(chunk, format.bits, 2);
  AppendLittleEndian(chunk, 0, 4);  // no loudspeakers are named
  AppendLittleEndian(chunk, coding, 2);
  return chunk.append(kGuidTail);
}

}  // namespace

Result<WavWriter> WavWriter::Create(const std::filesystem::path& path, const WavFormat& format,
                                    std::int64_t largest_riff_bytes) {
  const bool is_float = format.sample_kind == WavHeader::SampleKind::kFloat;
  ARTICAP_CHECK(format.bits == 32 || format.bits == (is_float ? 64 : 16) ||
                (format.bits == 24 && !is_float));
  ARTICAP_CHECK_GT(format.channels, 0);
  WavWriter writer;
  writer.path_ = path;
  writer.temporary_ = path;
  writer.temporary_ += fmt::format(".{}.part", ::getpid());
  writer.format_ = format;
  writer.largest_riff_bytes_ = largest_riff_bytes;
  writer.stream_.open(writer.temporary_, std::ios::binary | std::ios::trunc);
  writer.stream_ << writer.Header();
  if (!writer.stream_) return writer.CannotWrite();
  return writer;
}

WavWriter::WavWriter(WavWriter&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      format_(other.format_),
      largest_riff_bytes_(other.largest_riff_bytes_),
      stream_(std::move(other.stream_)),
      data_bytes_(other.data_bytes_) {}

WavWriter::~WavWriter() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

// A place for the sizes of RF64 is always kept (EBU Tech 3306).
std::string WavWriter::Header() const {
  constexpr int kDs64Bytes = 28;
  const std::string format = FormatChunk(format_);
  const auto riff_bytes = static_cast<std::int64_t>(4 + 8 + kDs64Bytes + format.size() + 12 + 8) +
                          data_bytes_ + data_bytes_ % 2;
  const bool is_rf64 = riff_bytes > largest_riff_bytes_;
  std::string header = is_rf64 ? "RF64" : "RIFF";
  AppendLittleEndian(header, is_rf64 ? kLargestRiff_bytes : riff_bytes, 4);
  header += is_rf64 ? "WAVEds64" : "WAVEJUNK";
  AppendLittleEndian(header, kDs64Bytes, 4);
  AppendLittleEndian(header, is_rf64 ? riff_bytes : 0, 8);
  AppendLittleEndian(header, is_rf64 ? data_bytes_ : 0, 8);
  AppendLittleEndian(header, is_rf64 ? num_frames() : 0, 8);
  AppendLittleEndian(header, 0, 4);
  header += format + "fact";
  AppendLittleEndian(header, 4, 4);
  AppendLittleEndian(header, is_rf64 ? kLargestRiff_bytes : num_frames(), 4);
  header += "data";
  AppendLittleEndian(header, is_rf64 ? kLargestRiff_bytes : data_bytes_, 4);
  return header;
}

tl::unexpected<Error> WavWriter::CannotWrite() const {
  return Fail(
      fmt::format("{}: cannot be written; check the folder's rights and the free space of the disk",
                  path_.string()));
}

Result<void> WavWriter::Write(std::string_view frames) {
  ARTICAP_CHECK_EQ(frames.size() % static_cast<std::size_t>(format_.bytes_per_frame()), 0U);
  stream_.write(frames.data(), static_cast<std::streamsize>(frames.size()));
  if (!stream_) return CannotWrite();
  data_bytes_ += static_cast<std::int64_t>(frames.size());
  return {};
}

Result<void> WavWriter::WriteSilence(std::int64_t num_frames) {
  constexpr std::int64_t kPiece = 1 << 14;
  while (num_frames > 0) {
    const std::int64_t piece = std::min(num_frames, kPiece);
    const std::string zeros(static_cast<std::size_t>(piece * format_.bytes_per_frame()), '\0');
    if (auto written = Write(zeros); !written) return written;
    num_frames -= piece;
  }
  return {};
}

Result<void> WavWriter::Finish() {
  if (data_bytes_ % 2 != 0) stream_.put('\0');
  stream_.seekp(0);
  stream_ << Header();
  stream_.close();
  if (!stream_ || !SyncFile(temporary_)) return CannotWrite();
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) return CannotWrite();
  temporary_.clear();
  return {};
}

}  // namespace articap
