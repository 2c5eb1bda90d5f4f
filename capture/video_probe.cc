// SPDX-License-Identifier: MIT
#include "capture/video_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "capture/comb.h"
#include "capture/frame_times.h"
#include "capture/stream_decoder.h"
#include "capture/transport_stream.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/pixdesc.h>
}

namespace articap {
namespace fs = std::filesystem;

namespace libav {
namespace {

constexpr double kSeconds = 1.0 / AV_TIME_BASE;

double ValueOf(AVRational number) { return number.den == 0 ? 0 : av_q2d(number); }

// What the parts of one recording must share.
struct PartFacts {
  std::tuple<int, int, int, int> coding;  // width, height, codec, format of the pixels
  double rate_hz = 0;
  std::int64_t frames = -1;
  bool is_transport_stream = false;
  std::string text;
};

std::int64_t FramesOf(Input& input, const AVStream& stream, double rate_hz) {
  if (stream.nb_frames > 0) return stream.nb_frames;
  const double duration_s =
      stream.duration > 0 ? static_cast<double>(stream.duration) * ValueOf(stream.time_base)
      : input.format().duration > 0 ? static_cast<double>(input.format().duration) * kSeconds
                                    : 0;
  return duration_s > 0 && rate_hz > 0 ? std::llround(duration_s * rate_hz) : -1;
}

Result<PartFacts> LookIntoPart(const fs::path& path) {
  const auto input = Input::Open({path});
  if (!input) return tl::unexpected(input.error());
  const AVStream* const stream = (*input)->video_stream();
  if (stream == nullptr || (*input)->is_picture())
    return Fail(fmt::format("{}: is no video", path.string()));
  const AVCodecParameters& codec = *stream->codecpar;
  if (codec.width <= 0 || codec.height <= 0)
    return Fail(fmt::format("{}: no picture of its video can be decoded", path.string()));
  PartFacts facts;
  facts.coding = {codec.width, codec.height, codec.codec_id, codec.format};
  facts.rate_hz = ValueOf(stream->avg_frame_rate);
  facts.frames = FramesOf(**input, *stream, facts.rate_hz);
  facts.is_transport_stream = (*input)->is_transport_stream();
  const char* const pixels = av_get_pix_fmt_name(static_cast<AVPixelFormat>(codec.format));
  facts.text =
      fmt::format("{}x{} {} {} at {:.5g} Hz", codec.width, codec.height,
                  avcodec_get_name(codec.codec_id), pixels == nullptr ? "" : pixels, facts.rate_hz);
  return facts;
}

// Averages of short files say little of their rates.
bool SameRate(double first_hz, double second_hz) {
  constexpr double kSame = 0.02;
  return std::abs(first_hz - second_hz) <= kSame * std::max(first_hz, second_hz);
}

Result<VideoFacts> LookIntoParts(const std::vector<fs::path>& parts) {
  if (parts.empty()) return Fail("no video is named");
  VideoFacts facts;
  std::optional<PartFacts> first;
  facts.frames = 0;
  for (const fs::path& path : parts) {
    const Result<PartFacts> part = LookIntoPart(path);
    if (!part) return tl::unexpected(part.error());
    if (!first) first = *part;
    if (part->coding != first->coding || !SameRate(part->rate_hz, first->rate_hz))
      return Fail(fmt::format("{} is {}, but {} is {}; they are not parts of one recording",
                              path.string(), part->text, parts[0].string(), first->text));
    facts.frames = part->frames < 0 || facts.frames < 0 ? -1 : facts.frames + part->frames;
  }
  for (const fs::path& path : parts)
    if (first->is_transport_stream && !facts.groups.empty() &&
        TransportStreamGoesOn(facts.groups.back().back(), path))
      facts.groups.back().push_back(path);
    else
      facts.groups.push_back({path});
  return facts;
}

// What the file says of its fields.
struct FieldFlags {
  int frames = 0, interlaced = 0, top_first = 0;

  void Add(const AVFrame& frame) {
    ++frames;
    interlaced += frame.interlaced_frame != 0;
    top_first += frame.interlaced_frame != 0 && frame.top_field_first != 0;
  }
  // Decoders that know nothing of fields leave it to the container.
  void AddContainer(AVFieldOrder order) {
    if (interlaced > 0 || order == AV_FIELD_UNKNOWN || order == AV_FIELD_PROGRESSIVE) return;
    interlaced = frames;
    top_first = order == AV_FIELD_TT || order == AV_FIELD_BT ? frames : 0;
  }
  bool is_interlaced() const { return 2 * interlaced > frames; }
  bool is_top_first() const { return 2 * top_first >= interlaced; }
};

const char* NameOf(bool top_first) { return top_first ? "top field first" : "bottom field first"; }

FieldMode DecideFields(const FieldFlags& flags, const CombEvidence& evidence,
                       std::vector<std::string>& notes) {
  const std::optional<bool> seen = evidence.interlaced();
  const bool interlaced = seen.value_or(flags.is_interlaced());
  if (interlaced != flags.is_interlaced())
    notes.push_back(interlaced
                        ? "the file calls its pictures progressive, but they are woven from two "
                          "fields wherever something moves: read as fields"
                        : "the file calls its pictures interlaced, but nothing that moves in them "
                          "is: read as whole pictures");
  if (!interlaced) return FieldMode::kFrames;
  const std::optional<bool> order = evidence.top_field_first();
  const bool top_first = order.value_or(flags.is_top_first());
  if (flags.is_interlaced() && top_first != flags.is_top_first())
    notes.push_back(fmt::format("the file says {}, but what moves says {}, which is taken",
                                NameOf(!top_first), NameOf(top_first)));
  notes.push_back(fmt::format("interlaced: every picture comes as two fields, {}{}",
                              NameOf(top_first),
                              seen && order ? ""
                                            : "; too little moves in the first pictures to "
                                              "see whether that is true"));
  return top_first ? FieldMode::kTopFirst : FieldMode::kBottomFirst;
}

void FindTurns(const AVStream& stream, VideoFacts& facts) {
  std::size_t size = 0;
  const auto* const matrix = reinterpret_cast<const std::int32_t*>(
      av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &size));
  if (matrix == nullptr || size < 9 * sizeof(std::int32_t)) return;
  const double determinant =
      static_cast<double>(matrix[0]) * matrix[4] - static_cast<double>(matrix[1]) * matrix[3];
  const double clockwise_deg = -av_display_rotation_get(matrix);
  const double turns = clockwise_deg / 90;
  if (determinant < 0)
    facts.notes.push_back(
        "the file asks to be shown as in a mirror, which is not done: the pictures are as the "
        "camera saw them");
  else if (!(std::abs(turns - std::round(turns)) < 0.01))
    facts.notes.push_back(
        fmt::format("the file asks to be turned by {:.4g} degrees, which is not "
                    "done; only quarter turns are",
                    clockwise_deg));
  else
    facts.quarter_turns = static_cast<int>((std::llround(turns) % 4 + 4) % 4);
  if (facts.quarter_turns != 0)
    facts.notes.push_back(
        fmt::format("turned by {} degrees clockwise, as the file asks", 90 * facts.quarter_turns));
}

void FindPixelAspect(StreamDecoder& decoder, VideoFacts& facts) {
  AVFrame frame_copy{};
  frame_copy.sample_aspect_ratio = decoder.frame().sample_aspect_ratio;
  AVStream* const stream = decoder.input().video_stream();
  const double aspect =
      ValueOf(av_guess_sample_aspect_ratio(&decoder.input().format(), stream, &frame_copy));
  constexpr double kWidest = 4;  // twice that of any standard
  if (aspect == 0 || aspect == 1) return;
  if (aspect > kWidest || aspect < 1 / kWidest) {
    facts.notes.push_back(fmt::format(
        "the file calls its pixels {:.4g} times as wide as high, which no camera's are; they are "
        "taken as square",
        aspect));
    return;
  }
  facts.pixel_aspect = aspect;
  facts.notes.push_back(fmt::format(
      "pixels are {:.5g} times as wide as high: coordinates are those of square pixels", aspect));
}

using Times = std::vector<std::optional<std::chrono::nanoseconds>>;

// Frames that come when this rate says, after the one before.
int CountRegular(const Times& times, double rate_hz, std::chrono::nanoseconds tick) {
  int count = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!times[i - 1] || !times[i]) continue;
    FrameTimes pair(rate_hz, tick, {});
    pair.Next(times[i - 1]);
    pair.Next(times[i]);
    count += pair.constant_rate();
  }
  return count;
}

// One of the header's, which are exact, where most frames come at it; else the mean. 0: not known.
double RateOf(const AVStream& stream, const Times& times, std::chrono::nanoseconds tick) {
  const double base_hz = ValueOf(stream.r_frame_rate);
  const double average_hz = ValueOf(stream.avg_frame_rate);
  Times known = times;
  std::erase(known, std::nullopt);
  if (known.size() != times.size() || times.size() < 2 || *known.back() <= *known.front())
    return average_hz > 0 ? average_hz : base_hz;
  const auto num_steps = static_cast<double>(times.size() - 1);
  double best_hz = num_steps * 1e9 / static_cast<double>((*known.back() - *known.front()).count());
  int best_count = static_cast<int>(times.size()) / 2;
  for (const double rate_hz : {base_hz, average_hz}) {
    const int count = rate_hz > 0 ? CountRegular(times, rate_hz, tick) : 0;
    if (count > best_count) std::tie(best_hz, best_count) = std::pair(rate_hz, count);
  }
  return best_hz;
}

// The first pictures: enough to see the rate, and until something has moved.
struct FirstPictures {
  Times times;
  FieldFlags flags;
  CombMeter comb;

  bool AreEnough(FieldMode fields) const {
    constexpr std::size_t kAtLeast = 30, kAtMost = 100;
    if (times.size() < kAtLeast) return false;
    return times.size() >= kAtMost || fields != FieldMode::kAuto ||
           comb.evidence().interlaced().has_value();
  }
};

Result<FirstPictures> LookAtPictures(StreamDecoder& decoder, FieldMode fields, VideoFacts& facts) {
  FirstPictures first;
  FramePixels pixels(PixelColor::kLuma, 0);
  while (!first.AreEnough(fields)) {
    const Result<bool> more = decoder.Next();
    if (!more) continue;  // reading it properly will say so
    if (!*more) break;
    const AVFrame& frame = decoder.frame();
    if (first.times.empty()) {
      std::tie(facts.width, facts.height) = std::pair(frame.width, frame.height);
      facts.pixel_format = frame.format;
      FindPixelAspect(decoder, facts);
    }
    first.times.push_back(decoder.time());
    first.flags.Add(frame);
    if (fields != FieldMode::kAuto) continue;
    const Result<ImageView> image = pixels.Convert(frame, Rows::kAll);
    if (!image) return Fail(fmt::format("{}: {}", decoder.input().name(), image.error().message));
    first.comb.Add(*image);
  }
  if (first.times.empty())
    return Fail(fmt::format("{}: no picture of it can be decoded", decoder.input().name()));
  return first;
}

void FindRate(const AVStream& stream, const Times& times, VideoFacts& facts) {
  facts.rate_hz = RateOf(stream, times, facts.tick);
  if (facts.rate_hz > 0) {
    FrameTimes judged(facts.rate_hz, facts.tick, {});
    for (const auto& time : times) judged.Next(time);
    facts.constant_rate = judged.constant_rate();
    return;
  }
  constexpr double kUsual_hz = 25;
  facts.rate_hz = kUsual_hz;
  facts.notes.push_back("the file does not say its rate; 25 Hz is taken");
}

}  // namespace

Result<ProbedVideo> ProbeVideo(const std::vector<fs::path>& parts, const VideoOptions& options) {
  constexpr std::size_t kMostKept_bytes = 100'000'000;
  Result<VideoFacts> facts = LookIntoParts(parts);
  if (!facts) return tl::unexpected(facts.error());
  auto opened = StreamDecoder::Open(facts->groups[0], StreamKind::kVideo);
  if (!opened) return tl::unexpected(opened.error());
  std::unique_ptr<StreamDecoder> decoder = *std::move(opened);
  decoder->KeepForRestart(kMostKept_bytes);
  facts->tick = decoder->tick();
  FindTurns(decoder->stream(), *facts);
  Result<FirstPictures> first = LookAtPictures(*decoder, options.fields, *facts);
  if (!first) return tl::unexpected(first.error());
  FindRate(decoder->stream(), first->times, *facts);
  facts->fields = options.fields;
  if (options.fields == FieldMode::kAuto) {
    first->flags.AddContainer(decoder->stream().codecpar->field_order);
    facts->fields = DecideFields(first->flags, first->comb.evidence(), facts->notes);
  }
  if (!decoder->Restart()) {
    opened = StreamDecoder::Open(facts->groups[0], StreamKind::kVideo);
    if (!opened) return tl::unexpected(opened.error());
    decoder = *std::move(opened);
  }
  return ProbedVideo{*std::move(facts), std::move(decoder)};
}

}  // namespace libav

Result<std::int64_t> CountPictures(const fs::path& path, double rate_hz) {
  const auto input = libav::Input::Open({path});
  if (!input) return tl::unexpected(input.error());
  const AVStream* const stream = (*input)->video_stream();
  if (stream == nullptr) return Fail(fmt::format("{}: is no video", path.string()));
  const libav::Owner<AVPacket> packet(av_packet_alloc());
  std::int64_t count = 0;
  std::int64_t first = INT64_MAX, last = INT64_MIN;
  for (; av_read_frame(&(*input)->format(), packet.get()) == 0; av_packet_unref(packet.get())) {
    if (packet->stream_index != stream->index || (packet->flags & AV_PKT_FLAG_DISCARD) != 0)
      continue;
    ++count;
    if (packet->pts == AV_NOPTS_VALUE) continue;
    first = std::min(first, packet->pts);
    last = std::max(last, packet->pts);
  }
  if (first >= last) return count;
  // Interlaced H.264 may have a packet for each field.
  const double pictures =
      static_cast<double>(last - first) * libav::ValueOf(stream->time_base) * rate_hz + 1;
  return static_cast<double>(count) > 1.5 * pictures ? (count + 1) / 2 : count;
}

namespace libav {

PictureFromImage PictureFromRows(const VideoFacts& facts, Rows rows) {
  const bool whole = rows == Rows::kAll;
  const int first = rows == Rows::kBottom ? 1 : 0;
  const int num_rows = whole ? facts.height : (facts.height - first + 1) / 2;
  const double step = whole ? 1 : 2;
  // Counted from the other end where the rows are turned upside down.
  const bool reversed = facts.quarter_turns == 1 || facts.quarter_turns == 2;
  const double row_offset =
      reversed ? facts.height - 1 - (step * (num_rows - 1) + first) : double(first);
  PictureFromImage picture;
  picture.scale = {facts.pixel_aspect, step};
  // The edge of the first pixel, half a pixel before its centre, is the picture's edge.
  picture.offset_px = {(facts.pixel_aspect - 1) / 2, row_offset};
  if (facts.quarter_turns % 2 != 0) {
    std::swap(picture.scale.x(), picture.scale.y());
    std::swap(picture.offset_px.x(), picture.offset_px.y());
  }
  return picture;
}

}  // namespace libav
}  // namespace articap
