// SPDX-License-Identifier: MIT
#include "tracking/stabilize_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/alignment.h"
#include "core/statistics.h"
#include "tracking/rigidity.h"

namespace articap {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// References whose errors grow more than this many times on their way to the worst placed marker
// are called ill-conditioned. Spectacles, or forehead, eyes and nose together, have about 1.
constexpr double kLargestGain = 3;
// A set is proposed where the head then stands this much stiller, as a ratio and in mm.
constexpr double kWorthwhileRatio = 0.85;
constexpr double kWorthwhileMm = 0.1;
// References this many times less rigid than the middle one, by the distances, are named.
constexpr double kConspicuousRatio = 3;
constexpr double kConspicuousSigmaMm = 0.5;

std::vector<std::string> NamesOf(const StageTracks& tracks, const std::vector<int>& columns) {
  std::vector<std::string> names;
  for (const int column : columns) names.push_back(tracks.names()[column]);
  return names;
}

ReportTable ReferenceTable(const RigidFindings& findings) {
  const ReferenceModel& model = findings.model;
  ReportTable table{"references", {"seen_pct", "rms_mm", "sigma_mm", "outlier_pct"}, {}};
  if (findings.search) table.columns.push_back("distance_change_mm");
  if (!findings.deviation_mm.empty()) table.columns.push_back("deviation_mm");
  for (int i = 0; i < model.size(); ++i) {
    const double seen = findings.statistics.num_seen[i];
    const double outliers = findings.statistics.num_outliers[i];
    const double used = findings.statistics.num_used[i];
    ReportTable::Row row{
        findings.tracks.names()[model.columns[i]],
        {100 * seen / std::max(findings.tracks.num_frames(), 1),
         used > 0 ? std::sqrt(findings.statistics.sum_of_squares_mm2[i] / used) : kNaN,
         model.sigmas_mm[i], used + outliers > 0 ? 100 * outliers / (used + outliers) : kNaN}};
    if (findings.search) row.values.push_back(findings.search->distance_change_mm[i]);
    if (!findings.deviation_mm.empty()) row.values.push_back(findings.deviation_mm[i]);
    table.rows.push_back(std::move(row));
  }
  return table;
}

// Two witnesses: the distances from still markers on other parts of the head, and, where there are
// enough references, the share of each in the variation of their distances from one another.
void WarnOfMovingReferences(const RigidFindings& findings, const StabilizeOptions& options,
                            StageReport& report) {
  const ReferenceModel& model = findings.model;
  const double median_sigma_mm = MedianOf(model.sigmas_mm);
  std::vector<std::pair<double, std::string>> moving;
  for (int i = 0; i < model.size(); ++i) {
    const bool is_conspicuous = model.size() > 3 && model.sigmas_mm[i] > kConspicuousSigmaMm &&
                                model.sigmas_mm[i] > kConspicuousRatio * median_sigma_mm;
    double change_mm = is_conspicuous ? kSigmasFrom10To90Percent * model.sigmas_mm[i] : 0.0;
    if (findings.search && findings.search->distance_change_mm[i] > options.max_reference_motion_mm)
      change_mm = std::max(change_mm, findings.search->distance_change_mm[i]);
    if (change_mm > 0) moving.emplace_back(change_mm, findings.tracks.names()[model.columns[i]]);
  }
  if (moving.empty()) return;
  std::ranges::sort(moving, std::greater());
  std::vector<std::string> texts;
  for (const auto& [change_mm, name] : moving)
    texts.push_back(fmt::format("'{}' ({:.1f} mm)", name, change_mm));
  report.warnings.push_back(fmt::format(
      "not rigid, worst first: {} ({} how much the distance from other parts of the head changes); "
      "what the skin moves there is taken for movement of the head. Better references: spectacles, "
      "or skin that the take leaves alone",
      fmt::join(texts, ", "), texts.size() == 1 ? "this is" : "these are"));
}

void ReportConditioning(const RigidFindings& findings, StageReport& report) {
  const Conditioning& conditioning = findings.conditioning;
  report.figures.emplace_back("rotation_sigma_deg", kDegrees * conditioning.rotation_sigma_rad);
  report.figures.emplace_back("face_sigma_mm", conditioning.face_sigma_mm);
  report.figures.emplace_back("error_gain", conditioning.error_gain);
  report.texts.emplace_back("worst_placed_marker", conditioning.worst_marker);
  if (conditioning.error_gain > kLargestGain)
    report.warnings.push_back(fmt::format(
        "the references are ill-conditioned: they lie so near to one line that their errors are "
        "{:.0f} times as large at '{}' (rotation uncertain by {:.2f} degrees); add references away "
        "from that line",
        conditioning.error_gain, conditioning.worst_marker,
        kDegrees * conditioning.rotation_sigma_rad));
}

void ReportSearch(const RigidFindings& findings, StageReport& report) {
  if (!findings.search) return;
  const ReferenceSet& chosen = findings.search->chosen;
  const ReferenceSet& best = findings.search->best;
  report.figures.emplace_back("stillness_mm", chosen.stillness_mm);
  if (best.stillness_mm > kWorthwhileRatio * chosen.stillness_mm ||
      best.stillness_mm > chosen.stillness_mm - kWorthwhileMm)
    return;
  const std::string names =
      fmt::format("{}", fmt::join(NamesOf(findings.tracks, best.columns), ","));
  report.figures.emplace_back("proposed_stillness_mm", best.stillness_mm);
  report.texts.emplace_back("proposed_references", names);
  report.warnings.push_back(
      fmt::format("a better set of references is there: with --head {} (--stabilize-head in bind "
                  "and fit) the skull's markers stand still to {:.2f} mm, with the chosen ones to "
                  "{:.2f} mm",
                  names, best.stillness_mm, chosen.stillness_mm));
}

}  // namespace

Conditioning ConditioningOf(const ReferenceModel& model, const std::vector<std::string>& names,
                            const std::vector<Eigen::Vector3d>& points_mm) {
  std::vector<double> weights;
  double sum_of_variances = 0;
  int count = 0;
  for (int i = 0; i < model.size(); ++i) {
    const double variance = model.sigmas_mm[i] * model.sigmas_mm[i];
    const bool is_known = model.points_mm[i].allFinite();
    weights.push_back(is_known ? 1 / variance : 0.0);
    sum_of_variances += is_known ? variance : 0.0;
    count += is_known;
  }
  const PointSpread spread = SpreadOf(model.points_mm, weights);
  Conditioning conditioning;
  conditioning.rotation_sigma_rad = spread.WorstRotationSigma();
  for (std::size_t marker = 0; marker < names.size(); ++marker) {
    if (!points_mm[marker].allFinite()) continue;
    const double sigma_mm = spread.PlacementSigma(points_mm[marker]);
    if (!conditioning.worst_marker.empty() && sigma_mm <= conditioning.face_sigma_mm) continue;
    conditioning.face_sigma_mm = sigma_mm;
    conditioning.worst_marker = names[marker];
  }
  conditioning.error_gain = conditioning.face_sigma_mm / std::sqrt(3 * sum_of_variances / count);
  return conditioning;
}

void ReportPoses(const HeadPoseTrack& head_pose, StageReport& report) {
  std::array<int, 4> counts{};
  double sum_of_squares_mm2 = 0;
  for (const HeadPose& pose : head_pose.poses) {
    ++counts[static_cast<std::size_t>(pose.status)];
    if (pose.is_known()) sum_of_squares_mm2 += pose.residual_mm * pose.residual_mm;
  }
  const int num_frames = static_cast<int>(head_pose.poses.size());
  const int num_known = counts[static_cast<std::size_t>(HeadPoseStatus::kOk)] +
                        counts[static_cast<std::size_t>(HeadPoseStatus::kLargeResidual)];
  const double rms_mm = num_known > 0 ? std::sqrt(sum_of_squares_mm2 / num_known) : kNaN;
  report.figures.emplace_back("frames", num_frames);
  for (const HeadPoseStatus status :
       {HeadPoseStatus::kOk, HeadPoseStatus::kTooFewReferences, HeadPoseStatus::kIllConditioned,
        HeadPoseStatus::kLargeResidual})
    report.figures.emplace_back(fmt::format("frames_{}", NameOf(status)),
                                counts[static_cast<std::size_t>(status)]);
  report.usable = num_known > 0 && 2 * num_known >= num_frames;
  report.verdict = fmt::format("the head is found in {} of {} frames", num_known, num_frames);
  if (head_pose.mode == StabilizationMode::kRigid) {
    report.figures.emplace_back("residual_rms_mm", rms_mm);
    if (num_known > 0)
      report.verdict += fmt::format("; the references fit their shape to {:.2f} mm RMS", rms_mm);
  }
  if (!report.usable)
    report.verdict += ": too few to go on with. Choose other references, or fill the gaps of these";
}

void ReportSmoothing(const PoseSmoothing& smoothing, StageReport& report) {
  report.figures.emplace_back("pose_noise_mm", smoothing.position_noise_mm);
  report.figures.emplace_back("pose_noise_deg", smoothing.rotation_noise_deg);
  if (smoothing.position_cutoff_hz)
    report.figures.emplace_back("position_cutoff_hz", *smoothing.position_cutoff_hz);
  if (smoothing.rotation_cutoff_hz)
    report.figures.emplace_back("rotation_cutoff_hz", *smoothing.rotation_cutoff_hz);
}

void ReportReferences(const RigidFindings& findings, const StabilizeOptions& options,
                      StageReport& report) {
  report.texts.emplace_back(
      "references",
      fmt::format("{}", fmt::join(NamesOf(findings.tracks, findings.model.columns), ",")));
  report.texts.emplace_back("axes", findings.axes);
  report.texts.emplace_back("origin", findings.origin);
  ReportConditioning(findings, report);
  report.tables.push_back(ReferenceTable(findings));
  WarnOfMovingReferences(findings, options, report);
  ReportSearch(findings, report);
}

}  // namespace articap
