// SPDX-License-Identifier: MIT
#include "tracking/labelled_markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/statistics.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Views that C3D has a bit for.
constexpr int kMostMaskedViews = 7;

int NumMarkers(const MarkerTemplate& marker_template) {
  return static_cast<int>(marker_template.markers.size());
}

MarkerRecording EmptyRecording(const PointClouds& clouds, const MarkerTemplate& marker_template) {
  MarkerRecording recording;
  recording.tracks = StageTracks(marker_template.names(), clouds.num_frames(), clouds.rate_hz,
                                 clouds.first_frame, clouds.start);
  const std::size_t samples =
      static_cast<std::size_t>(clouds.num_frames()) * marker_template.markers.size();
  recording.residuals_mm.assign(samples, std::numeric_limits<float>::quiet_NaN());
  recording.camera_masks.assign(samples, 0);
  return recording;
}

std::uint8_t MaskOf(const CloudPoint& point, const std::vector<View>& views) {
  unsigned mask = 0;
  for (const DotSight& sight : point.sights) {
    const auto index = std::find(views.begin(), views.end(), sight.view) - views.begin();
    if (index < kMostMaskedViews) mask |= 1U << index;
  }
  return static_cast<std::uint8_t>(mask);
}

// Where a marker is in the stage, and how well that is known.
struct StagePlace {
  Eigen::Vector3d position_mm;
  float sigma_mm;
};
StagePlace PlaceInStage(const CloudPoint& point, const MarkerPlace& place,
                        const Rigid3d& template_from_stage) {
  const bool is_measured = point.sights.size() > 1;
  const double variance = (is_measured ? point.covariance_mm2 : place.covariance_mm2).trace() / 3;
  return {
      is_measured ? point.position_in_stage_mm : template_from_stage.Inverse() * place.position_mm,
      static_cast<float>(std::sqrt(variance))};
}

// What is known of one marker through the take, for the report.
struct MarkerStory {
  int seen = 0;
  int by_one_view = 0;
  int gaps = 0;
  int longest_gap = 0;  // frames
  std::vector<double> residuals_mm, margins, second_differences_mm;
};

MarkerStory StoryOf(const PointClouds& clouds, const Labelling& labelling, int marker) {
  MarkerStory story;
  int gap = 0;
  std::vector<const CloudPoint*> last = {nullptr, nullptr};
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    const CloudPoint* point = LabelledPoint(clouds, labelling, frame, marker);
    if (!point) {
      if (gap++ == 0) ++story.gaps;
      story.longest_gap = std::max(story.longest_gap, gap);
      last = {nullptr, nullptr};
      continue;
    }
    gap = 0;
    ++story.seen;
    story.margins.push_back(labelling.frames[frame].margins[marker]);
    if (point->sights.size() == 1) {
      ++story.by_one_view;
      last = {nullptr, nullptr};
      continue;
    }
    story.residuals_mm.push_back(point->residual_mm);
    if (last[0] && last[1])
      for (int axis = 0; axis < 3; ++axis)
        story.second_differences_mm.push_back(std::abs(point->position_in_stage_mm[axis] -
                                                       2 * last[1]->position_in_stage_mm[axis] +
                                                       last[0]->position_in_stage_mm[axis]));
    last = {last[1], point};
  }
  return story;
}

// White noise of unit variance has second differences of variance 6; the quietest quarter of a
// normal distribution's absolute values lies below 0.3186 of its deviation.
double JitterOf_mm(std::vector<double> second_differences_mm) {
  constexpr std::size_t kFewest = 40;
  if (second_differences_mm.size() < kFewest) return kNaN;
  const auto quarter =
      second_differences_mm.begin() + static_cast<std::ptrdiff_t>(second_differences_mm.size() / 4);
  std::nth_element(second_differences_mm.begin(), quarter, second_differences_mm.end());
  constexpr double kQuarterOfNormal = 0.3186;
  return *quarter / kQuarterOfNormal / std::sqrt(6.0);
}

ReportTable MarkerTable(const PointClouds& clouds, const MarkerTemplate& marker_template,
                        const Labelling& labelling) {
  ReportTable table;
  table.name = "markers";
  table.columns = {"seen_percent", "by_one_view_percent", "gaps",      "longest_gap_s",
                   "residual_mm",  "median_margin",       "jitter_mm", "spread_mm"};
  const double frames = std::max(1, clouds.num_frames());
  for (int m = 0; m < NumMarkers(marker_template); ++m) {
    const MarkerStory story = StoryOf(clouds, labelling, m);
    table.rows.push_back(
        {marker_template.markers[m].name,
         {100 * story.seen / frames, 100 * story.by_one_view / frames,
          static_cast<double>(story.gaps), story.longest_gap / clouds.rate_hz,
          MedianOf(story.residuals_mm), MedianOf(story.margins),
          JitterOf_mm(story.second_differences_mm), marker_template.markers[m].sigma_mm}});
  }
  return table;
}

void JudgeLabelling(int frames_with_head, int frames, double share, StageReport& report) {
  constexpr double kUsableShare = 0.5;
  report.usable = frames_with_head > 0 && share >= kUsableShare;
  if (frames_with_head == 0)
    report.verdict =
        "the head was found in no frame: the template is another speaker's or another marker "
        "set's, or too few markers are seen; learn one from this recording with --map or --layout";
  else
    report.verdict = fmt::format(
        "{:.1f} % of all samples have a label; the head was found in {} of {} frames{}",
        100 * share, frames_with_head, frames,
        report.usable ? "" : ": too few to rely on; see which markers are missing, and why");
}

}  // namespace

PointClouds CloudsOf(const MarkerRecording& recording) {
  const StageTracks& tracks = recording.tracks;
  PointClouds clouds = {tracks.rate_hz(), tracks.first_frame(), tracks.start(), {}};
  clouds.frames.resize(static_cast<std::size_t>(tracks.num_frames()));
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int column = 0; column < tracks.num_markers(); ++column) {
      if (tracks.is_missing(frame, column)) continue;
      CloudPoint point;
      point.position_in_stage_mm = tracks.position_mm(frame, column);
      point.column = column;
      clouds.frames[frame].push_back(point);
    }
  return clouds;
}

MarkerRecording RecordingOf(const PointClouds& clouds, const MarkerTemplate& marker_template,
                            const Labelling& labelling, const CameraArray& array) {
  MarkerRecording recording = EmptyRecording(clouds, marker_template);
  const std::vector<View> views = array.views();
  std::size_t sample = 0;
  for (int frame = 0; frame < clouds.num_frames(); ++frame)
    for (int m = 0; m < NumMarkers(marker_template); ++m, ++sample) {
      const CloudPoint* point = LabelledPoint(clouds, labelling, frame, m);
      if (!point) continue;
      const LabelledFrame& labelled = labelling.frames[frame];
      const StagePlace place =
          PlaceInStage(*point, labelled.places[m], *labelled.template_from_stage);
      const bool is_measured = point->sights.size() > 1;
      recording.tracks.Set(frame, m, place.position_mm,
                           is_measured ? SampleState::kMeasured : SampleState::kFilled,
                           place.sigma_mm);
      // C3D calls samples of residual 0 generated.
      recording.residuals_mm[sample] = is_measured ? static_cast<float>(point->residual_mm) : 0.0F;
      recording.camera_masks[sample] = MaskOf(*point, views);
    }
  return recording;
}

MarkerRecording RecordingOf(const MarkerRecording& source, const PointClouds& clouds,
                            const MarkerTemplate& marker_template, const Labelling& labelling) {
  MarkerRecording recording = EmptyRecording(clouds, marker_template);
  if (source.residuals_mm.empty()) recording.residuals_mm.clear();
  if (source.camera_masks.empty()) recording.camera_masks.clear();
  recording.residual_step_mm = source.residual_step_mm;
  recording.source_unit = source.source_unit;
  recording.subject = source.subject;
  recording.events = source.events;
  recording.analog = source.analog;
  const auto num_columns = static_cast<std::size_t>(source.tracks.num_markers());
  std::size_t sample = 0;
  for (int frame = 0; frame < clouds.num_frames(); ++frame)
    for (int m = 0; m < NumMarkers(marker_template); ++m, ++sample) {
      const CloudPoint* point = LabelledPoint(clouds, labelling, frame, m);
      if (!point) continue;
      recording.tracks.Set(frame, m, point->position_in_stage_mm,
                           source.tracks.state(frame, point->column),
                           source.tracks.sigma_mm(frame, point->column));
      const std::size_t from =
          static_cast<std::size_t>(frame) * num_columns + static_cast<std::size_t>(point->column);
      if (!source.residuals_mm.empty()) recording.residuals_mm[sample] = source.residuals_mm[from];
      if (!source.camera_masks.empty()) recording.camera_masks[sample] = source.camera_masks[from];
    }
  return recording;
}

StageReport DescribeLabelling(const PointClouds& clouds, const MarkerTemplate& marker_template,
                              const Labelling& labelling, const LabelOptions& options) {
  StageReport report;
  report.stage = "label";
  int with_head = 0, labelled = 0;
  for (const LabelledFrame& frame : labelling.frames) {
    if (!frame.template_from_stage) continue;
    ++with_head;
    labelled += frame.num_labelled();
  }
  const double samples =
      std::max(1.0, static_cast<double>(clouds.num_frames()) * NumMarkers(marker_template));
  JudgeLabelling(with_head, clouds.num_frames(), labelled / samples, report);
  report.figures = {{"frames", clouds.num_frames()},
                    {"frames_with_head", with_head},
                    {"labelled_percent", 100 * labelled / samples},
                    {"head_found_anew", labelling.searches},
                    {"relabelled_samples", labelling.relabelled},
                    {"swaps_repaired", labelling.swaps_repaired}};
  report.texts = {{"template", marker_template.name},
                  {"template_learnt_from", marker_template.learnt_from}};
  report.tables = {MarkerTable(clouds, marker_template, labelling)};
  report.options = EchoOptions(options);
  for (const ReportTable::Row& row : report.tables[0].rows)
    if (row.values[0] == 0) report.warnings.push_back(fmt::format("{} was never found", row.label));
  return report;
}

}  // namespace articap
