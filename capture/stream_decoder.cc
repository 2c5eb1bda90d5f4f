// SPDX-License-Identifier: MIT
#include "capture/stream_decoder.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "capture/ffv1_check.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace articap::libav {
namespace {

constexpr AVRational kNanosecond = {1, 1'000'000'000};

Result<Owner<AVCodecContext>> OpenCodec(const std::string& name, const AVStream& stream,
                                        bool strict) {
  const AVCodecParameters& parameters = *stream.codecpar;
  const AVCodec* const codec = avcodec_find_decoder(parameters.codec_id);
  if (codec == nullptr)
    return Fail(fmt::format("{}: is coded as {}, which this FFmpeg cannot decode; convert it", name,
                            avcodec_get_name(parameters.codec_id)));
  Owner<AVCodecContext> context(avcodec_alloc_context3(codec));
  avcodec_parameters_to_context(context.get(), &parameters);
  context->pkt_timebase = stream.time_base;
  context->flags |= AV_CODEC_FLAG_OUTPUT_CORRUPT;
  // libav writes TIFF that its own reader then finds faulty.
  strict = strict && parameters.codec_id != AV_CODEC_ID_TIFF;
  context->err_recognition =
      strict ? AV_EF_CRCCHECK | AV_EF_BUFFER | AV_EF_EXPLODE : AV_EF_CRCCHECK;
  context->thread_count = 0;  // as many as there are processors
  if (const int opened = avcodec_open2(context.get(), codec, nullptr); opened < 0)
    return Fail(fmt::format("{}: its {} cannot be decoded ({})", name, codec->long_name,
                            ErrorText(opened)));
  return context;
}

}  // namespace

Result<std::unique_ptr<StreamDecoder>> StreamDecoder::Open(
    const std::vector<std::filesystem::path>& pieces, StreamKind kind, bool strict) {
  auto input = Input::Open(pieces);
  if (!input) return tl::unexpected(input.error());
  std::unique_ptr<StreamDecoder> decoder(new StreamDecoder);
  decoder->input_ = *std::move(input);
  const bool is_video = kind == StreamKind::kVideo;
  decoder->stream_ = is_video ? decoder->input_->video_stream() : decoder->input_->audio_stream();
  if (decoder->stream_ == nullptr)
    return Fail(fmt::format("{}: holds no {}", decoder->input_->name(),
                            is_video ? "pictures; name a video" : "sound"));
  // What belongs to other streams need not be kept.
  AVFormatContext& format = decoder->input_->format();
  for (unsigned i = 0; i < format.nb_streams; ++i)
    if (format.streams[i] != decoder->stream_) format.streams[i]->discard = AVDISCARD_ALL;
  auto codec = OpenCodec(decoder->input_->name(), *decoder->stream_, strict);
  if (!codec) return tl::unexpected(codec.error());
  decoder->codec_ = *std::move(codec);
  decoder->frame_.reset(av_frame_alloc());
  decoder->packet_.reset(av_packet_alloc());
  return decoder;
}

void StreamDecoder::KeepForRestart(std::size_t most_bytes) {
  keeps_ = true;
  room_bytes_ = most_bytes;
}

bool StreamDecoder::Restart() { return std::exchange(keeps_, false); }

void StreamDecoder::Keep() {
  std::size_t bytes = 0;
  for (const AVBufferRef* const buffer : frame_->buf)
    if (buffer != nullptr) bytes += buffer->size;
  if (bytes > room_bytes_) return KeepNothing();
  room_bytes_ -= bytes;
  kept_.emplace_back(av_frame_clone(frame_.get()));
}

void StreamDecoder::KeepNothing() {
  keeps_ = false;
  kept_.clear();
}

Result<bool> StreamDecoder::Next() {
  if (!keeps_ && !kept_.empty()) {
    frame_ = std::move(kept_.front());
    kept_.pop_front();
    return true;
  }
  Result<bool> more = Decode();
  if (keeps_ && !more) KeepNothing();  // the fault has to come again
  if (keeps_ && *more) Keep();
  return more;
}

Result<bool> StreamDecoder::Decode() {
  while (true) {
    const int received = avcodec_receive_frame(codec_.get(), frame_.get());
    if (received == 0) return true;
    if (received == AVERROR_EOF) return false;
    if (received != AVERROR(EAGAIN)) return Fail(ErrorText(received));
    if (const auto fed = Feed(); !fed) return tl::unexpected(fed.error());
  }
}

Result<void> StreamDecoder::Feed() {
  int read = 0;
  do {
    av_packet_unref(packet_.get());
    read = av_read_frame(&input_->format(), packet_.get());
  } while (read == 0 && packet_->stream_index != stream_->index);
  if (read < 0) {
    avcodec_send_packet(codec_.get(), nullptr);  // what it holds back, it gives now
    if (read != AVERROR_EOF)
      return Fail(fmt::format("reading fails ({}); what follows is lost", ErrorText(read)));
    return {};
  }
  if (PacketIsDamaged()) damaged_times_.insert(packet_->pts);
  const int sent = avcodec_send_packet(codec_.get(), packet_.get());
  if (sent < 0 && sent != AVERROR(EAGAIN)) return Fail(ErrorText(sent));
  return {};
}

bool StreamDecoder::PacketIsDamaged() {
  if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) return true;
  if (codec_->codec_id != AV_CODEC_ID_FFV1) return false;
  const bool is_whole = Ffv1IsWhole({packet_->data, static_cast<std::size_t>(packet_->size)});
  has_checksums_ = has_checksums_ || is_whole;
  return has_checksums_ && !is_whole;
}

bool StreamDecoder::is_corrupt() const {
  return (frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame_->decode_error_flags != 0 ||
         damaged_times_.contains(frame_->pts);
}

std::optional<std::chrono::nanoseconds> StreamDecoder::time() const {
  const std::int64_t time = frame_->best_effort_timestamp;
  if (time == AV_NOPTS_VALUE) return std::nullopt;
  return std::chrono::nanoseconds(av_rescale_q(time, stream_->time_base, kNanosecond));
}

std::chrono::nanoseconds StreamDecoder::tick() const {
  return std::chrono::nanoseconds(av_rescale_q(1, stream_->time_base, kNanosecond));
}

}  // namespace articap::libav
