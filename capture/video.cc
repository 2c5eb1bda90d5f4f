// SPDX-License-Identifier: MIT
#include "capture/video.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "capture/frame_pixels.h"
#include "capture/frame_times.h"
#include "capture/stream_decoder.h"
#include "capture/video_probe.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
}

namespace articap {
namespace {

using libav::FramePixels;
using libav::Rows;
using libav::StreamDecoder;
using libav::VideoFacts;

FrameSourceInfo InfoOf(const VideoFacts& facts, const std::string& name) {
  const int fields = facts.fields == FieldMode::kFrames ? 1 : 2;
  FrameSourceInfo info;
  info.name = name;
  info.width = static_cast<int>(std::lround(facts.width * facts.pixel_aspect));
  info.height = facts.height;
  if (facts.quarter_turns % 2 != 0) std::swap(info.width, info.height);
  info.rate_hz = fields * facts.rate_hz;
  info.constant_rate = facts.constant_rate;
  info.interlaced = fields == 2;
  info.frames = facts.frames < 0 ? -1 : fields * facts.frames;
  info.notes = facts.notes;
  return info;
}

class VideoSource : public FrameSource {
 public:
  VideoSource(libav::ProbedVideo probed, const VideoOptions& options)
      : facts_(std::move(probed.facts)),
        options_(options),
        info_(InfoOf(facts_, facts_.groups[0][0].string())),
        pixels_(options.color, facts_.quarter_turns),
        times_(NewTimes()),
        decoder_(std::move(probed.decoder)) {}

  const FrameSourceInfo& info() const override { return info_; }
  Result<std::optional<Frame>> Next() override;
  Result<void> Rewind() override;

 private:
  FrameTimes NewTimes() const { return {facts_.rate_hz, facts_.tick, options_.start}; }
  // Decodes the next picture; false at the end.
  Result<bool> Advance();
  Result<bool> BeginGroup(std::size_t group);
  Result<void> CheckPicture();
  Result<std::optional<Frame>> Show(Rows rows, SessionTime time);
  tl::unexpected<Error> FailHere(const std::string& why) const;
  void AccountForTimes();

  VideoFacts facts_;
  VideoOptions options_;
  FrameSourceInfo info_;
  FramePixels pixels_;
  FrameTimes times_;
  std::unique_ptr<StreamDecoder> decoder_;
  std::size_t group_ = 0;
  bool begins_part_ = false;
  bool ended_ = false;
  std::int64_t num_pictures_ = 0;
  std::int64_t num_frames_ = 0;
  std::optional<SessionTime> second_field_;  // of the picture decoded last, still to be shown
};

tl::unexpected<Error> VideoSource::FailHere(const std::string& why) const {
  return Fail(
      fmt::format("{}, frame {}: {}", facts_.groups[group_][0].string(), num_pictures_, why));
}

Result<bool> VideoSource::BeginGroup(std::size_t group) {
  if (group == facts_.groups.size()) {
    ended_ = true;
    AccountForTimes();
    return false;
  }
  group_ = group;
  begins_part_ = group > 0;
  auto decoder = StreamDecoder::Open(facts_.groups[group], libav::StreamKind::kVideo);
  if (!decoder) {
    ended_ = true;
    return tl::unexpected(decoder.error());
  }
  decoder_ = *std::move(decoder);
  return true;
}

Result<bool> VideoSource::Advance() {
  while (!ended_) {
    if (!decoder_) {
      const Result<bool> begun = BeginGroup(group_);
      if (!begun || !*begun) return begun;
    }
    const Result<bool> more = decoder_->Next();
    if (!more) return FailHere("cannot be decoded (" + more.error().message + ")");
    if (*more) return true;
    decoder_.reset();
    if (const Result<bool> begun = BeginGroup(group_ + 1); !begun) return begun;
  }
  return false;
}

Result<void> VideoSource::CheckPicture() {
  const AVFrame& frame = decoder_->frame();
  if (frame.width == facts_.width && frame.height == facts_.height &&
      frame.format == facts_.pixel_format)
    return {};
  const auto name = [](int format) {
    const char* const text = av_get_pix_fmt_name(static_cast<AVPixelFormat>(format));
    return std::string(text == nullptr ? "unknown" : text);
  };
  ended_ = true;
  AccountForTimes();
  return FailHere(fmt::format(
      "the pictures change from {}x{} {} to {}x{} {}; cut the video there, into one file each",
      facts_.width, facts_.height, name(facts_.pixel_format), frame.width, frame.height,
      name(frame.format)));
}

Result<std::optional<Frame>> VideoSource::Next() {
  const bool bottom_first = facts_.fields == FieldMode::kBottomFirst;
  if (second_field_) {
    const SessionTime time = *second_field_;
    second_field_.reset();
    return Show(bottom_first ? Rows::kTop : Rows::kBottom, time);
  }
  const Result<bool> more = Advance();
  if (!more) return tl::unexpected(more.error());
  if (!*more) return std::nullopt;
  if (const auto checked = CheckPicture(); !checked) return tl::unexpected(checked.error());
  const SessionTime time = times_.Next(decoder_->time(), std::exchange(begins_part_, false));
  info_.constant_rate = times_.constant_rate();
  ++num_pictures_;
  if (facts_.fields == FieldMode::kFrames) return Show(Rows::kAll, time);
  second_field_ = time + std::chrono::nanoseconds(std::llround(0.5e9 / facts_.rate_hz));
  return Show(bottom_first ? Rows::kBottom : Rows::kTop, time);
}

Result<std::optional<Frame>> VideoSource::Show(Rows rows, SessionTime time) {
  const Result<ImageView> image = pixels_.Convert(decoder_->frame(), rows);
  if (!image) return FailHere(image.error().message);
  Frame frame;
  frame.index = num_frames_++;
  frame.time = time;
  frame.status = decoder_->is_corrupt() ? FrameStatus::kCorrupt : FrameStatus::kGood;
  frame.image = *image;
  frame.picture_from_image = libav::PictureFromRows(facts_, rows);
  return frame;
}

void VideoSource::AccountForTimes() {
  info_.notes = facts_.notes;
  for (std::string& note : times_.notes()) info_.notes.push_back(std::move(note));
  // Durations may be those of the sound, which goes on a little longer.
  constexpr double kPause_s = 0.2;
  const auto missing = static_cast<double>(facts_.frames - num_pictures_);
  if (facts_.frames > 0 && missing > std::max(1.5, kPause_s * facts_.rate_hz))
    info_.notes.push_back(fmt::format(
        "the video ends after {} pictures, where its header promises {}: it was cut short, or its "
        "sound goes on",
        num_pictures_, facts_.frames));
}

Result<void> VideoSource::Rewind() {
  decoder_.reset();
  group_ = 0;
  begins_part_ = ended_ = false;
  num_pictures_ = num_frames_ = 0;
  second_field_.reset();
  times_ = NewTimes();
  return {};
}

}  // namespace

void VisitOptions(VideoOptions& options, OptionVisitor& visit) {
  visit.Enumeration("color", options.color, {"luma", "rgb"},
                    "grey pictures from the luma, or colour");
  visit.Enumeration("fields", options.fields, {"auto", "frames", "top-first", "bottom-first"},
                    "interlaced video: decide, whole pictures, or fields and which is first");
}

Result<std::unique_ptr<FrameSource>> OpenVideo(const std::vector<std::filesystem::path>& parts,
                                               const VideoOptions& options) {
  Result<libav::ProbedVideo> probed = libav::ProbeVideo(parts, options);
  if (!probed) return tl::unexpected(probed.error());
  return std::make_unique<VideoSource>(*std::move(probed), options);
}

}  // namespace articap
