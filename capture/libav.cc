// SPDX-License-Identifier: MIT
#include "capture/libav.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <mutex>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/file_io.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace articap::libav {

void Free::operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
void Free::operator()(AVFormatContext* context) const { avformat_close_input(&context); }
void Free::operator()(AVFrame* frame) const { av_frame_free(&frame); }
void Free::operator()(AVPacket* packet) const { av_packet_free(&packet); }
void Free::operator()(SwsContext* context) const { sws_freeContext(context); }

void Free::operator()(AVIOContext* context) const {
  av_freep(&context->buffer);
  avio_context_free(&context);
}

void SilenceMessages() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_level(AV_LOG_QUIET); });
}

std::string ErrorText(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return text.data();
}

// Files as one row of bytes.
class ByteSource {
 public:
  static Result<std::unique_ptr<ByteSource>> Open(const std::vector<std::filesystem::path>& paths) {
    auto source = std::make_unique<ByteSource>();
    for (const std::filesystem::path& path : paths) {
      Result<std::ifstream> stream = OpenFile(path);
      if (!stream) return tl::unexpected(stream.error());
      std::error_code error;
      const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
      if (error || size == 0)
        return Fail(fmt::format("{}: {}", path.string(),
                                error ? "is no file that can be read; check the path"
                                      : "is empty; its recording was lost, take it out"));
      source->files_.push_back({*std::move(stream), source->size_, size});
      source->size_ += size;
    }
    return source;
  }

  static int Read(void* self, std::uint8_t* out, int count) {
    return static_cast<ByteSource*>(self)->ReadHere(out, count);
  }
  static std::int64_t Seek(void* self, std::int64_t offset, int whence) {
    return static_cast<ByteSource*>(self)->SeekTo(offset, whence);
  }

 private:
  struct File {
    std::ifstream stream;
    std::int64_t start = 0;
    std::int64_t size = 0;
  };

  int ReadHere(std::uint8_t* out, int count) {
    for (File& file : files_) {
      const std::int64_t place = position_ - file.start;
      if (place < 0 || place >= file.size) continue;
      file.stream.clear();
      file.stream.seekg(place);
      file.stream.read(reinterpret_cast<char*>(out),
                       std::min<std::int64_t>(count, file.size - place));
      const auto got = static_cast<int>(file.stream.gcount());
      position_ += got;
      return got > 0 ? got : AVERROR(EIO);
    }
    return AVERROR_EOF;
  }

  std::int64_t SeekTo(std::int64_t offset, int whence) {
    switch (whence & ~AVSEEK_FORCE) {
      case AVSEEK_SIZE:
        return size_;
      case SEEK_CUR:
        offset += position_;
        break;
      case SEEK_END:
        offset += size_;
        break;
      default:
        break;
    }
    if (offset < 0) return AVERROR(EINVAL);
    return position_ = offset;
  }

  std::vector<File> files_;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
};

namespace {

// Formats of text that libav would draw as if it were a film.
bool IsDrawnText(const AVInputFormat& format) {
  const std::string_view name = format.name;
  return name == "tty" || name == "bin" || name == "xbin" || name == "adf" || name == "idf";
}

AVStream* StreamOf(AVFormatContext& format, AVMediaType type) {
  const int index = av_find_best_stream(&format, type, -1, -1, nullptr, 0);
  if (index < 0) return nullptr;
  AVStream* const stream = format.streams[index];
  const bool is_cover = (stream->disposition & AV_DISPOSITION_ATTACHED_PIC) != 0;
  return is_cover ? nullptr : stream;
}

}  // namespace

Input::Input() = default;
Input::~Input() = default;

Result<std::unique_ptr<Input>> Input::Open(const std::vector<std::filesystem::path>& pieces) {
  SilenceMessages();
  std::unique_ptr<Input> input(new Input);
  input->name_ = pieces.front().string();
  auto bytes = ByteSource::Open(pieces);
  if (!bytes) return tl::unexpected(bytes.error());
  input->bytes_ = *std::move(bytes);
  constexpr int kBufferBytes = 1 << 16;
  auto* const buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
  input->io_.reset(avio_alloc_context(buffer, kBufferBytes, 0, input->bytes_.get(),
                                      ByteSource::Read, nullptr, ByteSource::Seek));
  AVFormatContext* format = avformat_alloc_context();
  format->pb = input->io_.get();
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "none", 0);
  const int opened = avformat_open_input(&format, nullptr, nullptr, &options);
  av_dict_free(&options);
  if (opened < 0)  // libav has freed the context
    return Fail(
        fmt::format("{}: is no picture, video or sound that can be read ({}); if its end "
                    "was lost, an index at the end is lost with it",
                    input->name_, ErrorText(opened)));
  input->format_.reset(format);
  if (IsDrawnText(*format->iformat))
    return Fail(fmt::format("{}: is a text; name a picture, a video or a sound", input->name_));
  if (const int found = avformat_find_stream_info(format, nullptr); found < 0)
    return Fail(fmt::format("{}: its streams cannot be read ({}); the file is damaged",
                            input->name_, ErrorText(found)));
  return input;
}

bool Input::is_picture() const {
  const std::string_view name = format_->iformat->name;
  return name.ends_with("_pipe") || name == "image2";
}

bool Input::is_transport_stream() const {
  return std::string_view(format_->iformat->name) == "mpegts";
}

AVStream* Input::video_stream() const { return StreamOf(*format_, AVMEDIA_TYPE_VIDEO); }
AVStream* Input::audio_stream() const { return StreamOf(*format_, AVMEDIA_TYPE_AUDIO); }

int Input::num_audio_streams() const {
  int count = 0;
  for (unsigned i = 0; i < format_->nb_streams; ++i)
    count += format_->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_AUDIO;
  return count;
}

}  // namespace articap::libav
