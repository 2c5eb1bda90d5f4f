// SPDX-License-Identifier: MIT
#include "core/wav_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>

#include "core/file_io.h"

namespace articap {
namespace {

// The size of a chunk that says: it stands in the chunk ds64 (RF64), or nobody knows (a stream).
constexpr std::int64_t kSizeElsewhere = 0xFFFFFFFF;

constexpr int kPcm = 1;
constexpr int kIeeeFloat = 3;
constexpr int kExtensible = 0xFFFE;
// Of an extensible format: what follows the coding in its GUID, in the order of the file.
constexpr std::array<unsigned char, 14> kGuidTail = {0x00, 0x00, 0x00, 0x00, 0x10, 0x00, 0x80,
                                                     0x00, 0x00, 0xAA, 0x00, 0x38, 0x9B, 0x71};

std::uint64_t LittleEndian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

struct Chunk {
  std::string id;
  std::int64_t start = 0;  // of its content
  std::int64_t size = 0;   // as the file says
};

class WavReader {
 public:
  WavReader(std::istream& stream, const std::string& source_name)
      : stream_(stream), source_name_(source_name) {
    stream_.seekg(0, std::ios::end);
    size_ = static_cast<std::int64_t>(stream_.tellg());
  }

  Result<WavHeader> Read() {
    const std::string start = BytesAt(0, 12);
    if (!LooksLikeWav(start))
      return Refused("is no WAV file: it does not begin with RIFF or RF64 and WAVE");
    is_rf64_ = start.starts_with("RF64");
    for (std::int64_t place = 12;;) {
      const std::optional<Chunk> chunk = ChunkAt(place);
      if (!chunk) return EndsEarly();
      if (chunk->id == "data") return Finish(*chunk);
      if (const Result<void> read = ReadChunk(*chunk); !read) return tl::unexpected(read.error());
      // Chunks begin at even places.
      place = chunk->start + chunk->size + chunk->size % 2;
    }
  }

 private:
  tl::unexpected<Error> Refused(const std::string& what) const {
    return Fail(fmt::format("{}: {}", source_name_, what));
  }

  tl::unexpected<Error> EndsEarly() const {
    return Refused(fmt::format("ends after {} bytes, before its {}; it was cut short", size_,
                               header_.channels > 0 ? "samples" : "format"));
  }

  // Fewer where the file ends.
  std::string BytesAt(std::int64_t place, std::size_t count) {
    std::string bytes(count, '\0');
    stream_.clear();
    stream_.seekg(place);
    stream_.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream_.gcount(), 0)));
    return bytes;
  }

  std::optional<Chunk> ChunkAt(std::int64_t place) {
    constexpr std::size_t kChunkHead = 8;
    if (place > size_) return std::nullopt;
    const std::string head = BytesAt(place, kChunkHead);
    if (head.size() < kChunkHead) return std::nullopt;
    return Chunk{head.substr(0, 4), place + static_cast<std::int64_t>(kChunkHead),
                 static_cast<std::int64_t>(LittleEndian(head, 4, 4))};
  }

  Result<void> ReadChunk(const Chunk& chunk) {
    if (chunk.id == "fmt ") return ReadFormat(chunk);
    if (chunk.id == "ds64" && is_rf64_) return ReadDs64(chunk);
    return {};
  }

  // The sizes of an RF64 file that 32 bits do not hold: the file's, the data's, the frames.
  Result<void> ReadDs64(const Chunk& chunk) {
    const std::string bytes = BytesAt(chunk.start, 16);
    if (chunk.size >= 16 && bytes.size() < 16) return EndsEarly();
    if (chunk.size < 16) return Refused("its chunk ds64 is too short to hold the size of the data");
    const std::uint64_t data_size = LittleEndian(bytes, 8, 8);
    if (data_size > static_cast<std::uint64_t>(INT64_MAX))
      return Refused(
          fmt::format("its chunk ds64 says {} bytes of data, which no file holds", data_size));
    data_size_ = static_cast<std::int64_t>(data_size);
    return {};
  }

  Result<void> ReadFormat(const Chunk& chunk) {
    constexpr std::int64_t kShortest = 16, kLongest = 40;
    const std::int64_t wanted = std::min(chunk.size, kLongest);
    if (wanted < kShortest)
      return Refused(fmt::format("its format has {} bytes, where at least {} are needed",
                                 chunk.size, kShortest));
    const std::string bytes = BytesAt(chunk.start, static_cast<std::size_t>(wanted));
    if (static_cast<std::int64_t>(bytes.size()) < wanted) return EndsEarly();
    const auto coding = CodingOf(bytes);
    if (!coding) return tl::unexpected(coding.error());
    header_.sample_kind =
        *coding == kPcm ? WavHeader::SampleKind::kInteger : WavHeader::SampleKind::kFloat;
    header_.channels = static_cast<int>(LittleEndian(bytes, 2, 2));
    header_.rate_hz = static_cast<std::int64_t>(LittleEndian(bytes, 4, 4));
    header_.bytes_per_frame = static_cast<int>(LittleEndian(bytes, 12, 2));
    header_.bits = static_cast<int>(LittleEndian(bytes, 14, 2));
    return CheckFormat();
  }

  Result<int> CodingOf(std::string_view format) const {
    int coding = static_cast<int>(LittleEndian(format, 0, 2));
    if (coding == kExtensible) {
      constexpr std::size_t kGuid = 24;
      if (format.size() < kGuid + 16)
        return Refused("its extensible format is too short to say how the samples are coded");
      if (std::memcmp(format.data() + kGuid + 2, kGuidTail.data(), kGuidTail.size()) != 0)
        return Refused("the coding of its samples is of a private kind; convert it to PCM");
      coding = static_cast<int>(LittleEndian(format, kGuid, 2));
    }
    if (coding != kPcm && coding != kIeeeFloat)
      return Refused(fmt::format(
          "its samples are coded as format {:#06x}; PCM and IEEE float are read, convert it to one "
          "of these",
          coding));
    return coding;
  }

  Result<void> CheckFormat() const {
    if (header_.channels == 0) return Refused("its format says 0 channels");
    if (header_.rate_hz == 0) return Refused("its format says 0 samples a second");
    const bool is_float = header_.sample_kind == WavHeader::SampleKind::kFloat;
    const bool bits_exist = is_float ? header_.bits == 32 || header_.bits == 64
                                     : 1 <= header_.bits && header_.bits <= 32;
    if (!bits_exist)
      return Refused(fmt::format("its format says {} samples of {} bits",
                                 is_float ? "float" : "integer", header_.bits));
    const int bytes_per_sample = (header_.bits + 7) / 8;
    if (header_.bytes_per_frame != header_.channels * bytes_per_sample)
      return Refused(fmt::format(
          "its format contradicts itself: {} channels of {} bits do not make frames of {} bytes",
          header_.channels, header_.bits, header_.bytes_per_frame));
    return {};
  }

  Result<WavHeader> Finish(const Chunk& data) {
    if (header_.channels == 0) return Refused("its samples begin before its format is said");
    header_.data_start = data.start;
    const std::int64_t there = size_ - data.start;
    std::int64_t promised = data.size;
    if (promised == kSizeElsewhere && is_rf64_) {
      if (!data_size_) return Refused("is RF64 without the chunk ds64 that says its size");
      promised = *data_size_;
    } else if (promised == kSizeElsewhere) {
      header_.warnings.push_back(
          fmt::format("{}: the header does not say how many samples there are, as when a program "
                      "writes to a pipe; all to the end of the file are taken",
                      source_name_));
      promised = there;
    }
    header_.frames = std::min(promised, there) / header_.bytes_per_frame;
    WarnOfLostFrames(promised, there);
    return std::move(header_);
  }

  void WarnOfLostFrames(std::int64_t promised, std::int64_t there) {
    if (promised > there)
      header_.warnings.push_back(
          fmt::format("{}: ends early, with {} of the {} frames that its header promises",
                      source_name_, header_.frames, promised / header_.bytes_per_frame));
    else if (promised % header_.bytes_per_frame != 0)
      header_.warnings.push_back(
          fmt::format("{}: the last frame of its samples is not whole", source_name_));
    if (promised == 0 && there > header_.bytes_per_frame)
      header_.warnings.push_back(fmt::format(
          "{}: the header says 0 samples, but {} bytes follow: the program that recorded it may "
          "not have come to its end",
          source_name_, there));
  }

  std::istream& stream_;
  const std::string& source_name_;
  std::int64_t size_ = 0;  // of the file
  bool is_rf64_ = false;
  std::optional<std::int64_t> data_size_;  // from ds64
  WavHeader header_;
};

}  // namespace

bool LooksLikeWav(std::string_view bytes) {
  return bytes.size() >= 12 && (bytes.starts_with("RIFF") || bytes.starts_with("RF64")) &&
         bytes.substr(8, 4) == "WAVE";
}

Result<WavHeader> ParseWavHeader(std::istream& stream, const std::string& source_name) {
  return WavReader(stream, source_name).Read();
}

Result<WavHeader> ReadWavHeader(const std::filesystem::path& path) {
  Result<std::ifstream> stream = OpenFile(path);
  if (!stream) return tl::unexpected(stream.error());
  return ParseWavHeader(*stream, path.string());
}

}  // namespace articap
