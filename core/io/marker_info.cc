// SPDX-License-Identifier: MIT
#include "core/io/marker_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/io/units.h"
#include "core/marker_io.h"
#include "core/statistics.h"

namespace articap {
namespace {

struct Gaps {
  int count = 0;
  int longest = 0;
};

Gaps FindGaps(const StageTracks& tracks, int marker) {
  Gaps gaps;
  int length = 0;
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    length = tracks.is_missing(frame, marker) ? length + 1 : 0;
    gaps.count += length == 1;
    gaps.longest = std::max(gaps.longest, length);
  }
  return gaps;
}

int CountFilled(const StageTracks& tracks, int marker) {
  int count = 0;
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    count += tracks.state(frame, marker) == SampleState::kFilled;
  return count;
}

// Size of the box that a marker moved in.
Eigen::Vector3d RangeOf(const StageTracks& tracks, int marker) {
  Eigen::AlignedBox3d box;
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    if (!tracks.is_missing(frame, marker)) box.extend(tracks.position_mm(frame, marker));
  if (box.isEmpty()) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return box.sizes();
}

double MeanResidual(const MarkerRecording& recording, int marker) {
  double sum = 0;
  int count = 0;
  const int num_markers = recording.tracks.num_markers();
  for (int frame = 0; frame < recording.tracks.num_frames(); ++frame) {
    if (recording.tracks.state(frame, marker) != SampleState::kMeasured) continue;
    const float residual =
        recording.residuals_mm[static_cast<std::size_t>(frame) * num_markers + marker];
    if (!std::isfinite(residual)) continue;
    sum += residual;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

ReportTable DescribeMarkers(const MarkerRecording& recording) {
  const StageTracks& tracks = recording.tracks;
  ReportTable table{
      "marker",
      {"missing", "gaps", "longest_gap", "filled", "range_x_mm", "range_y_mm", "range_z_mm"},
      {}};
  if (!recording.residuals_mm.empty()) table.columns.push_back("residual_mm");
  for (int marker = 0; marker < tracks.num_markers(); ++marker) {
    const Gaps gaps = FindGaps(tracks, marker);
    const Eigen::Vector3d range = RangeOf(tracks, marker);
    ReportTable::Row row{
        tracks.names()[marker],
        {double(tracks.CountMissing(marker)), double(gaps.count), double(gaps.longest),
         double(CountFilled(tracks, marker)), range.x(), range.y(), range.z()}};
    if (!recording.residuals_mm.empty()) row.values.push_back(MeanResidual(recording, marker));
    table.rows.push_back(row);
  }
  return table;
}

ReportTable DescribeEvents(const MarkerRecording& recording) {
  ReportTable table{"event", {"time_s"}, {}};
  for (const MarkerEvent& event : recording.events) {
    std::string label = event.label;
    for (const std::string* part : {&event.context, &event.subject})
      if (!part->empty()) label += " (" + *part + ")";
    table.rows.push_back({label, {event.time_s}});
  }
  return table;
}

ReportTable DescribeAnalog(const AnalogData& analog) {
  ReportTable table{"analog", {"minimum", "mean", "maximum"}, {}};
  for (const AnalogChannel& channel : analog.channels) {
    const std::string label =
        channel.unit.empty() ? channel.name : channel.name + " [" + channel.unit + "]";
    if (channel.samples.empty()) {
      table.rows.push_back({label, {}});
      continue;
    }
    double sum = 0;
    for (const double sample : channel.samples) sum += sample;
    const auto [low, high] = std::minmax_element(channel.samples.begin(), channel.samples.end());
    table.rows.push_back({label, {*low, sum / double(channel.samples.size()), *high}});
  }
  return table;
}

// Frames in which a marker that the file knows was not seen; a dropped frame is one without any.
struct Drops {
  std::int64_t missing = 0;
  int frames_without_markers = 0;
  int complete_frames = 0;
};

Drops CountDrops(const StageTracks& tracks) {
  Drops drops;
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    const auto states = tracks.states(frame);
    const auto missing = std::count(states.begin(), states.end(), SampleState::kMissing);
    drops.missing += missing;
    drops.complete_frames += missing == 0;
    drops.frames_without_markers += tracks.num_markers() > 0 && missing == tracks.num_markers();
  }
  return drops;
}

}  // namespace

double MedianExtentMm(const StageTracks& tracks) {
  // A few thousand frames spread over the take tell the median well enough.
  const int step = std::max(1, tracks.num_frames() / 2000);
  std::vector<double> diagonals_mm;
  for (int frame = 0; frame < tracks.num_frames(); frame += step) {
    Eigen::AlignedBox3d box;
    int seen = 0;
    for (int marker = 0; marker < tracks.num_markers(); ++marker)
      if (!tracks.is_missing(frame, marker)) {
        box.extend(tracks.position_mm(frame, marker));
        ++seen;
      }
    if (seen >= 2) diagonals_mm.push_back(box.diagonal().norm());
  }
  return diagonals_mm.empty() ? 0 : MedianOf(std::move(diagonals_mm));
}

StageReport DescribeRecording(const MarkerRecording& recording, const std::string& source_name) {
  const StageTracks& tracks = recording.tracks;
  const Drops drops = CountDrops(tracks);
  const double duration_s = tracks.num_frames() / tracks.rate_hz();
  const std::int64_t num_samples = std::int64_t{tracks.num_frames()} * tracks.num_markers();
  StageReport report;
  report.stage = "info";
  report.usable = num_samples > drops.missing;
  report.verdict =
      fmt::format("{}: {} markers, {} frames at {} Hz ({:.2f} s), {} of {} samples missing",
                  source_name, tracks.num_markers(), tracks.num_frames(), tracks.rate_hz(),
                  duration_s, drops.missing, num_samples);
  report.texts.emplace_back("unit in the file",
                            recording.source_unit.empty() ? "-" : recording.source_unit);
  if (!recording.subject.empty()) report.texts.emplace_back("subject", recording.subject);
  report.figures = {{"markers", tracks.num_markers()},
                    {"frames", tracks.num_frames()},
                    {"rate_hz", tracks.rate_hz()},
                    {"duration_s", duration_s},
                    {"first_frame", tracks.first_frame()},
                    {"start_s", SecondsOf(tracks.start())},
                    {"missing_samples", double(drops.missing)},
                    {"complete_frames", drops.complete_frames},
                    {"frames_without_markers", drops.frames_without_markers},
                    {"median_extent_mm", MedianExtentMm(tracks)},
                    {"events", double(recording.events.size())},
                    {"analog_channels", double(recording.analog.channels.size())}};
  if (!recording.analog.channels.empty())
    report.figures.emplace_back("analog_rate_hz",
                                tracks.rate_hz() * recording.analog.samples_per_frame);
  if (tracks.num_markers() > 0) report.tables.push_back(DescribeMarkers(recording));
  if (!recording.events.empty()) report.tables.push_back(DescribeEvents(recording));
  if (!recording.analog.channels.empty()) report.tables.push_back(DescribeAnalog(recording.analog));
  report.warnings = recording.warnings;
  if (const auto size = ImplausibleSize(recording)) report.warnings.push_back(*size);
  return report;
}

// Bounds: lips and jaw alone span some 45 mm, a head with spectacles and a collar some 450 mm. They
// are less than a factor of 20 apart, so that centimetres or metres taken for millimetres (and the
// reverse) fall outside for every ordinary set of 60 to 350 mm.
std::optional<std::string> ImplausibleSize(const MarkerRecording& recording) {
  constexpr double kSmallest_mm = 36;
  constexpr double kLargest_mm = 600;
  constexpr double kTypical_mm = 200;
  const double extent_mm = MedianExtentMm(recording.tracks);
  if (extent_mm == 0 || (extent_mm >= kSmallest_mm && extent_mm <= kLargest_mm))
    return std::nullopt;
  const auto assumed = ParseLengthUnit(recording.source_unit);
  const double mm_per_assumed = assumed ? assumed->mm_per_unit : 1;
  const LengthUnit* likeliest = nullptr;
  double best = std::numeric_limits<double>::infinity();
  for (const LengthUnit& unit : AllLengthUnits()) {
    const double size_mm = extent_mm / mm_per_assumed * unit.mm_per_unit;
    const double distance = std::abs(std::log(size_mm / kTypical_mm));
    if (size_mm < kSmallest_mm || size_mm > kLargest_mm || distance >= best) continue;
    best = distance;
    likeliest = &unit;
  }
  std::string message =
      fmt::format("The markers span {:.4g} mm (median over frames), a face {:g} to {:g} mm.",
                  extent_mm, kSmallest_mm, kLargest_mm);
  if (!likeliest || likeliest->mm_per_unit == mm_per_assumed)
    return message + " No unit makes a face of them: is more than one head in the volume?";
  return message +
         fmt::format(" The numbers look like {}: read the file with {} {}.", likeliest->name,
                     recording.source_unit.empty() ? "--unit" : "--force-unit", likeliest->name);
}

}  // namespace articap
