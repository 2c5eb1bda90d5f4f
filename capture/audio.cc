// SPDX-License-Identifier: MIT
#include "capture/audio.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "capture/audio_samples.h"
#include "capture/stream_decoder.h"
#include "capture/video_probe.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/frame.h>
}

namespace articap {
namespace {

namespace fs = std::filesystem;
using libav::StreamDecoder;
using libav::StreamKind;
using std::chrono::nanoseconds;

using Groups = std::vector<std::vector<fs::path>>;

struct Picture {
  Groups groups;
  nanoseconds first{0};  // the first picture's time on the file's clock
};

// Where the video begins; nothing where the file has none.
Result<std::optional<Picture>> FindPictures(const std::vector<fs::path>& parts) {
  const auto input = libav::Input::Open({parts.front()});
  if (!input) return tl::unexpected(input.error());
  if ((*input)->video_stream() == nullptr) return std::nullopt;
  VideoOptions options;
  options.fields = FieldMode::kFrames;
  const auto probed = libav::ProbeVideo(parts, options);
  if (!probed) return tl::unexpected(probed.error());
  StreamDecoder& decoder = *probed->decoder;
  Result<bool> more = decoder.Next();
  while (!more) more = decoder.Next();
  return Picture{probed->facts.groups, decoder.time().value_or(nanoseconds(0))};
}

// Puts decoded pieces one behind the other, by the file's times.
class AudioJoiner {
 public:
  AudioJoiner(const fs::path& wav_path, ExtractedAudio& sound)
      : wav_path_(wav_path), sound_(sound) {}

  void BeginGroup() { begins_group_ = true; }
  Result<void> Add(const StreamDecoder& decoder);
  Result<void> Finish();
  // On the clock of the file, of the first sample.
  nanoseconds start() const {
    return nanoseconds(num_starts_ == 0 ? 0 : std::llround(sum_of_starts_ns_ / num_starts_));
  }

 private:
  Result<void> Begin(const StreamDecoder& decoder);
  // How many samples of the piece are already there, after silence was put before it.
  Result<int> Place(const AVFrame& frame, nanoseconds time, nanoseconds tick);
  double SecondsOfFrames(std::int64_t frames) const {
    return static_cast<double>(frames) / static_cast<double>(sound_.format.rate_hz);
  }

  const fs::path& wav_path_;
  ExtractedAudio& sound_;
  std::optional<WavWriter> writer_;
  bool begins_group_ = false;
  nanoseconds first_time_{0};  // of the first piece, by the clock that counts now
  // Where the first sample is, by the pieces before any gap.
  double sum_of_starts_ns_ = 0;
  int num_starts_ = 0;
  bool was_interrupted_ = false;
};

Result<void> AudioJoiner::Begin(const StreamDecoder& decoder) {
  const auto format = libav::WavFormatOf(decoder.codec(), decoder.frame());
  if (!format)
    return Fail("its samples are of a kind that WAV does not hold; convert them to 32 bits");
  sound_.format = *format;
  auto writer = WavWriter::Create(wav_path_, *format);
  if (!writer) return tl::unexpected(writer.error());
  writer_.emplace(*std::move(writer));
  first_time_ = decoder.time().value_or(nanoseconds(0));
  return {};
}

Result<int> AudioJoiner::Place(const AVFrame& frame, nanoseconds time, nanoseconds tick) {
  // Encoders place packets to a few ticks; a camera that loses one loses more than 20 ms.
  const double tolerance_s = 0.02 + 2e-9 * static_cast<double>(tick.count());
  constexpr double kAnotherClock_s = 1;
  const double there_s = SecondsOfFrames(writer_->num_frames());
  const double told_s = static_cast<double>((time - first_time_).count()) * 1e-9;
  const double gap_s = told_s - there_s;
  const bool begins_group = std::exchange(begins_group_, false);
  if (std::abs(gap_s) <= tolerance_s) {
    constexpr int kMostStarts = 256;
    if (!was_interrupted_ && num_starts_ < kMostStarts) {
      sum_of_starts_ns_ += static_cast<double>(time.count()) - there_s * 1e9;
      ++num_starts_;
    }
    return 0;
  }
  was_interrupted_ = true;
  if (gap_s < -kAnotherClock_s || (begins_group && (gap_s < 0 || gap_s > kAnotherClock_s))) {
    first_time_ = time - nanoseconds(std::llround(there_s * 1e9));
    sound_.notes.push_back(
        fmt::format("at {:.3f} s the file's clock begins anew; the sound goes on there", there_s));
    return 0;
  }
  const auto rate_hz = static_cast<double>(sound_.format.rate_hz);
  const std::int64_t missing = std::llround(gap_s * rate_hz);
  if (missing < 0) {
    sound_.notes.push_back(
        fmt::format("at {:.3f} s the file repeats {:.3f} s of sound, which are "
                    "left out",
                    there_s, -gap_s));
    return static_cast<int>(std::min<std::int64_t>(-missing, frame.nb_samples));
  }
  constexpr double kLongestGap_s = 3600;
  if (gap_s > kLongestGap_s)
    return Fail(
        fmt::format("at {:.3f} s its times jump by {:.0f} s; cut the file there", there_s, gap_s));
  sound_.notes.push_back(fmt::format(
      "at {:.3f} s there are {:.3f} s without sound; silence stands for them", there_s, gap_s));
  if (const auto written = writer_->WriteSilence(missing); !written)
    return tl::unexpected(written.error());
  return 0;
}

Result<void> AudioJoiner::Add(const StreamDecoder& decoder) {
  const AVFrame& frame = decoder.frame();
  if (!writer_)
    if (auto begun = Begin(decoder); !begun) return begun;
  const auto format = libav::WavFormatOf(decoder.codec(), frame);
  if (!format || format->channels != sound_.format.channels ||
      format->rate_hz != sound_.format.rate_hz || format->bits != sound_.format.bits)
    return Fail(fmt::format("at {:.3f} s its rate, channels or samples change; cut the file there",
                            SecondsOfFrames(writer_->num_frames())));
  int first = 0;
  if (const auto time = decoder.time()) {
    const Result<int> placed = Place(frame, *time, decoder.tick());
    if (!placed) return tl::unexpected(placed.error());
    first = *placed;
  }
  return writer_->Write(libav::InterleavedBytes(frame, sound_.format, first));
}

Result<void> AudioJoiner::Finish() {
  if (!writer_) return Fail("none of its sound can be decoded");
  sound_.frames = writer_->num_frames();
  return writer_->Finish();
}

void NoteStreams(StreamDecoder& decoder, ExtractedAudio& sound) {
  if (const int count = decoder.input().num_audio_streams(); count > 1)
    sound.notes.push_back(
        fmt::format("the file has {} streams of sound, of which the main one "
                    "(number {} in the file) is taken",
                    count, decoder.stream().index));
}

}  // namespace

bool HasAudio(const fs::path& path) {
  const auto input = libav::Input::Open({path});
  return input && (*input)->audio_stream() != nullptr;
}

Result<ExtractedAudio> ExtractAudio(const std::vector<fs::path>& parts, const fs::path& wav_path) {
  const auto picture = FindPictures(parts);
  if (!picture) return tl::unexpected(picture.error());
  const Groups groups = *picture ? (*picture)->groups : Groups{{parts.front()}};
  ExtractedAudio sound;
  AudioJoiner joiner(wav_path, sound);
  std::int64_t num_damaged = 0;
  for (const auto& group : groups) {
    const auto decoder = StreamDecoder::Open(group, StreamKind::kAudio);
    if (!decoder) return tl::unexpected(decoder.error());
    NoteStreams(**decoder, sound);
    joiner.BeginGroup();
    for (Result<bool> more = (*decoder)->Next(); !more || *more; more = (*decoder)->Next()) {
      num_damaged += !more;
      if (!more) continue;
      if (const auto added = joiner.Add(**decoder); !added)
        return Fail(fmt::format("{}: {}", group[0].string(), added.error().message));
    }
  }
  if (const auto finished = joiner.Finish(); !finished)
    return Fail(fmt::format("{}: {}", parts[0].string(), finished.error().message));
  if (num_damaged > 0)
    sound.notes.push_back(fmt::format("{} pieces of the sound are damaged", num_damaged));
  if (*picture) sound.offset = joiner.start() - (*picture)->first;
  return sound;
}

}  // namespace articap
