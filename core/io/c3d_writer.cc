// SPDX-License-Identifier: MIT
// Writes C3D as most programs read it: Intel floats in mm, the parameter section in block 2.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/io/c3d_bytes.h"
#include "core/io/c3d_layout.h"
#include "core/io/c3d_sections.h"
#include "core/io/formats.h"
#include "core/io/marker_names.h"
#include "core/io/text.h"
#include "core/io/timing.h"
#include "core/version.h"

namespace articap {
namespace {

constexpr int kMost16Bit = 65535;
constexpr std::size_t kMostParameterBlocks = 255;
constexpr int kMostResidualSteps = 255;

// What the fourth word of a point says of it.
class StatusWords {
 public:
  explicit StatusWords(const MarkerRecording& recording)
      : recording_(recording), step_mm_(C3dResidualStep(recording)) {
    for (int frame = 0; frame < recording.tracks.num_frames() && !has_filled_; ++frame)
      for (const SampleState state : recording.tracks.states(frame))
        has_filled_ |= state == SampleState::kFilled;
  }

  float step_mm() const { return step_mm_; }
  // Without residuals, the word still tells measured samples (one step) from filled ones (none).
  bool mark_states_only() const { return recording_.residuals_mm.empty() && has_filled_; }

  float Of(int frame, int marker) const {
    const SampleState state = recording_.tracks.state(frame, marker);
    if (state == SampleState::kMissing) return -1;
    if (state == SampleState::kFilled) return 0;
    const std::size_t sample =
        static_cast<std::size_t>(frame) * recording_.tracks.num_markers() + marker;
    const int mask = recording_.camera_masks.empty() ? 0 : recording_.camera_masks[sample] & 0x7F;
    int steps = mark_states_only() ? 1 : 0;
    if (!recording_.residuals_mm.empty()) {
      const float residual = recording_.residuals_mm[sample];
      if (std::isfinite(residual) && residual > 0)
        steps =
            static_cast<int>(std::min(std::lround(residual / step_mm_), long{kMostResidualSteps}));
      // 0 without cameras would say "generated".
      if (mask == 0) steps = std::max(steps, 1);
    }
    return static_cast<float>(mask << 8 | steps);
  }

 private:
  const MarkerRecording& recording_;
  float step_mm_;
  bool has_filled_ = false;
};

std::vector<std::string> Cleaned(std::vector<std::string> texts) {
  for (std::string& text : texts) text = CleanText(text);
  return texts;
}

template <class Items, class Member>
std::vector<std::string> TextsOf(const Items& items, Member member) {
  std::vector<std::string> texts;
  for (const auto& item : items) texts.push_back(CleanText(item.*member));
  return texts;
}

std::vector<int> SplitWords(std::int64_t value) {
  return {static_cast<int>(value & 0xFFFF), static_cast<int>(value >> 16 & 0xFFFF)};
}

struct FrameNumbers {
  std::int64_t first;
  int count;
  std::int64_t last() const { return first + count - 1; }
};

// A file counts its frames by their bytes: without points and channels there are none.
FrameNumbers NumbersOf(const MarkerRecording& recording) {
  const bool has_data = recording.tracks.num_markers() > 0 || !recording.analog.channels.empty();
  const int count = has_data ? recording.tracks.num_frames() : 0;
  // Only the TRIAL group, which a file without frames lacks, has room for larger numbers.
  const int largest = count > 0 ? std::numeric_limits<int>::max() : kMost16Bit;
  return {std::clamp(recording.tracks.first_frame(), 0, largest), count};
}

void WritePointGroup(const MarkerRecording& recording, float scale, int data_block,
                     C3dParameterWriter& writer) {
  const StageTracks& tracks = recording.tracks;
  writer.BeginGroup("POINT");
  writer.Add("USED", tracks.num_markers());
  writer.Add("SCALE", scale);
  writer.Add("RATE", static_cast<float>(tracks.rate_hz()));
  writer.Add("DATA_START", std::min(data_block, kMost16Bit));
  const int num_frames = NumbersOf(recording).count;
  writer.Add("FRAMES", std::min(num_frames, kMost16Bit));
  if (num_frames > kMost16Bit) writer.Add("LONG_FRAMES", static_cast<float>(num_frames));
  writer.Add("UNITS", "mm");
  writer.AddTextList("LABELS", LabelsToWrite(recording));
  const std::vector<std::string> descriptions = Cleaned(recording.descriptions);
  if (std::any_of(descriptions.begin(), descriptions.end(),
                  [](const std::string& text) { return !text.empty(); }))
    writer.AddTextList("DESCRIPTIONS", descriptions);
}

void WriteTrialGroups(const MarkerRecording& recording, bool mark_states_only,
                      C3dParameterWriter& writer) {
  const FrameNumbers frames = NumbersOf(recording);
  if (frames.count > 0) {
    writer.BeginGroup("TRIAL");
    writer.AddWords("ACTUAL_START_FIELD", SplitWords(frames.first), {2});
    writer.AddWords("ACTUAL_END_FIELD", SplitWords(frames.last()), {2});
  }
  std::vector<std::string> ignored_warnings;
  const std::string subject = NameMarkers(LabelsToWrite(recording), ignored_warnings).subject;
  if (!subject.empty()) {
    writer.BeginGroup("SUBJECTS");
    writer.Add("USED", 1);
    writer.AddTextList("NAMES", {subject});
    writer.AddTextList("LABEL_PREFIXES", {subject + ":"});
  }
  writer.BeginGroup("MANUFACTURER");
  writer.Add("COMPANY", "articap");
  writer.BeginGroup("ARTICAP");
  writer.Add("RESIDUALS", mark_states_only                 ? "state"
                          : recording.residuals_mm.empty() ? "none"
                                                           : "mm");
}

void WriteAnalogGroup(const AnalogData& analog, double rate_hz, C3dParameterWriter& writer) {
  writer.BeginGroup("ANALOG");
  writer.Add("USED", static_cast<int>(analog.channels.size()));
  if (analog.channels.empty()) return;
  const std::size_t count = analog.channels.size();
  writer.Add("RATE", static_cast<float>(rate_hz * analog.samples_per_frame));
  writer.Add("GEN_SCALE", 1.F);
  writer.AddTextList("LABELS", TextsOf(analog.channels, &AnalogChannel::name));
  writer.AddTextList("DESCRIPTIONS", TextsOf(analog.channels, &AnalogChannel::description));
  writer.AddTextList("UNITS", TextsOf(analog.channels, &AnalogChannel::unit));
  writer.AddFloatList("SCALE", std::vector<float>(count, 1));
  writer.AddWordList("OFFSET", std::vector<int>(count, 0));
}

// Times are minutes and seconds; rounding to microseconds first keeps them stable when a file is
// written, read and written again.
void WriteEventGroup(const std::vector<MarkerEvent>& events, C3dParameterWriter& writer) {
  if (events.empty()) return;
  std::vector<float> times;
  for (const MarkerEvent& event : events) {
    const double time_s = std::round(event.time_s * 1e6) * 1e-6 + 0.0;  // no -0
    double minutes = std::trunc(time_s / 60) + 0.0;
    auto seconds = static_cast<float>(time_s - 60 * minutes);
    if (std::abs(seconds) >= 60) {
      minutes += std::copysign(1.0, time_s);
      seconds = 0;
    }
    times.push_back(static_cast<float>(minutes));
    times.push_back(seconds);
  }
  writer.BeginGroup("EVENT");
  writer.Add("USED", static_cast<int>(events.size()));
  writer.AddTextList("CONTEXTS", TextsOf(events, &MarkerEvent::context));
  writer.AddTextList("LABELS", TextsOf(events, &MarkerEvent::label));
  writer.AddTextList("DESCRIPTIONS", TextsOf(events, &MarkerEvent::description));
  writer.AddTextList("SUBJECTS", TextsOf(events, &MarkerEvent::subject));
  writer.AddFloatList("TIMES", times, 2);
  writer.AddWordList("ICON_IDS", std::vector<int>(events.size(), 0));
}

std::string FormatParameters(const MarkerRecording& recording, const StatusWords& status,
                             int data_block) {
  C3dParameterWriter writer;
  WritePointGroup(recording, -status.step_mm(), data_block, writer);
  WriteAnalogGroup(recording.analog, recording.tracks.rate_hz(), writer);
  WriteEventGroup(UsableEvents(recording.events), writer);
  WriteTrialGroups(recording, status.mark_states_only(), writer);
  return std::move(writer).Finish();
}

std::int64_t AnalogPerFrame(const AnalogData& analog) {
  return static_cast<std::int64_t>(analog.channels.size()) * analog.samples_per_frame;
}

void WriteHeader(const MarkerRecording& recording, float scale, int data_block, C3dOutput& out) {
  const FrameNumbers frames = NumbersOf(recording);
  const auto limit = [](std::int64_t number) {
    return static_cast<int>(std::clamp<std::int64_t>(number, 0, kMost16Bit));
  };
  out.U8(2);  // the block of the parameters
  out.U8(kC3dKey);
  out.U16(recording.tracks.num_markers());
  out.U16(static_cast<int>(AnalogPerFrame(recording.analog)));
  out.U16(limit(frames.first));
  out.U16(limit(frames.last()));
  out.U16(0);  // no gap was interpolated by this file's maker
  out.F32(scale);
  out.U16(data_block);
  out.U16(recording.analog.channels.empty() ? 0 : recording.analog.samples_per_frame);
  out.F32(static_cast<float>(recording.tracks.rate_hz()));
  out.PadToBlock();
}

void WritePoint(const MarkerRecording& recording, const StatusWords& status, int frame, int marker,
                C3dOutput& out) {
  float word = status.Of(frame, marker);
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  if (word >= 0) {
    position = recording.tracks.position_mm(frame, marker).cast<float>();
    if (!position.allFinite()) {  // beyond what a float holds
      position.setZero();
      word = -1;
    }
    // Readers take the very origin with an empty status as "not seen".
    if (word == 0 && position.isZero(0)) position.x() = 1e-4F;
  }
  for (const float coordinate : position) out.F32(coordinate);
  out.F32(word);
}

void WriteData(const MarkerRecording& recording, const StatusWords& status, C3dOutput& out) {
  const AnalogData& analog = recording.analog;
  for (int frame = 0; frame < recording.tracks.num_frames(); ++frame) {
    for (int marker = 0; marker < recording.tracks.num_markers(); ++marker)
      WritePoint(recording, status, frame, marker, out);
    for (int k = 0; k < analog.samples_per_frame; ++k)
      for (const AnalogChannel& channel : analog.channels) {
        const std::size_t sample = static_cast<std::size_t>(frame) * analog.samples_per_frame + k;
        const auto value = static_cast<float>(channel.samples[sample]);
        out.F32(std::isnan(value) ? std::numeric_limits<float>::quiet_NaN() : value);
      }
  }
  out.PadToBlock();
}

}  // namespace

// The step that residuals are rounded to: the source's own where it reaches far enough, else the
// smallest power of two that does. Powers of two make the choice stable: the rounded residuals lead
// to the same step again.
float C3dResidualStep(const MarkerRecording& recording) {
  constexpr float kFinest = 1.F / 1024;
  float largest = 0;
  for (const float residual : recording.residuals_mm)
    if (std::isfinite(residual)) largest = std::max(largest, residual);
  const auto reaches = [&](float step) {
    return std::isfinite(step) && step > 1e-9F && largest <= kMostResidualSteps * step * 1.0001F;
  };
  if (!recording.residuals_mm.empty() && reaches(recording.residual_step_mm))
    return recording.residual_step_mm;
  float step = kFinest;
  while (step < 1e6F && !reaches(step)) step *= 2;
  return step;
}

std::optional<std::string> C3dLimitExceeded(const MarkerRecording& recording) {
  if (recording.tracks.num_markers() > kMost16Bit)
    return fmt::format("{} markers; a C3D file holds at most {}", recording.tracks.num_markers(),
                       kMost16Bit);
  if (AnalogPerFrame(recording.analog) > kMost16Bit)
    return fmt::format("{} analog samples a frame; a C3D file holds at most {}",
                       AnalogPerFrame(recording.analog), kMost16Bit);
  const std::size_t num_blocks =
      FormatParameters(recording, StatusWords(recording), 0).size() / kC3dBlockBytes;
  if (num_blocks > kMostParameterBlocks)
    return fmt::format("names, descriptions and events of {} blocks; a C3D file holds at most {}",
                       num_blocks, kMostParameterBlocks);
  return std::nullopt;
}

std::string WriteC3d(const MarkerRecording& recording) {
  const StatusWords status(recording);
  // The section's size does not depend on the number that it is asked to hold.
  const std::size_t num_parameter_blocks =
      FormatParameters(recording, status, 0).size() / kC3dBlockBytes;
  ARTICAP_CHECK_LE(recording.tracks.num_markers(), kMost16Bit);
  ARTICAP_CHECK_LE(AnalogPerFrame(recording.analog), kMost16Bit);
  ARTICAP_CHECK_LE(num_parameter_blocks, kMostParameterBlocks);
  const int data_block = static_cast<int>(num_parameter_blocks) + 2;
  const std::size_t frame_bytes = 16 * static_cast<std::size_t>(recording.tracks.num_markers()) +
                                  4 * static_cast<std::size_t>(AnalogPerFrame(recording.analog));
  C3dOutput out;
  out.Reserve((num_parameter_blocks + 2) * kC3dBlockBytes +
              frame_bytes * static_cast<std::size_t>(recording.tracks.num_frames()));
  WriteHeader(recording, -status.step_mm(), data_block, out);
  out.Append(FormatParameters(recording, status, data_block));
  WriteData(recording, status, out);
  return std::move(out.bytes());
}

}  // namespace articap
