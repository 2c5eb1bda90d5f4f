// SPDX-License-Identifier: MIT
#include "fitting/bind.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/alignment.h"
#include "core/statistics.h"
#include "fitting/identity_fit.h"
#include "fitting/orientation_fit.h"
#include "fitting/reference_pose.h"
#include "rig/attachment.h"
#include "rig/pose_text.h"

namespace articap {
namespace {

// Faces differ from one another by less than this factor; beyond it the unit is wrong.
constexpr double kMostScale = 1.8;

// A mirrored or swapped reading must fit this much better before it is believed.
constexpr double kDistinctRatio = 0.6;

// Lips count as open this much above the closed lips of the take, mm of the speaker.
constexpr double kOpenLips_mm = 3;

// At rest, no marker's position in the reference frames has a larger standard deviation, mm.
constexpr double kRestless_mm = 1.0;

// A marker of the reference pose with its role and, where it has one, its landmark on the rig.
struct RolePoint {
  const MarkerRole* role = nullptr;
  Eigen::Vector3d point_in_head = Eigen::Vector3d::Zero();
  std::optional<int> landmark_vertex;
};

std::vector<RolePoint> RolePoints(const HeadShape& pose, const MarkerSet& set, const FaceRig& rig) {
  std::vector<RolePoint> points;
  for (const MarkerRole& role : set.markers)
    if (const NamedPoint* const point = pose.Find(role.name))
      points.push_back({&role, point->point_in_head_mm,
                        role.landmark.empty() ? std::nullopt : rig.FindLandmark(role.landmark)});
  return points;
}

// Where the centre of a marker at a landmark is on the rig: as high above the skin as the map has
// it.
std::vector<PointPair> StrategicPairs(const std::vector<RolePoint>& points, const FaceRig& rig,
                                      const Eigen::VectorXd& pose) {
  const TriangleMesh posed{rig.Evaluate(pose), rig.neutral_mesh().triangles};
  const std::vector<Eigen::Vector3d> normals = VertexNormals(posed);
  std::vector<PointPair> pairs;
  for (const RolePoint& point : points)
    if (point.role->strategic && point.landmark_vertex)
      pairs.push_back({point.role->name, point.point_in_head,
                       posed.vertices[*point.landmark_vertex] +
                           point.role->offset_mm * normals[*point.landmark_vertex]});
  return pairs;
}

double MeanResidual_mm(const OrientationFit& fit) {
  double sum = 0;
  for (const double residual : fit.residuals_mm) sum += residual;
  return sum / static_cast<double>(fit.residuals_mm.size()) / fit.rig_from_head.scale;
}

std::string MissingStrategic(const MarkerSet& set, const HeadShape& pose) {
  std::vector<std::string> missing;
  for (const MarkerRole& role : set.markers)
    if (role.strategic && pose.Find(role.name) == nullptr) missing.push_back(role.name);
  return fmt::format("{}", fmt::join(missing, ", "));
}

// The other side's name of a landmark: left_x <-> right_x, x_left <-> x_right; empty where it has
// none.
std::string OtherSide(const std::string& landmark) {
  for (const auto& [from, to] : {std::pair{"left", "right"}, std::pair{"right", "left"}}) {
    const std::size_t at = landmark.find(from);
    if (at != std::string::npos)
      return std::string(landmark).replace(at, std::string_view(from).size(), to);
  }
  return {};
}

// Names the pair of strategic markers whose exchange makes the orientation fit distinctly better.
std::optional<std::string> FindSwappedPair(const std::vector<RolePoint>& points,
                                           const std::vector<PointPair>& pairs,
                                           const OrientationFit& fit, const MarkerLoss& loss) {
  const auto landmark_of = [&](const std::string& marker) -> const std::string& {
    return std::find_if(points.begin(), points.end(),
                        [&](const RolePoint& point) { return point.role->name == marker; })
        ->role->landmark;
  };
  for (std::size_t a = 0; a < pairs.size(); ++a)
    for (std::size_t b = a + 1; b < pairs.size(); ++b) {
      if (OtherSide(landmark_of(pairs[a].name)) != landmark_of(pairs[b].name)) continue;
      std::vector<PointPair> exchanged = pairs;
      std::swap(exchanged[a].point_in_head, exchanged[b].point_in_head);
      if (FitOrientation(exchanged, loss).objective < kDistinctRatio * fit.objective)
        return fmt::format("'{}' and '{}'", pairs[a].name, pairs[b].name);
    }
  return std::nullopt;
}

// Why the strategic points cannot be believed; nothing where they can.
std::optional<std::string> FindFault(const std::vector<RolePoint>& points,
                                     const std::vector<PointPair>& pairs, const OrientationFit& fit,
                                     const MarkerLoss& loss) {
  std::vector<Eigen::Vector3d> in_head, in_rig;
  for (const PointPair& pair : pairs) {
    in_head.push_back(pair.point_in_head);
    in_rig.push_back(pair.point_in_rig);
  }
  if (DetectReflection(in_head, in_rig).is_reflected)
    return "the reference pose is the mirror image of a face: either the data are mirrored or "
           "left-handed (try --mirror), or every marker's name says left for right";
  if (const auto swapped = FindSwappedPair(points, pairs, fit, loss))
    return fmt::format(
        "the markers {} fit the face distinctly better when exchanged: their names "
        "seem to be swapped; correct them in the recording or in the map",
        *swapped);
  const double scale = fit.rig_from_head.scale;
  if (scale > kMostScale || scale < 1 / kMostScale)
    return fmt::format(
        "the face is {:.3g} times the size of the rig: check the unit of the "
        "recording (--unit) and that the map belongs to it",
        1 / scale);
  return std::nullopt;
}

std::vector<LandmarkPoint> LandmarkPoints(const std::vector<RolePoint>& points) {
  std::vector<LandmarkPoint> landmarks;
  for (const RolePoint& point : points)
    if (point.landmark_vertex && !point.role->beside_landmark &&
        (point.role->strategic || point.role->face))
      landmarks.push_back({*point.landmark_vertex, point.point_in_head, point.role->offset_mm});
  return landmarks;
}

std::optional<int> RegionOf(const RolePoint& point, const FaceRig& rig) {
  if (!point.role->region.empty())
    if (const auto region = rig.FindRegion(point.role->region)) return region;
  if (point.landmark_vertex) return RegionOfVertex(rig, *point.landmark_vertex);
  return std::nullopt;
}

std::optional<VirtualMarker> Attach(const Attacher& attacher, const RolePoint& point,
                                    const FaceRig& rig, AttachMethod method,
                                    const Eigen::Vector3d& point_in_rig) {
  const auto region = RegionOf(point, rig);
  if (!region) return std::nullopt;
  if (method == AttachMethod::kLandmark && point.landmark_vertex)
    if (auto marker = attacher.AttachAtVertex(point.role->name, *point.landmark_vertex, *region,
                                              point_in_rig))
      return marker;
  return attacher.AttachInRegion(point.role->name, *region, point_in_rig);
}

// Attaches the face markers; those that have no place on this rig are named in the report.
std::vector<VirtualMarker> AttachAll(const std::vector<RolePoint>& points, const FaceRig& rig,
                                     const Eigen::VectorXd& pose, const Sim3d& rig_from_head,
                                     AttachMethod method, StageReport* report) {
  const Attacher attacher(rig, pose);
  std::vector<VirtualMarker> markers;
  ReportTable table{"virtual markers", {"height_mm", "s", "t", "from_landmark_mm"}, {}};
  std::vector<std::string> homeless;
  for (const RolePoint& point : points) {
    if (!point.role->face) continue;
    const Eigen::Vector3d point_in_rig = rig_from_head * point.point_in_head;
    const auto marker = Attach(attacher, point, rig, method, point_in_rig);
    if (!marker) {
      homeless.push_back(point.role->name);
      continue;
    }
    markers.push_back(*marker);
    const double from_landmark =
        point.landmark_vertex
            ? (attacher.vertices_mm()[*point.landmark_vertex] - point_in_rig).norm()
            : std::numeric_limits<double>::quiet_NaN();
    table.rows.push_back({point.role->name, {marker->u_mm, marker->s, marker->t, from_landmark}});
  }
  if (!homeless.empty())
    report->warnings.push_back(
        fmt::format("no place on the rig '{}' for {}: give each a region or landmark that the rig "
                    "has in the map; they are left out",
                    rig.definition().name, fmt::join(homeless, ", ")));
  report->tables.push_back(std::move(table));
  return markers;
}

void WarnOfOpenLips(const HeadTracks& tracks, const MarkerSet& set, const FrameRange& frames,
                    StageReport* report) {
  std::vector<double> distances =
      LandmarkDistances(tracks, set, "upper_lip_center", "lower_lip_center");
  double sum = 0;
  int count = 0;
  for (int number = frames.first; number <= frames.last; ++number)
    if (const double distance = distances[number - tracks.first_frame()]; std::isfinite(distance)) {
      sum += distance;
      ++count;
    }
  std::erase_if(distances, [](double distance) { return !std::isfinite(distance); });
  if (count == 0 || distances.empty()) return;
  const double closed = QuantileOf(std::move(distances), 0.05);
  report->figures.emplace_back("lip_distance_mm", sum / count);
  report->figures.emplace_back("lip_distance_closed_mm", closed);
  if (sum / count > closed + kOpenLips_mm)
    report->warnings.push_back(
        fmt::format("the lips are open in the reference pose: {:.1f} mm between the lip markers, "
                    "{:.1f} mm where the take closes them; choose frames with closed lips and "
                    "relaxed jaw (--frames; --reference in fit)",
                    sum / count, closed));
}

void DescribeOrientation(const std::vector<PointPair>& pairs, const OrientationFit& fit,
                         StageReport* report) {
  const auto x = fit.rig_from_head.ToParameters();
  constexpr double kDegrees = 180 / std::numbers::pi;
  report->figures.insert(report->figures.end(),
                         {{"tx_mm", x[0]},
                          {"ty_mm", x[1]},
                          {"tz_mm", x[2]},
                          {"ax_deg", kDegrees * x[3]},
                          {"ay_deg", kDegrees * x[4]},
                          {"az_deg", kDegrees * x[5]},
                          {"scale", x[6]},
                          {"mean_strategic_distance_mm", MeanResidual_mm(fit)}});
  ReportTable table{"strategic points", {"distance_mm"}, {}};
  for (std::size_t i = 0; i < pairs.size(); ++i)
    table.rows.push_back({pairs[i].name, {fit.residuals_mm[i] / fit.rig_from_head.scale}});
  report->tables.push_back(std::move(table));
}

template <class Items>
std::vector<NamedValue> NamedValues(const Items& items, const Eigen::VectorXd& values) {
  std::vector<NamedValue> named;
  for (std::size_t i = 0; i < items.size(); ++i)
    named.push_back({items[i].name, values[static_cast<Eigen::Index>(i)]});
  return named;
}

// Values in the order of `items`; the first name that is not among them fails.
template <class Items>
Result<Eigen::VectorXd> InOrderOf(const Items& items, const std::vector<NamedValue>& named,
                                  const std::string& what, const std::string& rig_name) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(items.size()));
  for (const NamedValue& value : named) {
    const auto found = std::find_if(items.begin(), items.end(),
                                    [&](const auto& item) { return item.name == value.name; });
    if (found == items.end())
      return Fail(
          fmt::format("the binding sets the {} '{}', which the rig '{}' does not have; use "
                      "the rig that it was made with, or bind again",
                      what, value.name, rig_name));
    values[found - items.begin()] = value.value;
  }
  return values;
}

Result<FrameRange> ChooseFrames(const HeadTracks& tracks, const MarkerSet& set,
                                const BindOptions& options, StageReport* report) {
  if (!options.frames.empty())
    return ParseFrameRange(options.frames, tracks.first_frame(), tracks.num_frames());
  auto frames = ProposeReferenceFrames(tracks, set, options.num_reference_frames);
  if (frames)
    report->texts.emplace_back("reference frames",
                               fmt::format("{}:{} (proposed: closed lips, relaxed jaw, at rest)",
                                           frames->first, frames->last));
  return frames;
}

void NoteAveraging(const AveragedPose& averaged, const FrameRange& frames, StageReport* report) {
  report->figures.emplace_back("reference_first_frame", frames.first);
  report->figures.emplace_back("reference_last_frame", frames.last);
  report->figures.emplace_back("largest_marker_sd_mm", averaged.largest_sd_mm);
  if (averaged.largest_sd_mm > kRestless_mm)
    report->warnings.push_back(
        fmt::format("the face moves in the reference frames: a marker's standard deviation is "
                    "{:.2f} mm; choose "
                    "frames at rest",
                    averaged.largest_sd_mm));
  if (!averaged.left_out.empty())
    report->warnings.push_back(
        fmt::format("seen in less than half of the reference frames and left out: {}",
                    fmt::join(averaged.left_out, ", ")));
}

// The landmarks of strategic markers that the rig does not have.
std::vector<std::string> LandmarksLacking(const MarkerSet& set, const FaceRig& rig) {
  std::vector<std::string> lacking;
  for (const MarkerRole& role : set.markers)
    if (role.strategic && !role.landmark.empty() && !rig.FindLandmark(role.landmark))
      lacking.push_back(role.landmark);
  return lacking;
}

// Why the orientation fit has less than three points: the rig lacks landmarks, or the pose markers.
std::string TooFewStrategic(std::size_t num_pairs, const MarkerSet& set, const FaceRig& rig,
                            const std::string& missing) {
  const std::vector<std::string> lacking = LandmarksLacking(set, rig);
  if (!lacking.empty())
    return fmt::format(
        "the rig '{}' has {} of the landmarks that the map's strategic markers sit at, and at "
        "least "
        "3 are needed; it lacks {}. Name them in the rig's recipe ('articap rig import --recipe', "
        "docs/rigs.md)",
        rig.definition().name, num_pairs, fmt::join(lacking, ", "));
  return fmt::format(
      "the reference pose has {} of the strategic markers that the orientation fit needs, at least "
      "3{}; check that the map belongs to the recording, or mark others as strategic",
      num_pairs, missing.empty() ? "" : " (missing: " + missing + ")");
}

}  // namespace

void VisitOptions(BindOptions& options, OptionVisitor& visit) {
  visit("frames", options.frames,
        "reference frames FIRST:LAST by the recording's numbers; empty: proposed");
  visit("num_reference_frames", options.num_reference_frames,
        "length of a proposed reference, frames");
  visit.Enumeration("metric", options.metric, {"distance", "squared", "huber"},
                    "what the orientation fit minimises; distance is the paper's");
  visit.Enumeration(
      "attach", options.attach, {"landmark", "nearest"},
      "where markers are tied: at their landmark, or at the nearest triangle of their "
      "region");
  visit("fit_identity", options.fit_identity, "fit the rig's identity sliders to the speaker");
  visit("identity", options.identity, "identity sliders set by hand, name=value");
  visit("pose", options.pose,
        "the rig's parameters in the reference pose, name=value with deg, rad or mm");
  visit("max_orientation_residual_mm", options.max_orientation_residual_mm,
        "mean distance of the strategic points above which the binding is not usable, mm");
}

Result<FrameRange> ParseFrameRange(const std::string& text, int first_frame, int num_frames) {
  const auto parse = [](std::string_view part) -> std::optional<int> {
    int value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size()) return std::nullopt;
    return value;
  };
  const std::string_view view = text;
  const std::size_t colon = view.find(':');
  const auto first = parse(view.substr(0, colon));
  const auto last = colon == std::string_view::npos ? first : parse(view.substr(colon + 1));
  if (!first || !last)
    return Fail(
        fmt::format("'{}' is not a range of frames; write FIRST:LAST, such as 10:69", text));
  const int last_frame = first_frame + num_frames - 1;
  if (*first > *last || *first < first_frame || *last > last_frame)
    return Fail(fmt::format("frames {} are not within the recording, which has the frames {} to {}",
                            text, first_frame, last_frame));
  return FrameRange{*first, *last};
}

Result<FaceRig> RigOfBinding(const Binding& binding, const FaceRig& rig) {
  const auto identity = InOrderOf(rig.definition().identity_sliders, binding.rig_identity,
                                  "identity slider", rig.definition().name);
  if (!identity) return tl::unexpected(identity.error());
  return rig.WithIdentity(*identity);
}

Result<Eigen::VectorXd> ReferenceParameters(const Binding& binding, const FaceRig& rig) {
  return InOrderOf(rig.definition().parameters, binding.rig_parameters, "parameter",
                   rig.definition().name);
}

Result<StageResult<Binding>> Bind(const HeadTracks& reference, const HeadShape& head_shape,
                                  const MarkerSet& set, const FaceRig& rig,
                                  const BindOptions& options) {
  StageReport report{.stage = "bind", .options = EchoOptions(options)};
  if (const auto good =
          RequirePositive({{"num_reference_frames", options.num_reference_frames},
                           {"max_orientation_residual_mm", options.max_orientation_residual_mm}});
      !good)
    return tl::unexpected(good.error());
  const auto frames = ChooseFrames(reference, set, options, &report);
  if (!frames) return tl::unexpected(frames.error());
  const AveragedPose averaged = AverageFrames(reference, *frames);
  NoteAveraging(averaged, *frames, &report);

  const auto pose = ParsePose(rig, options.pose);
  if (!pose) return tl::unexpected(pose.error());
  const auto given_identity = ParseIdentity(rig, options.identity);
  if (!given_identity) return tl::unexpected(given_identity.error());
  const std::vector<RolePoint> points = RolePoints(averaged.pose, set, rig);
  const std::string missing = MissingStrategic(set, averaged.pose);
  const MarkerLoss loss{.metric = options.metric};

  Eigen::VectorXd identity = Eigen::VectorXd::Zero(rig.identity().size());
  for (Eigen::Index k = 0; k < identity.size(); ++k) identity[k] = (*given_identity)[k].value_or(0);
  FaceRig own_rig = rig.WithIdentity(identity);
  std::vector<PointPair> pairs = StrategicPairs(points, own_rig, *pose);
  if (pairs.size() < 3) return Fail(TooFewStrategic(pairs.size(), set, rig, missing));
  if (!missing.empty())
    report.warnings.push_back(
        fmt::format("strategic markers missing in the reference pose: {}", missing));

  OrientationFit fit = FitOrientation(pairs, loss);
  if (const auto fault = FindFault(points, pairs, fit, loss)) return Fail(*fault);
  if (options.fit_identity) {
    identity = FitIdentity(rig, *pose, LandmarkPoints(points), fit.rig_from_head, *given_identity);
    own_rig = rig.WithIdentity(identity);
    pairs = StrategicPairs(points, own_rig, *pose);
    fit = FitOrientation(pairs, loss);
  }
  DescribeOrientation(pairs, fit, &report);
  for (const NamedValue& slider : NamedValues(rig.definition().identity_sliders, identity))
    report.figures.emplace_back("identity_" + slider.name, slider.value);
  WarnOfOpenLips(reference, set, *frames, &report);

  Binding binding{.rig_name = rig.definition().name,
                  .marker_set = set,
                  .head_shape = head_shape,
                  .reference_pose = averaged.pose,
                  .reference_frames = *frames,
                  .rig_from_head = fit.rig_from_head,
                  .rig_parameters = NamedValues(rig.definition().parameters, *pose),
                  .rig_identity = NamedValues(rig.definition().identity_sliders, identity),
                  .virtual_markers =
                      AttachAll(points, own_rig, *pose, fit.rig_from_head, options.attach, &report),
                  .sources = {}};
  if (binding.virtual_markers.empty())
    return Fail(
        "no face marker of the map is in the reference pose; check that the map belongs to "
        "the recording");
  report.figures.emplace_back("virtual_markers",
                              static_cast<double>(binding.virtual_markers.size()));
  const double mean_mm = MeanResidual_mm(fit);
  report.usable = mean_mm <= options.max_orientation_residual_mm;
  report.verdict =
      report.usable
          ? fmt::format(
                "{} markers tied to the rig '{}'; the {} strategic points lie {:.1f} mm from "
                "the rig's on average",
                binding.virtual_markers.size(), rig.definition().name, pairs.size(), mean_mm)
          : fmt::format(
                "not usable: the strategic points lie {:.1f} mm from the rig's on average; "
                "the map seems to be of another set-up, or markers are misnamed",
                mean_mm);
  return StageResult<Binding>{std::move(binding), std::move(report)};
}

}  // namespace articap
