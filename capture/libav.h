// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"

struct AVCodecContext;
struct AVFormatContext;
struct AVFrame;
struct AVIOContext;
struct AVPacket;
struct AVStream;
struct SwsContext;

// libav (FFmpeg) with owners. For the sources of this folder alone: what others include of it shows
// nothing of libav.
namespace articap::libav {

struct Free {
  void operator()(AVCodecContext* context) const;
  void operator()(AVFormatContext* context) const;
  void operator()(AVFrame* frame) const;
  void operator()(AVIOContext* context) const;
  void operator()(AVPacket* packet) const;
  void operator()(SwsContext* context) const;
};
template <class T>
using Owner = std::unique_ptr<T, Free>;

// Keeps libav from printing: what matters comes as errors and notes.
void SilenceMessages();

// What libav's error code means, in its words.
std::string ErrorText(int code);

class ByteSource;

// A file that was opened and whose streams are known, or several whose bytes follow one another.
// Opened by content alone: a name never decides how a file is read, and nothing that a file may
// refer to, such as the parts of a playlist, is opened.
class Input {
 public:
  static Result<std::unique_ptr<Input>> Open(const std::vector<std::filesystem::path>& pieces);
  ~Input();
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  const std::string& name() const { return name_; }  // of the first file, for messages
  AVFormatContext& format() { return *format_; }
  bool is_picture() const;  // by its format: PNG, JPEG, ...
  // Whose files are cut anywhere, and go on in the next as if they were one.
  bool is_transport_stream() const;
  // The stream that shows moving pictures, or sounds; null where there is none.
  AVStream* video_stream() const;
  AVStream* audio_stream() const;
  int num_audio_streams() const;

 private:
  Input();

  std::string name_;
  // In the order in which they are made; what comes later refers to what comes before.
  std::unique_ptr<ByteSource> bytes_;
  Owner<AVIOContext> io_;
  Owner<AVFormatContext> format_;
};

}  // namespace articap::libav
