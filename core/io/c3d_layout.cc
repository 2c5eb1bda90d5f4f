// SPDX-License-Identifier: MIT
#include "core/io/c3d_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/io/text.h"
#include "core/io/timing.h"

namespace articap {
namespace {

// Offsets in the header block, all in bytes.
constexpr std::size_t kNumPoints = 2;
constexpr std::size_t kAnalogPerFrame = 4;
constexpr std::size_t kFirstFrame = 6;
constexpr std::size_t kLastFrame = 8;
constexpr std::size_t kScale = 12;
constexpr std::size_t kDataStart = 16;
constexpr std::size_t kSamplesPerFrame = 18;
constexpr std::size_t kRate = 20;

struct FrameRange {
  std::int64_t first = 1;
  std::int64_t count = 0;
  const char* source = "";
};

// TRIAL fields are 32-bit numbers in two 16-bit words, low word first; some programs write a float.
std::optional<std::int64_t> TrialField(const C3dParameters& parameters, const char* name) {
  const std::vector<double> words = parameters.Numbers("TRIAL", name);
  if (words.empty() || !std::isfinite(words[0]) || std::abs(words[0]) > 4e9) return std::nullopt;
  const auto low = static_cast<std::int64_t>(words[0]);
  if (words.size() == 1 || parameters.Find("TRIAL", name)->type != 2) return low;
  return low + (static_cast<std::int64_t>(words[1]) << 16);
}

FrameRange HeaderFrames(const C3dBytes& bytes) {
  const std::int64_t first = bytes.U16(kFirstFrame);
  return {first, std::max<std::int64_t>(0, bytes.U16(kLastFrame) - first + 1), "the header"};
}

// All that the file says about its frames, most trustworthy first.
std::vector<FrameRange> PromisedFrames(const C3dParameters& parameters) {
  const FrameRange header = HeaderFrames(parameters.bytes());
  std::vector<FrameRange> ranges;
  const auto start = TrialField(parameters, "ACTUAL_START_FIELD");
  const auto end = TrialField(parameters, "ACTUAL_END_FIELD");
  if (start && end && *end >= *start)
    ranges.push_back({*start, *end - *start + 1, "TRIAL:ACTUAL_END_FIELD"});
  const auto add_count = [&](const char* name, const char* source) {
    const auto count = parameters.Number("POINT", name);
    if (count && std::isfinite(*count) && *count > 0 && *count < 4e9)
      ranges.push_back({header.first, static_cast<std::int64_t>(*count), source});
  };
  const C3dParameter* frames = parameters.Find("POINT", "FRAMES");
  const bool has_wide_frames = frames && frames->type == 4;
  add_count("LONG_FRAMES", "POINT:LONG_FRAMES");
  if (has_wide_frames) add_count("FRAMES", "POINT:FRAMES");
  ranges.push_back(header);
  if (!has_wide_frames) add_count("FRAMES", "POINT:FRAMES");
  return ranges;
}

// Files of more than 65535 frames without the fields for so many: their 16-bit counts stop at 65535
// or wrap around.
std::optional<FrameRange> ExtendHeader(const C3dBytes& bytes, std::int64_t capacity,
                                       std::int64_t fitting_from) {
  FrameRange header = HeaderFrames(bytes);
  if (capacity <= header.count) return std::nullopt;
  if (bytes.U16(kLastFrame) == 65535) {
    header.count = capacity;
    return header;
  }
  header.count += (capacity - header.count) / 65536 * 65536;
  if (header.count < 65536 || header.count < fitting_from) return std::nullopt;
  return header;
}

// Chooses among the promises by what the file's size allows: all data but the last block's padding
// should be frames.
FrameRange ChooseFrames(const C3dParameters& parameters, const C3dLayout& layout,
                        std::vector<std::string>& warnings) {
  const std::vector<FrameRange> promises = PromisedFrames(parameters);
  const FrameRange header = HeaderFrames(parameters.bytes());
  FrameRange chosen = promises.front();
  const std::size_t frame_bytes = layout.frame_bytes();
  if (frame_bytes == 0) {
    if (chosen.count > 0)
      warnings.push_back(fmt::format(
          "The file promises {} frames but has neither points nor analog channels.", chosen.count));
    return {chosen.first, 0, chosen.source};
  }
  const std::size_t available = parameters.bytes().size() - layout.data_offset;
  const auto capacity = static_cast<std::int64_t>(available / frame_bytes);
  const auto fitting_from = static_cast<std::int64_t>(
      available < kC3dBlockBytes ? 0 : (available - kC3dBlockBytes) / frame_bytes + 1);
  for (const FrameRange& promise : promises)
    if (promise.count <= capacity && promise.count >= fitting_from) {
      if (promise.count != header.count && header.count > 0 && promise.count < 65535)
        warnings.push_back(
            fmt::format("The header promises {} frames, {} {}; the latter fits the "
                        "file's size and was followed.",
                        header.count, promise.source, promise.count));
      return promise;
    }
  if (const auto extended = ExtendHeader(parameters.bytes(), capacity, fitting_from)) {
    warnings.push_back(
        fmt::format("The header's frame count ({}) is too small a number for the {} frames that "
                    "the file holds.",
                    header.count, extended->count));
    return *extended;
  }
  if (chosen.count > capacity) {
    warnings.push_back(fmt::format(
        "The file should have {} frames ({}) but holds {}; {} are missing: it was cut short, and "
        "what is there was kept.",
        chosen.count, chosen.source, capacity, chosen.count - capacity));
    chosen.count = capacity;
  } else {
    warnings.push_back(fmt::format("{} bytes after the {} frames that {} promises were not read.",
                                   available - static_cast<std::size_t>(chosen.count) * frame_bytes,
                                   chosen.count, chosen.source));
  }
  return chosen;
}

Result<std::size_t> FindData(const C3dParameters& parameters, const std::string& source_name,
                             std::vector<std::string>& warnings) {
  const C3dBytes& bytes = parameters.bytes();
  const std::size_t num_blocks = bytes.size() / kC3dBlockBytes + 1;
  const std::size_t in_header = bytes.U16(kDataStart);
  const auto number = parameters.Number("POINT", "DATA_START");
  const std::size_t in_parameters =
      number && *number > 0 && *number < 65536 ? static_cast<std::size_t>(*number) : 0;
  const auto possible = [&](std::size_t block) { return block >= 2 && block <= num_blocks; };
  if (possible(in_header)) {
    if (possible(in_parameters) && in_parameters != in_header)
      warnings.push_back(fmt::format(
          "The header puts the data into block {}, POINT:DATA_START into block {}; the header was "
          "followed.",
          in_header, in_parameters));
    return (in_header - 1) * kC3dBlockBytes;
  }
  if (possible(in_parameters)) {
    warnings.push_back(
        fmt::format("The header does not say where the data are ({}); POINT:DATA_START (block {}) "
                    "was followed.",
                    in_header, in_parameters));
    return (in_parameters - 1) * kC3dBlockBytes;
  }
  return Fail(
      fmt::format("{}: the data should begin in block {}, but the file has {} bytes; it was "
                  "cut short or is damaged",
                  source_name, in_header ? in_header : in_parameters, bytes.size()));
}

Result<double> FindRate(const C3dParameters& parameters, const std::string& source_name,
                        const MarkerReadOptions& options, std::vector<std::string>& warnings) {
  const double in_header = DecimalOf(parameters.bytes().F32(kRate));
  const auto number = parameters.Number("POINT", "RATE");
  const double in_parameters = number ? DecimalOf(static_cast<float>(*number)) : 0;
  double rate_hz = IsUsableRate(in_parameters) ? in_parameters : in_header;
  if (IsUsableRate(in_parameters) && IsUsableRate(in_header) &&
      std::abs(in_parameters - in_header) > 1e-6 * in_parameters)
    warnings.push_back(
        fmt::format("The header says {} frames a second, POINT:RATE {}; POINT:RATE was followed.",
                    in_header, in_parameters));
  if (options.rate_hz && IsUsableRate(rate_hz) &&
      std::abs(*options.rate_hz - rate_hz) > 1e-6 * rate_hz)
    return Fail(
        fmt::format("{}: the file says {} frames a second, the option says {}; leave "
                    "--rate-hz out",
                    source_name, rate_hz, *options.rate_hz));
  if (!IsUsableRate(rate_hz)) {
    if (!options.rate_hz || !IsUsableRate(*options.rate_hz))
      return Fail(fmt::format("{}: the file's frame rate is {}; give the rate with --rate-hz 100",
                              source_name, number ? in_parameters : in_header));
    warnings.push_back(fmt::format("The file's frame rate ({}) was replaced by the option's ({}).",
                                   number ? in_parameters : in_header, *options.rate_hz));
    rate_hz = *options.rate_hz;
  }
  return rate_hz;
}

// The sign of the scale says whether samples are floats (negative) or integers.
Result<double> FindScale(const C3dParameters& parameters, const std::string& source_name,
                         std::vector<std::string>& warnings) {
  const double in_header = parameters.bytes().F32(kScale);
  const auto in_parameters = parameters.Number("POINT", "SCALE");
  const auto is_scale = [](double scale) {
    return std::abs(scale) > 1e-12 && std::abs(scale) < 1e9;
  };
  if (in_parameters && is_scale(*in_parameters)) {
    if (is_scale(in_header) &&
        std::abs(in_header - *in_parameters) > 1e-5 * std::abs(*in_parameters))
      warnings.push_back(fmt::format(
          "The header's scale factor is {:g}, POINT:SCALE {:g}; POINT:SCALE was followed.",
          in_header, *in_parameters));
    return *in_parameters;
  }
  if (is_scale(in_header)) return in_header;
  return Fail(fmt::format("{}: the scale factor of the points is {:g}: the file is damaged",
                          source_name, in_header));
}

void FindCounts(const C3dParameters& parameters, C3dLayout& layout,
                std::vector<std::string>& warnings) {
  const C3dBytes& bytes = parameters.bytes();
  layout.num_points = bytes.U16(kNumPoints);
  layout.analog_per_frame = bytes.U16(kAnalogPerFrame);
  layout.samples_per_frame = bytes.U16(kSamplesPerFrame);
  const auto used = parameters.Number("POINT", "USED");
  if (used && *used != layout.num_points)
    warnings.push_back(
        fmt::format("The header counts {} points, POINT:USED {}; the header was followed.",
                    layout.num_points, *used));
  if (layout.analog_per_frame > 0 &&
      (layout.samples_per_frame == 0 || layout.analog_per_frame % layout.samples_per_frame != 0)) {
    warnings.push_back(fmt::format(
        "{} analog numbers a frame cannot be {} samples a channel; the analog data were left out.",
        layout.analog_per_frame, layout.samples_per_frame));
    layout.samples_per_frame = 0;
  }
}

}  // namespace

double DecimalOf(float value) { return ParseNumber(fmt::format("{}", value)).value_or(value); }

Result<C3dLayout> FindC3dLayout(const C3dParameters& parameters, const std::string& source_name,
                                const MarkerReadOptions& options,
                                std::vector<std::string>& warnings) {
  C3dLayout layout;
  FindCounts(parameters, layout, warnings);
  const auto data_offset = FindData(parameters, source_name, warnings);
  if (!data_offset) return tl::unexpected(data_offset.error());
  const auto rate_hz = FindRate(parameters, source_name, options, warnings);
  if (!rate_hz) return tl::unexpected(rate_hz.error());
  if (layout.num_points > 0 || layout.analog_per_frame > 0) {
    const auto scale = FindScale(parameters, source_name, warnings);
    if (!scale) return tl::unexpected(scale.error());
    layout.is_float = *scale < 0;
    layout.scale = std::abs(*scale);
  }
  layout.word_bytes = layout.is_float ? 4 : 2;
  layout.data_offset = std::min(*data_offset, parameters.bytes().size());
  layout.rate_hz = *rate_hz;
  const FrameRange frames = ChooseFrames(parameters, layout, warnings);
  constexpr std::int64_t kMostFrames = std::numeric_limits<int>::max() / 2;
  if (frames.count == 0 && parameters.bytes().size() < layout.frame_bytes())
    return Fail(fmt::format(
        "{}: {} points and {} analog numbers a frame cannot be in a file of {} bytes: the header "
        "is "
        "damaged",
        source_name, layout.num_points, layout.analog_per_frame, parameters.bytes().size()));
  layout.first_frame = static_cast<int>(std::clamp<std::int64_t>(frames.first, 0, kMostFrames));
  layout.num_frames = static_cast<int>(std::min(frames.count, kMostFrames));
  return layout;
}

}  // namespace articap
