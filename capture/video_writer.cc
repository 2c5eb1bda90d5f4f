// SPDX-License-Identifier: MIT
#include "capture/video_writer.h"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "capture/libav.h"
#include "core/check.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace articap {
namespace {

constexpr int kNoColor = 128;

AVPixelFormat PixelsOf(const VideoFormat& format) {
  if (format.codec == VideoCodec::kH264) return AV_PIX_FMT_YUV420P;
  return format.pixels == PixelFormat::kGray16 ? AV_PIX_FMT_GRAY16 : AV_PIX_FMT_GRAY8;
}

Result<void> CheckFormat(const std::string& name, const VideoFormat& format) {
  if (format.width <= 0 || format.height <= 0 || format.rate.frames <= 0 ||
      format.rate.seconds <= 0)
    return Fail(fmt::format("{}: a video of {} x {} pixels at {}/{} Hz cannot be written", name,
                            format.width, format.height, format.rate.frames, format.rate.seconds));
  if (format.codec == VideoCodec::kFfv1) {
    if (format.pixels == PixelFormat::kRgb8)
      return Fail(fmt::format("{}: lossless video is written in grey alone", name));
    if (format.container == VideoContainer::kMatroska) return {};
    return Fail(fmt::format("{}: lossless video (FFV1) goes into Matroska (.mkv)", name));
  }
  if (format.pixels == PixelFormat::kGray16)
    return Fail(fmt::format("{}: H.264 holds 8 bits; choose FFV1 for 16", name));
  if (format.width % 2 != 0 || format.height % 2 != 0)
    return Fail(
        fmt::format("{}: H.264 wants even sizes, not {} x {} pixels; choose another size, "
                    "or FFV1",
                    name, format.width, format.height));
  if (!(format.crf >= 0 && format.crf <= 51))
    return Fail(
        fmt::format("{}: the quality (crf) of H.264 is {}; it must be between 0 (best) "
                    "and 51",
                    name, format.crf));
  return {};
}

}  // namespace

VideoRate ClosestRate(double rate_hz) {
  const AVRational rate = av_d2q(rate_hz, 1001000);
  return {rate.num, rate.den};
}

class VideoWriter::Output {
 public:
  Output(const std::filesystem::path& path, const VideoFormat& format)
      : path_(path), name_(path.string()), format_(format) {}
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  ~Output() {
    if (muxer_ == nullptr) return;
    avio_closep(&muxer_->pb);
    avformat_free_context(muxer_);
    std::error_code ignored;
    if (!finished_ && !was_there_) std::filesystem::remove(path_, ignored);
  }

  Result<void> Open() {
    libav::SilenceMessages();
    if (auto opened = OpenEncoder(); !opened) return opened;
    std::error_code ignored;
    was_there_ = std::filesystem::exists(path_, ignored);
    const bool is_mp4 = format_.container == VideoContainer::kMp4;
    if (avformat_alloc_output_context2(&muxer_, nullptr, is_mp4 ? "mp4" : "matroska", nullptr) < 0)
      return Fail(
          fmt::format("{}: this FFmpeg cannot write {}", name_, is_mp4 ? "MP4" : "Matroska"));
    muxer_->flags |= AVFMT_FLAG_BITEXACT;
    stream_ = avformat_new_stream(muxer_, nullptr);
    ARTICAP_CHECK(stream_ != nullptr);
    stream_->time_base = encoder_->time_base;
    stream_->avg_frame_rate = encoder_->framerate;
    avcodec_parameters_from_context(stream_->codecpar, encoder_.get());
    if (const int code = avio_open(&muxer_->pb, ("file:" + name_).c_str(), AVIO_FLAG_WRITE);
        code < 0) {
      was_there_ = true;  // nothing was made
      return FailWith("cannot be opened for writing", code);
    }
    if (const int code = avformat_write_header(muxer_, nullptr); code < 0)
      return FailWith("cannot be begun", code);
    return {};
  }

  Result<void> Write(const ImageView& image) {
    ARTICAP_CHECK(image.format == format_.pixels && image.width == format_.width &&
                  image.height == format_.height);
    if (auto made = MakeFrame(); !made) return made;
    if (image.format == PixelFormat::kRgb8)
      CopyColor(image);
    else
      CopyGrey(image);
    frame_->pts = num_frames_++;
    return Encode(frame_.get());
  }

  Result<void> Finish() {
    if (auto flushed = Encode(nullptr); !flushed) return flushed;
    int code = av_write_trailer(muxer_);
    if (code >= 0) {
      avio_flush(muxer_->pb);
      code = muxer_->pb->error;
    }
    const int closed = avio_closep(&muxer_->pb);
    if (code >= 0) code = closed;
    if (code < 0) return FailWith("cannot be ended", code);
    finished_ = true;
    return {};
  }

 private:
  tl::unexpected<Error> FailWith(const char* what, int code) const {
    return Fail(fmt::format("{}: the video {} ({}); free the disk, or name another place", name_,
                            what, libav::ErrorText(code)));
  }

  Result<void> OpenEncoder() {
    const bool is_h264 = format_.codec == VideoCodec::kH264;
    const char* const encoder_name = is_h264 ? "libx264" : "ffv1";
    const AVCodec* const codec = avcodec_find_encoder_by_name(encoder_name);
    if (codec == nullptr)
      return Fail(
          fmt::format("{}: this FFmpeg has no encoder '{}'; install one that has, or "
                      "choose another codec",
                      name_, encoder_name));
    encoder_.reset(avcodec_alloc_context3(codec));
    encoder_->width = format_.width;
    encoder_->height = format_.height;
    encoder_->pix_fmt = PixelsOf(format_);
    encoder_->time_base = {format_.rate.seconds, format_.rate.frames};
    encoder_->framerate = {format_.rate.frames, format_.rate.seconds};
    encoder_->color_range = AVCOL_RANGE_JPEG;
    if (format_.pixels == PixelFormat::kRgb8) encoder_->colorspace = AVCOL_SPC_SMPTE170M;
    encoder_->thread_count = 1;  // the bytes must not depend on the machine
    encoder_->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
    if (is_h264) {
      av_opt_set_double(encoder_->priv_data, "crf", format_.crf, 0);
    } else {
      encoder_->level = 3;
      encoder_->gop_size = 1;
      encoder_->slices = 4;
      av_opt_set_int(encoder_->priv_data, "slicecrc", 1, 0);
    }
    if (const int code = avcodec_open2(encoder_.get(), codec, nullptr); code < 0)
      return Fail(
          fmt::format("{}: the encoder '{}' refuses {} x {} pixels ({}); choose another size",
                      name_, encoder_name, format_.width, format_.height, libav::ErrorText(code)));
    packet_.reset(av_packet_alloc());
    return {};
  }

  // A frame of its own for every picture, since the encoder may keep the last ones; without colour.
  Result<void> MakeFrame() {
    frame_.reset(av_frame_alloc());
    frame_->format = encoder_->pix_fmt;
    frame_->width = format_.width;
    frame_->height = format_.height;
    frame_->color_range = encoder_->color_range;
    if (av_frame_get_buffer(frame_.get(), 0) < 0) return Fail(name_ + ": no memory for a frame");
    for (const AVBufferRef* const buffer : frame_->buf)
      if (buffer != nullptr) std::memset(buffer->data, kNoColor, buffer->size);
    return {};
  }

  void CopyGrey(const ImageView& image) {
    const auto row_bytes = static_cast<std::size_t>(image.width) * BytesPerPixel(image.format);
    for (int y = 0; y < image.height; ++y)
      std::memcpy(frame_->data[0] + static_cast<std::ptrdiff_t>(y) * frame_->linesize[0],
                  image.row(y), row_bytes);
  }

  void CopyColor(const ImageView& image) {
    constexpr int kFullRange = 1, kUnit = 1 << 16;
    if (!scaler_) {
      scaler_.reset(sws_getContext(format_.width, format_.height, AV_PIX_FMT_RGB24, format_.width,
                                   format_.height, encoder_->pix_fmt,
                                   SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr,
                                   nullptr));
      ARTICAP_CHECK(scaler_ != nullptr);
      const int* const coefficients = sws_getCoefficients(SWS_CS_ITU601);
      sws_setColorspaceDetails(scaler_.get(), coefficients, kFullRange, coefficients, kFullRange, 0,
                               kUnit, kUnit);
    }
    const std::uint8_t* const rows[] = {image.data};
    const int stride_bytes[] = {static_cast<int>(image.stride_bytes)};
    sws_scale(scaler_.get(), rows, stride_bytes, 0, format_.height, frame_->data, frame_->linesize);
  }

  // Null: what the encoder still keeps back.
  Result<void> Encode(const AVFrame* frame) {
    if (const int code = avcodec_send_frame(encoder_.get(), frame); code < 0)
      return FailWith("cannot be encoded", code);
    while (true) {
      const int received = avcodec_receive_packet(encoder_.get(), packet_.get());
      if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return {};
      if (received < 0) return FailWith("cannot be encoded", received);
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), encoder_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      int code = av_interleaved_write_frame(muxer_, packet_.get());
      if (code >= 0) code = muxer_->pb->error;
      if (code < 0) return FailWith("cannot be written", code);
    }
  }

  std::filesystem::path path_;
  std::string name_;
  VideoFormat format_;
  libav::Owner<AVCodecContext> encoder_;
  libav::Owner<AVFrame> frame_;
  libav::Owner<AVPacket> packet_;
  libav::Owner<SwsContext> scaler_;  // of colour
  AVFormatContext* muxer_ = nullptr;
  AVStream* stream_ = nullptr;  // of the muxer
  std::int64_t num_frames_ = 0;
  bool was_there_ = false;
  bool finished_ = false;
};

VideoWriter::VideoWriter(std::unique_ptr<Output> output) : output_(std::move(output)) {}
VideoWriter::~VideoWriter() = default;

Result<std::unique_ptr<VideoWriter>> VideoWriter::Create(const std::filesystem::path& path,
                                                         const VideoFormat& format) {
  if (auto valid = CheckFormat(path.string(), format); !valid) return tl::unexpected(valid.error());
  auto output = std::make_unique<Output>(path, format);
  if (auto opened = output->Open(); !opened) return tl::unexpected(opened.error());
  return std::unique_ptr<VideoWriter>(new VideoWriter(std::move(output)));
}

Result<void> VideoWriter::Write(const ImageView& image) { return output_->Write(image); }
Result<void> VideoWriter::Finish() { return output_->Finish(); }

}  // namespace articap
