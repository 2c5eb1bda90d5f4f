// SPDX-License-Identifier: MIT
#include "apps/uncalibrated.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/calibrate_input.h"
#include "apps/take.h"
#include "core/csv_values.h"
#include "core/statistics.h"
#include "tracking/learn_template.h"
#include "tracking/relative_to_marker.h"

namespace articap {
namespace {

constexpr const char* kNose = "nose_tip";

// Of a length between two markers.
struct KnownLength {
  std::string from, to;
  double mm = 0;
};

Result<KnownLength> ParseKnownLength(const std::vector<std::string>& parts) {
  const auto mm = parts.size() == 3 ? ParseFinite(parts[2]) : std::nullopt;
  if (!mm || !(*mm > 0) || parts[0] == parts[1])
    return Fail(fmt::format(
        "--known-length {}: give two markers and the distance between them in mm, as nose,chin,72",
        fmt::join(parts, ",")));
  return KnownLength{parts[0], parts[1], *mm};
}

// Of the heights of a layout's markers.
double SpreadOf_mm(const MarkerTemplate& layout) {
  double sum = 0, squares = 0;
  for (const TemplateMarker& marker : layout.markers) {
    sum += marker.position_mm.y();
    squares += marker.position_mm.y() * marker.position_mm.y();
  }
  const double count = static_cast<double>(layout.markers.size());
  return std::sqrt(squares / count - std::pow(sum / count, 2));
}

Result<NominalScale> ScaleOf(const UncalibratedInput& input, const MarkerSet& set) {
  if (input.dot_diameter_mm > 0) return NominalScale{.dot_diameter_mm = input.dot_diameter_mm};
  const Result<KnownLength> length = ParseKnownLength(input.known_length);
  if (!length) return tl::unexpected(length.error());
  for (const std::string& marker : {length->from, length->to})
    if (!set.Find(marker))
      return Fail(fmt::format("--known-length: the map '{}' has no marker '{}'", set.name, marker));
  const Result<MarkerTemplate> layout = LayoutOf(set);
  if (!layout) return tl::unexpected(layout.error());
  return NominalScale{.usual_spread_mm = SpreadOf_mm(*layout)};
}

}  // namespace

void AddUncalibratedInput(VerbLine& line, UncalibratedInput& input) {
  line.Flag("--uncalibrated", input.enabled,
            "without any calibration: one camera before a mirror; positions relative to the nose");
  line.Flag("--dot-diameter-mm", input.dot_diameter_mm, "MM",
            "uncalibrated: diameter of the dots, which tells the scale");
  line.Flag("--known-length", input.known_length, "A,B,MM",
            "instead: the distance between two markers that both views see, at rest");
  line.Stage("uncalibrated", input.mirror);
}

Result<void> CheckInput(const UncalibratedInput& input, const std::string& cameras,
                        const TemplateInput& naming) {
  if (!input.enabled) {
    if (cameras.empty())
      return Fail(
          "--cameras names the calibration of cameras and mirrors; of one camera before a mirror "
          "that nobody calibrated, --uncalibrated makes the best");
    if (input.dot_diameter_mm != 0 || !input.known_length.empty() ||
        !(input.mirror == NominalMirrorOptions()))
      return Fail(
          "--dot-diameter-mm, --known-length, --focal-px and what is said of the mirror are for "
          "--uncalibrated; with --cameras the calibration knows it");
    return {};
  }
  if (!cameras.empty())
    return Fail("--cameras and --uncalibrated exclude one another; leave out --uncalibrated");
  if ((input.dot_diameter_mm > 0) == !input.known_length.empty())
    return Fail(fmt::format(
        "--uncalibrated takes the scale from the dots' diameter (--dot-diameter-mm) or from one "
        "length between two markers (--known-length A,B,MM); {}",
        input.known_length.empty() ? "neither is given" : "both are given, give one"));
  if (naming.map.empty())
    return Fail("--uncalibrated needs --map, which says which marker is on the tip of the nose");
  return CheckOptions(input.mirror);
}

NominalTake::NominalTake(const UncalibratedInput& input, double reference_frame, std::string nose,
                         NominalMirror mirror)
    : input_(input),
      reference_frame_(reference_frame),
      nose_(std::move(nose)),
      mirror_(std::move(mirror)) {
  if (!input.known_length.empty()) length_mm_ = ParseKnownLength(input.known_length)->mm;
  scale_source_ = length_mm_ ? fmt::format("the distance of {:g} mm from {} to {}", *length_mm_,
                                           input.known_length[0], input.known_length[1])
                             : fmt::format("dots of {:g} mm", input.dot_diameter_mm);
}

Result<CameraArray> NominalTake::ArrayOf(const std::vector<std::string>& paths) {
  const Result<std::vector<NamedSource>> sources = OpenCameras(paths);
  if (!sources) return tl::unexpected(sources.error());
  if (sources->size() != 1)
    return Fail(fmt::format(
        "--uncalibrated is for one camera before a mirror, and here are {}: how cameras stand to "
        "one another must be calibrated, see articap calibrate rig",
        sources->size()));
  const FrameSourceInfo info = sources->front().source->info();
  return UnknownMirror(sources->front().name, info.width, info.height);
}

Result<NominalTake> NominalTake::Start(const UncalibratedInput& input, const TemplateInput& naming,
                                       const CameraArray& array, const DotVideo& video) {
  const Result<MarkerSet> set = ReadMap(naming.map);
  if (!set) return tl::unexpected(set.error());
  const MarkerRole* const nose = set->FindAtLandmark(kNose);
  if (!nose)
    return Fail(fmt::format(
        "the map '{}' has no marker at the landmark {}, to which positions could be relative; "
        "calibrate camera and mirror (articap calibrate mirror), or add the marker",
        set->name, kNose));
  const Result<NominalScale> scale = ScaleOf(input, *set);
  if (!scale) return tl::unexpected(scale.error());
  Result<NominalMirror> mirror = EstimateNominalMirror(video, array, *scale, input.mirror);
  if (!mirror) return tl::unexpected(mirror.error());
  return NominalTake(input, naming.frame, nose->name, std::move(*mirror));
}

Result<void> NominalTake::ScaleTo(const PointClouds& clouds, const MarkerTemplate& marker_template,
                                  const Labelling& labelling) {
  const auto from = marker_template.Find(input_.known_length[0]);
  const auto to = marker_template.Find(input_.known_length[1]);
  constexpr double kAround_s = 0.2;
  std::vector<double> lengths_mm;
  for (int frame = 0; from && to && frame < clouds.num_frames(); ++frame) {
    const double from_reference_s =
        (clouds.first_frame + frame - reference_frame_) / clouds.rate_hz;
    if (reference_frame_ != 0 && std::abs(from_reference_s) > kAround_s) continue;
    const CloudPoint* const first = LabelledPoint(clouds, labelling, frame, *from);
    const CloudPoint* const second = LabelledPoint(clouds, labelling, frame, *to);
    if (first && second && first->sights.size() > 1 && second->sights.size() > 1)
      lengths_mm.push_back((first->position_in_stage_mm - second->position_in_stage_mm).norm());
  }
  if (lengths_mm.empty())
    return Fail(
        fmt::format("--known-length: in no frame{} are both {} and {} seen directly and in the "
                    "mirror; name two other markers",
                    reference_frame_ != 0 ? " around the one of --frame" : "",
                    input_.known_length[0], input_.known_length[1]));
  const double median_mm = MedianOf(lengths_mm);
  for (double& length_mm : lengths_mm) length_mm = std::abs(length_mm - median_mm);
  constexpr double kNormal = 1.4826;  // standard deviation over median distance
  constexpr double kRuler_mm = 0.5;
  mirror_.Rescale(*length_mm_ / median_mm,
                  std::hypot(kNormal * MedianOf(lengths_mm) / median_mm, kRuler_mm / *length_mm_));
  return {};
}

Result<MarkerRecording> NominalTake::RelativeToNose(const MarkerRecording& markers) const {
  if (!markers.tracks.Find(nose_))
    return Fail(fmt::format(
        "the template has no marker '{}', which is the tip of the nose in the map; give a map and "
        "a template of the same markers",
        nose_));
  return RelativeToMarker(markers, nose_);
}

StageReport NominalTake::Report(const MarkerRecording& relative) const {
  StageReport report = DescribeNominalMirror(mirror_, scale_source_, input_.mirror);
  const StageTracks& tracks = relative.tracks;
  if (const int lost = tracks.CountMissing(*tracks.Find(nose_)); lost > 0)
    report.warnings.push_back(
        fmt::format("{} of {} frames have no {}, and are empty: there is nothing to be relative to",
                    lost, tracks.num_frames(), nose_));
  return report;
}

}  // namespace articap
