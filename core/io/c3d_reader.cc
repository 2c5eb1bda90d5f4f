// SPDX-License-Identifier: MIT
// C3D as documented at c3d.org (the C3D File Format, User Guide), with the repairs that files in
// circulation need.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "core/io/c3d_layout.h"
#include "core/io/formats.h"
#include "core/io/marker_names.h"
#include "core/io/text.h"
#include "core/io/timing.h"
#include "core/io/units.h"

namespace articap {
namespace {

// The fourth word of a point: -1 where it was not seen, else the cameras' bits over the residual.
struct PointStatus {
  bool is_valid = false;
  std::uint8_t residual = 0;  // in steps of the scale; 0 for generated points
  std::uint8_t cameras = 0;   // 7 bits
};

PointStatus DecodeStatus(int word) {
  return {word >= 0, static_cast<std::uint8_t>(word & 0xFF),
          static_cast<std::uint8_t>(word >> 8 & 0x7F)};
}

struct PointSample {
  Eigen::Vector3d position;  // in the file's unit
  PointStatus status;
};

PointSample DecodePoint(const C3dBytes& bytes, const C3dLayout& layout, std::size_t at) {
  if (!layout.is_float) {
    // In floats, so that the result is what the same trial stored in floats holds.
    const auto scale = static_cast<float>(layout.scale);
    const Eigen::Vector3f steps(bytes.I16(at), bytes.I16(at + 2), bytes.I16(at + 4));
    return {(scale * steps).cast<double>(), DecodeStatus(bytes.I16(at + 6))};
  }
  const float word = bytes.F32(at + 12);
  // Cast to an integer first, as the format demands; what no 16-bit word can be is no status.
  const int status = word > -32769.F && word < 65536.F ? static_cast<int>(word) : 0;
  return {Eigen::Vector3d(bytes.F32(at), bytes.F32(at + 4), bytes.F32(at + 8)),
          DecodeStatus(status)};
}

// Vicon's model outputs (angles, forces, ...) are stored as points; these lists name them.
std::vector<int> FindMarkerPoints(const C3dParameters& parameters,
                                  const std::vector<std::string>& labels,
                                  std::vector<std::string>& warnings) {
  std::unordered_set<std::string> outputs;
  for (const char* list : {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS"})
    for (const std::string& name : parameters.Texts("POINT", list))
      if (!name.empty()) outputs.insert(name);
  std::vector<int> points;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (!outputs.contains(labels[i])) points.push_back(static_cast<int>(i));
  if (points.size() < labels.size())
    warnings.push_back(
        fmt::format("{} points are model outputs (angles, forces, ...), not positions; they were "
                    "left out.",
                    labels.size() - points.size()));
  return points;
}

struct DecodeCounts {
  int not_finite = 0;
  int at_zero = 0;
  int with_status = 0;  // whose residual or camera mask says something
};

void DecodePoints(const C3dBytes& bytes, const C3dLayout& layout, const std::vector<int>& points,
                  double mm_per_unit, bool zero_is_missing, MarkerRecording& recording,
                  DecodeCounts& counts) {
  StageTracks& tracks = recording.tracks;
  const auto step_mm = static_cast<float>(layout.scale * mm_per_unit);
  recording.residual_step_mm = step_mm;
  const std::size_t num_samples = points.size() * static_cast<std::size_t>(layout.num_frames);
  recording.residuals_mm.assign(num_samples, std::numeric_limits<float>::quiet_NaN());
  recording.camera_masks.assign(num_samples, 0);
  std::size_t sample = 0;
  for (int frame = 0; frame < layout.num_frames; ++frame) {
    const std::size_t frame_offset = layout.data_offset + frame * layout.frame_bytes();
    for (std::size_t marker = 0; marker < points.size(); ++marker, ++sample) {
      const PointSample point =
          DecodePoint(bytes, layout, frame_offset + points[marker] * 4 * layout.word_bytes);
      if (!point.status.is_valid) continue;
      const bool has_status = point.status.residual != 0 || point.status.cameras != 0;
      // In mm, too, it must be a number that a C3D file can hold.
      constexpr double kLargest_mm = std::numeric_limits<float>::max();
      if (!(mm_per_unit * point.position.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
            kLargest_mm)) {
        ++counts.not_finite;
      } else if (zero_is_missing && !has_status && point.position.isZero(0)) {
        ++counts.at_zero;
      } else {
        counts.with_status += has_status;
        tracks.Set(frame, static_cast<int>(marker), mm_per_unit * point.position);
        recording.residuals_mm[sample] = static_cast<float>(point.status.residual) * step_mm;
        recording.camera_masks[sample] = point.status.cameras;
      }
    }
  }
}

// Residual 0 without cameras marks a generated point, but only in files that keep residuals at all.
void InterpretResiduals(bool has_status, bool marks_states_only, MarkerRecording& recording) {
  StageTracks& tracks = recording.tracks;
  if (has_status || marks_states_only) {
    std::size_t sample = 0;
    for (int frame = 0; frame < tracks.num_frames(); ++frame)
      for (int marker = 0; marker < tracks.num_markers(); ++marker, ++sample)
        if (recording.residuals_mm[sample] == 0 && recording.camera_masks[sample] == 0)
          tracks.Set(frame, marker, tracks.position_mm(frame, marker), SampleState::kFilled);
  }
  const bool has_cameras = std::any_of(recording.camera_masks.begin(), recording.camera_masks.end(),
                                       [](std::uint8_t mask) { return mask != 0; });
  if (!has_cameras) recording.camera_masks.clear();
  if (!has_status || marks_states_only) {
    recording.residuals_mm.clear();
    recording.residual_step_mm = 0;
  }
}

void WarnOfCounts(const DecodeCounts& counts, std::vector<std::string>& warnings) {
  if (counts.not_finite > 0)
    warnings.push_back(fmt::format("{} samples are not finite numbers; they count as missing.",
                                   counts.not_finite));
  if (counts.at_zero > 0)
    warnings.push_back(fmt::format("{} samples are 0 0 0 with residual 0; they count as missing.",
                                   counts.at_zero));
}

AnalogData ReadAnalog(const C3dParameters& parameters, const C3dLayout& layout,
                      std::vector<std::string>& warnings) {
  AnalogData analog;
  if (layout.num_channels() == 0) return analog;
  analog.samples_per_frame = layout.samples_per_frame;
  analog.channels.resize(layout.num_channels());
  const bool is_unsigned = ToLower(parameters.Text("ANALOG", "FORMAT")) == "unsigned";
  const auto labels = parameters.Texts("ANALOG", "LABELS");
  const auto units = parameters.Texts("ANALOG", "UNITS");
  const auto descriptions = parameters.Texts("ANALOG", "DESCRIPTIONS");
  const auto scales = parameters.Numbers("ANALOG", "SCALE");
  const auto offsets = parameters.Numbers("ANALOG", "OFFSET", !is_unsigned);
  const double general_scale = parameters.Number("ANALOG", "GEN_SCALE").value_or(1);
  const C3dBytes& bytes = parameters.bytes();
  const std::size_t num_samples =
      static_cast<std::size_t>(layout.num_frames) * layout.samples_per_frame;
  std::size_t not_finite = 0;
  for (std::size_t i = 0; i < analog.channels.size(); ++i) {
    AnalogChannel& channel = analog.channels[i];
    channel.name = i < labels.size() ? labels[i] : "";
    channel.unit = i < units.size() ? units[i] : "";
    channel.description = i < descriptions.size() ? descriptions[i] : "";
    const double scale = (i < scales.size() ? scales[i] : 1) * general_scale;
    const double offset = i < offsets.size() ? offsets[i] : 0;
    channel.samples.resize(num_samples);
    for (std::size_t k = 0; k < num_samples; ++k) {
      const std::size_t frame = k / layout.samples_per_frame;
      const std::size_t word = 4 * static_cast<std::size_t>(layout.num_points) +
                               k % layout.samples_per_frame * analog.channels.size() + i;
      const std::size_t at =
          layout.data_offset + frame * layout.frame_bytes() + word * layout.word_bytes;
      const double raw = layout.is_float ? double(bytes.F32(at))
                         : is_unsigned   ? double(bytes.U16(at))
                                         : double(bytes.I16(at));
      channel.samples[k] = (raw - offset) * scale;
      not_finite += !std::isfinite(channel.samples[k]);
    }
  }
  if (not_finite > 0)
    warnings.push_back(fmt::format("{} analog samples are not finite numbers.", not_finite));
  return analog;
}

std::vector<MarkerEvent> ReadEventGroup(const C3dParameters& parameters,
                                        std::vector<std::string>& warnings) {
  const auto times = parameters.Numbers("EVENT", "TIMES");  // minutes, seconds of each
  const auto labels = parameters.Texts("EVENT", "LABELS");
  const auto contexts = parameters.Texts("EVENT", "CONTEXTS");
  const auto subjects = parameters.Texts("EVENT", "SUBJECTS");
  const auto descriptions = parameters.Texts("EVENT", "DESCRIPTIONS");
  const std::size_t num_pairs = times.size() / 2;  // minutes and seconds
  const auto timed = static_cast<double>(num_pairs);
  const double used = parameters.Number("EVENT", "USED").value_or(timed);
  const auto promised = static_cast<std::size_t>(used >= 0 && used < 65536 ? used : timed);
  std::vector<MarkerEvent> events;
  for (std::size_t i = 0; i < promised && 2 * i + 1 < times.size(); ++i) {
    MarkerEvent event;
    event.time_s = 60 * times[2 * i] + times[2 * i + 1];
    if (!IsUsableEventTime(event.time_s)) continue;
    if (i < labels.size()) event.label = labels[i];
    if (i < contexts.size()) event.context = contexts[i];
    if (i < subjects.size()) event.subject = subjects[i];
    if (i < descriptions.size()) event.description = descriptions[i];
    events.push_back(event);
  }
  if (events.size() < promised)
    warnings.push_back(fmt::format("EVENT:USED promises {} events, {} of them have a usable time.",
                                   promised, events.size()));
  return events;
}

// The header itself has room for 18 events of 4 letters.
std::vector<MarkerEvent> ReadHeaderEvents(const C3dBytes& bytes) {
  constexpr int kHasLabels = 12345;
  std::vector<MarkerEvent> events;
  if (bytes.U16(298) != kHasLabels) return events;
  const int count = std::min<int>(bytes.U16(300), 18);
  for (int i = 0; i < count; ++i) {
    MarkerEvent event;
    event.time_s = DecimalOf(bytes.F32(304 + 4 * i));
    if (!IsUsableEventTime(event.time_s)) continue;
    for (int k = 0; k < 4; ++k) event.label += static_cast<char>(bytes.U8(396 + 4 * i + k));
    event.label = CleanText(event.label.substr(0, event.label.find('\0')));
    events.push_back(event);
  }
  return events;
}

void WarnOfGroups(const C3dParameters& parameters, std::vector<std::string>& warnings) {
  static const std::unordered_set<std::string> kKept = {
      "POINT", "ANALOG", "EVENT", "TRIAL", "EVENT_CONTEXT", "MANUFACTURER", "SUBJECTS", "ARTICAP"};
  std::string names;
  for (const std::string& group : parameters.GroupNames())
    if (!kKept.contains(group)) names += (names.empty() ? "" : ", ") + group;
  if (!names.empty())
    warnings.push_back("Parameter groups that were not kept: " + Printable(names) + ".");
  const auto right = parameters.Texts("POINT", "X_SCREEN");
  const auto up = parameters.Texts("POINT", "Y_SCREEN");
  if (!right.empty() && !up.empty())
    warnings.push_back(
        fmt::format("POINT:X_SCREEN ({}) and Y_SCREEN ({}), the axes to the right and up on its "
                    "maker's screen, were not kept.",
                    Printable(right[0]), Printable(up[0])));
}

}  // namespace

Result<MarkerRecording> ReadC3d(std::span<const std::byte> bytes, const std::string& source_name,
                                const MarkerReadOptions& options) {
  if (bytes.size() < 2 * kC3dBlockBytes)
    return Fail(fmt::format("{}: {} bytes are too few for a C3D file; it was cut short",
                            source_name, bytes.size()));
  MarkerRecording recording;
  std::vector<std::string>& warnings = recording.warnings;
  const auto parameters = C3dParameters::Parse(bytes, source_name, warnings);
  if (!parameters) return tl::unexpected(parameters.error());
  const auto layout = FindC3dLayout(*parameters, source_name, options, warnings);
  if (!layout) return tl::unexpected(layout.error());

  std::vector<std::string> labels = parameters->Texts("POINT", "LABELS");
  labels.resize(layout->num_points);
  std::vector<std::string> descriptions = parameters->Texts("POINT", "DESCRIPTIONS");
  descriptions.resize(layout->num_points);
  const std::vector<int> points = FindMarkerPoints(*parameters, labels, warnings);
  std::vector<std::string> marker_labels;
  for (const int point : points) {
    marker_labels.push_back(labels[point]);
    recording.descriptions.push_back(descriptions[point]);
  }
  if (std::all_of(recording.descriptions.begin(), recording.descriptions.end(),
                  [](const std::string& text) { return text.empty(); }))
    recording.descriptions.clear();
  NamedMarkers named = NameMarkers(marker_labels, warnings);
  recording.subject = named.subject;

  recording.source_unit = parameters->Text("POINT", "UNITS");
  double mm_per_unit = 1;
  if (layout->num_points > 0 || !recording.source_unit.empty()) {
    const auto unit = ResolveUnit(recording.source_unit, options, source_name, warnings);
    if (!unit) return tl::unexpected(unit.error());
    recording.source_unit = unit->name;
    mm_per_unit = unit->mm_per_unit;
  }
  recording.tracks =
      StageTracks(std::move(named.names), layout->num_frames, layout->rate_hz, layout->first_frame,
                  NominalStart(layout->first_frame, layout->rate_hz));
  DecodeCounts counts;
  DecodePoints(parameters->bytes(), *layout, points, mm_per_unit, options.zero_is_missing,
               recording, counts);
  InterpretResiduals(counts.with_status > 0, parameters->Text("ARTICAP", "RESIDUALS") == "state",
                     recording);
  WarnOfCounts(counts, warnings);
  recording.analog = ReadAnalog(*parameters, *layout, warnings);
  recording.events = parameters->Find("EVENT", "TIMES") ? ReadEventGroup(*parameters, warnings)
                                                        : ReadHeaderEvents(parameters->bytes());
  WarnOfGroups(*parameters, warnings);
  return recording;
}

}  // namespace articap
