// SPDX-License-Identifier: MIT
#include "fitting/propose_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/landmarks.h"
#include "fitting/face_surface.h"
#include "fitting/icp_alignment.h"
#include "fitting/landmark_assignment.h"
#include "fitting/marker_motion.h"

namespace articap {
namespace {

// The points of the orientation fit (Beskow): mouth corners, nose tip, chin, brows.
constexpr std::array<std::string_view, 10> kStrategicLandmarks = {
    "left_mouth_corner", "right_mouth_corner", "nose_tip",        "chin",
    "left_brow_inner",   "right_brow_inner",   "left_brow_outer", "right_brow_outer",
    "left_brow_middle",  "right_brow_middle"};
// The regions that the articulatory parameters move.
constexpr std::array<std::string_view, 5> kSpeakingRegions = {"upper_lip", "lower_lip", "jaw",
                                                              "left_cheek", "right_cheek"};

constexpr const char* kTableName = "proposed_markers";
// Markers farther from the skin sit on spectacles or a headband, mm.
constexpr double kOffSkin_mm = 12;
// A head reference moves less than this against the others, mm, or than twice the third stillest.
constexpr double kRigid_mm = 0.7;
constexpr std::size_t kLeastHeadReferences = 3;
// Above this median distance to the skin the cloud is not this face, or not a face, mm.
constexpr double kLargestMedianDistance_mm = 6;
// A runner-up whose cost is within this factor leaves the orientation in doubt.
constexpr double kClearlyWorse = 1.1;
// Markers up to so many times the reach of landmarks sit beside them.
constexpr double kBesideReach = 1.6;
constexpr int kHeadings = 5;

template <class Things, class Thing>
bool IsOneOf(const Things& things, const Thing& thing) {
  return std::ranges::find(things, thing) != things.end();
}

// A marker with what is known of its place.
struct PlacedMarker {
  std::string name;
  double motion_mm = 0;
  double skin_mm = 0;       // distance to the skin
  std::string skin_region;  // of the nearest triangle; empty where it is none of the vocabulary
  std::string landmark;
  double landmark_mm = std::numeric_limits<double>::quiet_NaN();
};

// -- Orientations to start from -------------------------------------------------------------------

Eigen::Quaterniond RigFromStage(const DeclaredAxes& axes) {
  Eigen::Matrix3d rig_from_stage;
  rig_from_stage << axes.left_in_stage.transpose(), axes.up_in_stage.transpose(),
      axes.forward_in_stage.transpose();
  return Eigen::Quaterniond(rig_from_stage);
}

Result<std::vector<Eigen::Quaterniond>> StartOrientations(const ProposeMapOptions& options) {
  std::vector<Eigen::Vector3d> ups;
  for (const std::string& text : options.up.empty() ? std::vector<std::string>{"+y", "+z"}
                                                    : std::vector<std::string>{options.up}) {
    const auto up = ParseAxis(text);
    if (!up) return Fail(fmt::format("up: {}", up.error().message));
    ups.push_back(*up);
  }
  std::optional<Eigen::Vector3d> known_forward;
  if (!options.forward.empty()) {
    const auto forward = ParseAxis(options.forward);
    if (!forward) return Fail(fmt::format("forward: {}", forward.error().message));
    known_forward = *forward;
    std::erase_if(ups, [&](const Eigen::Vector3d& up) { return up.dot(*forward) != 0; });
    if (ups.empty())
      return Fail(fmt::format("up ({}) and forward ({}) must be at right angles", options.up,
                              options.forward));
  }
  std::vector<Eigen::Quaterniond> starts;
  for (const Eigen::Vector3d& up : ups) {
    const Eigen::Vector3d first = known_forward ? *known_forward : up.unitOrthogonal();
    for (int heading = 0; heading < (known_forward ? 1 : kHeadings); ++heading) {
      const Eigen::Vector3d forward =
          Eigen::AngleAxisd(2 * std::numbers::pi * heading / kHeadings, up) * first;
      starts.push_back(RigFromStage({up.cross(forward), up, forward}));
    }
  }
  return starts;
}

// -- Places ---------------------------------------------------------------------------------------

std::vector<PlacedMarker> PlaceMarkers(const MarkerMotion& motion, const Sim3d& rig_from_stage,
                                       const FaceSurface& surface, const FaceRig& rig,
                                       double reach_mm) {
  std::vector<PlacedMarker> placed;
  std::vector<Eigen::Vector3d> points_in_rig;
  for (const MarkerMotion::Marker& marker : motion.markers) {
    PlacedMarker place;
    place.name = marker.name;
    place.motion_mm = marker.motion_mm;
    const FaceSurface::Foot foot = surface.Nearest(rig_from_stage * marker.point_in_stage_mm);
    place.skin_mm = foot.distance_mm;
    const std::string& region = rig.definition().region_names[foot.region];
    if (IsRegion(region)) place.skin_region = region;
    placed.push_back(std::move(place));
    points_in_rig.push_back(rig_from_stage * marker.point_in_stage_mm);
  }
  const auto assigned = AssignLandmarks(surface, points_in_rig, reach_mm);
  for (std::size_t m = 0; m < placed.size(); ++m) {
    if (assigned[m].landmark.empty()) continue;
    placed[m].landmark = assigned[m].landmark;
    placed[m].landmark_mm = assigned[m].distance_mm;
  }
  return placed;
}

// -- Roles ----------------------------------------------------------------------------------------

bool IsOnSkull(const PlacedMarker& marker) {
  // Brows and eyelids belong to the skull's region, and move.
  if (marker.landmark.find("brow") != std::string::npos ||
      marker.landmark.find("_eye_") != std::string::npos)
    return false;
  return marker.skin_mm > kOffSkin_mm || marker.skin_region == "skull" ||
         marker.landmark == "nose_bridge" || marker.landmark.starts_with("spectacles");
}

// The stillest markers on the skull, or where there are fewer than three, on skull and nose.
std::vector<std::size_t> ChooseHeadReferences(const std::vector<PlacedMarker>& markers) {
  std::vector<std::size_t> candidates, others;
  for (std::size_t m = 0; m < markers.size(); ++m) {
    if (IsOnSkull(markers[m]))
      candidates.push_back(m);
    else if (markers[m].skin_region == "skull" || markers[m].skin_region == "nose")
      others.push_back(m);
  }
  const auto motion_mm = [&](std::size_t m) { return markers[m].motion_mm; };
  std::ranges::stable_sort(candidates, {}, motion_mm);
  std::ranges::stable_sort(others, {}, motion_mm);
  while (candidates.size() < kLeastHeadReferences && !others.empty()) {
    candidates.push_back(others.front());
    others.erase(others.begin());
  }
  if (candidates.size() < kLeastHeadReferences) return {};
  std::ranges::stable_sort(candidates, {}, motion_mm);
  const double limit_mm =
      std::max(kRigid_mm, 2 * markers[candidates[kLeastHeadReferences - 1]].motion_mm);
  std::erase_if(candidates, [&](std::size_t m) { return markers[m].motion_mm > limit_mm; });
  return candidates;
}

MarkerRole RoleOf(const PlacedMarker& marker, bool is_head_reference, double landmark_reach_mm) {
  MarkerRole role;
  role.name = marker.name;
  role.landmark = marker.landmark;
  role.beside_landmark = !marker.landmark.empty() && marker.landmark_mm > landmark_reach_mm;
  const bool is_on_skin = marker.skin_mm <= kOffSkin_mm;
  if (is_on_skin && (marker.landmark.empty() || role.beside_landmark))
    role.region = marker.skin_region;
  role.head_reference = is_head_reference;
  role.strategic = !role.beside_landmark && IsOneOf(kStrategicLandmarks, role.landmark);
  role.face = is_on_skin && !is_head_reference && IsOneOf(kSpeakingRegions, RegionOf(role));
  return role;
}

MarkerSet MakeSet(const std::string& name, const std::vector<PlacedMarker>& markers,
                  const ProposeMapOptions& options) {
  MarkerSet set;
  set.name = name;
  const std::vector<std::size_t> references = ChooseHeadReferences(markers);
  set.mode = references.empty() ? StabilizationMode::kNone : StabilizationMode::kRigid;
  for (std::size_t m = 0; m < markers.size(); ++m)
    set.markers.push_back(RoleOf(markers[m], IsOneOf(references, m), options.landmark_reach_mm));
  return set;
}

// -- Report ---------------------------------------------------------------------------------------

ReportTable TableOf(const std::vector<PlacedMarker>& markers) {
  ReportTable table;
  table.name = kTableName;
  table.columns = {"to_landmark_mm", "to_skin_mm", "motion_mm"};
  for (const PlacedMarker& marker : markers) {
    const std::string place = !marker.landmark.empty()      ? marker.landmark
                              : !marker.skin_region.empty() ? marker.skin_region
                                                            : "?";
    table.rows.push_back({fmt::format("{} -> {}", marker.name, place),
                          {marker.landmark_mm, marker.skin_mm, marker.motion_mm}});
  }
  return table;
}

// "left_eye_outer" of "right_eye_outer", "chin_right" of "chin_left"; empty for those in the
// middle.
std::string OtherSideOf(const std::string& landmark) {
  for (const auto& [side, other] : {std::pair{"left", "right"}, std::pair{"right", "left"}})
    if (const std::size_t at = landmark.find(side); at != std::string::npos)
      return std::string(landmark).replace(at, std::string(side).size(), other);
  return "";
}

// Faces wear markers in pairs: a landmark without its other side is one that was taken for another.
void WarnOfLonelySides(const MarkerSet& set, StageReport& report) {
  std::vector<std::string> lonely;
  for (const MarkerRole& marker : set.markers) {
    const std::string other = OtherSideOf(marker.landmark);
    const auto is_other = [&](const MarkerRole& role) { return role.landmark == other; };
    if (!other.empty() && std::ranges::none_of(set.markers, is_other))
      lonely.push_back(fmt::format("{} ({})", marker.landmark, marker.name));
  }
  if (!lonely.empty())
    report.warnings.push_back(fmt::format(
        "landmarks on one side of the face alone, of which some are taken for their neighbours: {}",
        fmt::join(lonely, ", ")));
}

void Judge(const MarkerSet& set, const IcpAlignment& alignment, const Sim3d& rig_from_stage,
           StageReport& report) {
  const auto count = [&](auto field) { return std::ranges::count(set.markers, true, field); };
  const auto num_strategic = count(&MarkerRole::strategic);
  const auto num_head = count(&MarkerRole::head_reference);
  report.figures = {{"scale_rig_from_speaker", rig_from_stage.scale},
                    {"median_distance_to_skin_mm", alignment.median_distance_mm},
                    {"markers_at_landmarks",
                     static_cast<double>(std::ranges::count_if(
                         set.markers, [](const MarkerRole& m) { return !m.landmark.empty(); }))},
                    {"head_references", static_cast<double>(num_head)},
                    {"strategic_markers", static_cast<double>(num_strategic)},
                    {"face_markers", static_cast<double>(count(&MarkerRole::face))},
                    {"runner_up_cost_ratio", alignment.runner_up_cost / alignment.cost}};
  WarnOfLonelySides(set, report);
  if (num_head == 0)
    report.warnings.push_back(
        "fewer than three markers sit on skull or nose: the map says that the head is fixed "
        "already (mode none); name head references where it is not");
  if (alignment.runner_up_cost < kClearlyWorse * alignment.cost)
    report.warnings.push_back(
        "the head turned otherwise fits nearly as well; say which axes of the recording point up "
        "and forward (up, forward), and look at the proposal with care");
  report.usable = alignment.median_distance_mm <= kLargestMedianDistance_mm && num_strategic >= 3;
  if (report.usable)
    report.verdict = fmt::format(
        "{} markers lie a median {:.1f} mm from the skin; a proposal, check it before use",
        set.markers.size(), alignment.median_distance_mm);
  else
    report.verdict = fmt::format(
        "the markers do not look like a face (median {:.1f} mm from the skin, {} strategic points "
        "of at least 3); say up and forward, check the unit, or write the map by hand",
        alignment.median_distance_mm, num_strategic);
}

std::string OneLine(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

}  // namespace

void VisitOptions(ProposeMapOptions& options, OptionVisitor& visit) {
  visit("up", options.up,
        "axis of the recording that points up, e.g. +z; else +y and +z are tried");
  visit("forward", options.forward,
        "axis of the recording that the speaker looks along, e.g. -y; else all headings are tried");
  visit(
      "landmark_reach_mm", options.landmark_reach_mm,
      "a marker this near to a landmark sits at it, a little farther off beside it; mm of the rig");
}

Result<StageResult<MarkerSet>> ProposeMap(const StageTracks& reference, const std::string& name,
                                          const FaceRig& rig, const ProposeMapOptions& options) {
  const auto starts = StartOrientations(options);
  if (!starts) return tl::unexpected(starts.error());
  if (!(options.landmark_reach_mm > 0)) return Fail("landmark_reach_mm must be positive");
  const MarkerMotion motion = MeasureMarkerMotion(reference);
  std::vector<Eigen::Vector3d> cloud_mm;
  for (const MarkerMotion::Marker& marker : motion.markers)
    cloud_mm.push_back(marker.point_in_stage_mm);
  IcpOptions icp_options;
  icp_options.starts = *starts;
  const auto alignment = AlignCloudToRig(cloud_mm, rig, icp_options);
  if (!alignment) return tl::unexpected(alignment.error());

  const auto adapted = AdaptIdentity(rig, cloud_mm, alignment->rig_from_cloud, icp_options.model);
  if (!adapted) return tl::unexpected(adapted.error());
  const std::vector<PlacedMarker> markers =
      PlaceMarkers(motion, adapted->fit.rig_from_cloud, adapted->surface, rig,
                   kBesideReach * options.landmark_reach_mm);
  StageResult<MarkerSet> result{MakeSet(name, markers, options), {}};
  result.report.stage = "map";
  result.report.options = EchoOptions(options);
  Judge(result.output, *alignment, adapted->fit.rig_from_cloud, result.report);
  result.report.tables.push_back(TableOf(markers));
  for (const std::string& left_out : motion.left_out)
    result.report.warnings.push_back(
        fmt::format("marker '{}' is seen in less than half of the frames and left out", left_out));
  return result;
}

std::string WriteMapProposal(const StageResult<MarkerSet>& proposal) {
  std::string text =
      "# A proposal made by 'articap map' from the shape of the marker cloud alone. Check every\n"
      "# marker: its landmark, its region, its roles; left is the speaker's left. Markers of one\n"
      "# face can be taken for their neighbours, and a mirrored recording cannot be told.\n#\n";
  for (const ReportTable& table : proposal.report.tables) {
    if (table.name != kTableName) continue;
    text += "# marker -> where: distance to the landmark, to the skin; movement within the head\n";
    for (const ReportTable::Row& row : table.rows)
      text += fmt::format("#   {}: {}, {:.1f} mm; {:.1f} mm\n", OneLine(row.label),
                          std::isnan(row.values[0]) ? "-" : fmt::format("{:.1f} mm", row.values[0]),
                          row.values[1], row.values[2]);
  }
  for (const std::string& warning : proposal.report.warnings)
    text += fmt::format("# Warning: {}\n", OneLine(warning));
  return text + "\n" + WriteMarkerSet(proposal.output);
}

}  // namespace articap
