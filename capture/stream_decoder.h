// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "capture/libav.h"
#include "core/result.h"

namespace articap::libav {

enum class StreamKind : std::uint8_t { kVideo, kAudio };

// The decoded frames of one stream, in the order in which they are shown.
class StreamDecoder {
 public:
  // `strict`: damage is an error, for pictures, rather than a frame that is marked.
  static Result<std::unique_ptr<StreamDecoder>> Open(
      const std::vector<std::filesystem::path>& pieces, StreamKind kind, bool strict = false);

  // Whether there is another frame. A failure is one of decoding or of reading; asking again goes
  // on behind it.
  Result<bool> Next();

  // What is decoded from the beginning on is kept, up to so many bytes, until Restart() gives it
  // again. To be called before the first Next().
  void KeepForRestart(std::size_t most_bytes);
  // Back to the beginning; false where that was not kept, or was faulty.
  bool Restart();

  const AVFrame& frame() const { return *frame_; }
  bool is_corrupt() const;  // this frame
  // On the clock of the file; nothing where the file does not say.
  std::optional<std::chrono::nanoseconds> time() const;
  // How finely the file's times are told apart.
  std::chrono::nanoseconds tick() const;

  Input& input() { return *input_; }
  const AVStream& stream() const { return *stream_; }
  const AVCodecContext& codec() const { return *codec_; }

 private:
  StreamDecoder() = default;
  Result<bool> Decode();
  void Keep();
  void KeepNothing();
  // Hands the decoder its next packet, or that there is none.
  Result<void> Feed();
  // Whether the packet is known to be damaged, which the decoder does not tell.
  bool PacketIsDamaged();

  std::unique_ptr<Input> input_;
  AVStream* stream_ = nullptr;
  Owner<AVCodecContext> codec_;
  Owner<AVFrame> frame_;
  Owner<AVPacket> packet_;
  bool has_checksums_ = false;            // FFV1 whose slices were whole
  std::set<std::int64_t> damaged_times_;  // of packets, as they are shown
  std::deque<Owner<AVFrame>> kept_;
  bool keeps_ = false;
  std::size_t room_bytes_ = 0;
};

}  // namespace articap::libav
