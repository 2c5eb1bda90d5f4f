// SPDX-License-Identifier: MIT
#include "calib/calibration_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace articap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::string CountOf(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::size_t CountUsed(const Calibration& calibration) {
  return static_cast<std::size_t>(
      std::count_if(calibration.sightings.begin(), calibration.sightings.end(),
                    [](const SightingResult& sighting) { return sighting.used; }));
}

// Root mean square over the sightings of one view, px.
double RmsOfView_px(const Calibration& calibration, const View& view) {
  DistanceRms rms;
  for (const SightingResult& sighting : calibration.sightings)
    if (sighting.used && sighting.view == view) rms.Add(sighting.residuals_px);
  return rms.px();
}

// How much larger a view's residuals are than those of neighbouring corners tell.
double MisfitOf(const Calibration& calibration, const View& view) {
  const int index = calibration.array.IndexOf(view);
  return calibration.noise_px[index] / calibration.local_noise_px[index];
}

ReportTable ViewTable(const Calibration& calibration) {
  ReportTable table = {
      "view", {"sightings", "rms_px", "noise_px", "misfit", "coverage_percent"}, {}};
  for (const View& view : calibration.array.views()) {
    const auto sightings = std::count_if(
        calibration.sightings.begin(), calibration.sightings.end(),
        [&](const SightingResult& sighting) { return sighting.used && sighting.view == view; });
    const double coverage_percent =
        view.mirror < 0 ? 100 * CoverageOf(calibration, view.camera).part() : NAN;
    table.rows.push_back({calibration.array.NameOf(view),
                          {static_cast<double>(sightings), RmsOfView_px(calibration, view),
                           calibration.noise_px[calibration.array.IndexOf(view)],
                           MisfitOf(calibration, view), coverage_percent}});
  }
  return table;
}

ReportTable LensTable(const CameraArray& array) {
  ReportTable table = {"lens", {"value", "sigma"}, {}};
  constexpr std::array<const char*, Lens::kNumDistortion> kNames = {"k1", "k2", "p1", "p2",
                                                                    "k3", "k4", "k5", "k6"};
  for (const Camera& camera : array.cameras) {
    const std::string of = array.cameras.size() > 1 ? camera.name + " " : "";
    const Lens& lens = camera.lens;
    const CameraSigmas& sigmas = camera.sigmas;
    table.rows.push_back({of + "fx_px", {lens.fx_px, sigmas.fx_px}});
    table.rows.push_back({of + "fy_px", {lens.fy_px, sigmas.fy_px}});
    table.rows.push_back({of + "cx_px", {lens.cx_px, sigmas.cx_px}});
    table.rows.push_back({of + "cy_px", {lens.cy_px, sigmas.cy_px}});
    for (int i = 0; i < Lens::kNumDistortion; ++i)
      if (lens.distortion[i] != 0 || sigmas.distortion[i] != 0)
        table.rows.push_back({of + kNames[i], {lens.distortion[i], sigmas.distortion[i]}});
  }
  return table;
}

ReportTable MirrorTable(const CameraArray& array) {
  ReportTable table = {
      "mirror", {"normal_x", "normal_y", "normal_z", "sigma_deg", "distance_mm", "sigma_mm"}, {}};
  for (const Mirror& mirror : array.mirrors) {
    const Eigen::Vector3d& n = mirror.normal_in_stage;
    table.rows.push_back({mirror.name,
                          {n.x(), n.y(), n.z(), mirror.normal_sigma_rad / kDegree,
                           mirror.distance_mm, mirror.distance_sigma_mm}});
  }
  return table;
}

// "003.png", or "left 003.png" where there are several views.
std::string SourceOf(const Calibration& calibration, const SightingResult& sighting) {
  if (calibration.array.views().size() == 1) return sighting.source;
  return calibration.array.NameOf(sighting.view) + " " + sighting.source;
}

// The worst first.
ReportTable WorstSightings(const Calibration& calibration) {
  constexpr std::size_t kMost = 5;
  std::vector<const SightingResult*> used;
  for (const SightingResult& sighting : calibration.sightings)
    if (sighting.used) used.push_back(&sighting);
  std::stable_sort(used.begin(), used.end(),
                   [](const auto* a, const auto* b) { return a->rms_px() > b->rms_px(); });
  used.resize(std::min(used.size(), kMost));
  ReportTable table = {"largest residuals", {"corners", "rms_px"}, {}};
  for (const SightingResult* sighting : used)
    table.rows.push_back({SourceOf(calibration, *sighting),
                          {static_cast<double>(sighting->corners.size()), sighting->rms_px()}});
  return table;
}

void WarnOfSetAside(const Calibration& calibration, StageReport& report) {
  for (const SightingResult& sighting : calibration.sightings)
    if (!sighting.used)
      report.warnings.push_back(
          fmt::format("{} is set aside: {}", SourceOf(calibration, sighting), sighting.reason));
}

void WarnOfGaps(const Calibration& calibration, StageReport& report) {
  for (int i = 0; i < static_cast<int>(calibration.array.cameras.size()); ++i) {
    const std::vector<std::string> gaps = CoverageOf(calibration, i).gaps();
    if (!gaps.empty())
      report.warnings.push_back(
          fmt::format("{}: the board was never seen at {}; what the lens does there is a guess, "
                      "record it there "
                      "where it matters",
                      calibration.array.cameras[i].name, fmt::join(gaps, ", ")));
  }
}

bool FoldsBeforeCorners(const Camera& camera) {
  const double right = camera.width - 1, bottom = camera.height - 1;
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(right, 0),
                                        Eigen::Vector2d(0, bottom), Eigen::Vector2d(right, bottom)})
    if (!Unproject(camera.lens, corner)) return true;
  return false;
}

void WarnOfFolds(const Calibration& calibration, StageReport& report) {
  for (const Camera& camera : calibration.array.cameras)
    if (FoldsBeforeCorners(camera))
      report.warnings.push_back(
          fmt::format("{}: the distortion found folds the picture over before its corners, where "
                      "the board was never seen; nothing can be measured there. Record it there, "
                      "or use a simpler model",
                      camera.name));
}

// Views of which nothing is left, cameras and mirrors that nothing ties to the rest.
std::string FaultOfLinks(const Calibration& calibration) {
  const CameraArray& array = calibration.array;
  for (const View& view : array.views())
    if (std::isnan(RmsOfView_px(calibration, view)))
      return fmt::format(
          "{}: none of its sightings fits those of the others; see why each was set aside, and "
          "record again, or leave it out",
          array.NameOf(view));
  for (const Camera& camera : array.cameras)
    if (!camera.sigmas.rotation_rad.allFinite() || !camera.sigmas.translation_mm.allFinite())
      return fmt::format(
          "{}: where it stands cannot be told, as of the sightings that fit none links it with {}; "
          "record the board where both see it",
          camera.name, array.cameras.front().name);
  for (const Mirror& mirror : array.mirrors)
    if (!std::isfinite(mirror.normal_sigma_rad) || !std::isfinite(mirror.distance_sigma_mm))
      return fmt::format(
          "{}: where it stands cannot be told, as no sighting that fits shows the board beside it; "
          "record the board where the camera sees it and its reflection",
          mirror.name);
  return {};
}

// Views most of which would have to be left out, or whose residuals are no noise.
std::string FaultOfViews(const Calibration& calibration, const CalibrationLimits& limits) {
  for (const View& view : calibration.array.views()) {
    std::size_t all = 0, aside = 0;
    for (const SightingResult& sighting : calibration.sightings)
      if (sighting.view == view) {
        ++all;
        if (!sighting.used) ++aside;
      }
    const std::string name = calibration.array.NameOf(view);
    if (3 * aside > all)
      return fmt::format(
          "{}: {} of {} sightings do not fit the others; did it move between pictures, or do the "
          "pictures show several boards? Fix everything in its place and record again",
          name, aside, all);
    // No view is bad that fits so well.
    constexpr double kGood_px = 0.1;
    const int index = calibration.array.IndexOf(view);
    if (calibration.noise_px[index] > kGood_px && MisfitOf(calibration, view) > limits.max_misfit)
      return fmt::format(
          "{}: residuals of {:.2f} px run the same way over parts of the board, where neighbouring "
          "corners agree to {:.2f} px: did it move between pictures, is the board bent, is a lens "
          "that was held another one? Fix everything in its place and record again",
          name, calibration.noise_px[index], calibration.local_noise_px[index]);
  }
  return {};
}

// Lenses that were held, and are not those of the pictures.
std::string FaultOfHeldLenses(const Calibration& calibration, const CalibrationLimits& limits) {
  constexpr double kCertain_sigmas = 4;
  for (const HeldLens& held : calibration.held_lenses) {
    const double error = std::abs(held.focal_ratio - 1);
    if (!(error > limits.max_held_focal_percent / 100) ||
        !(error > kCertain_sigmas * held.focal_ratio_sigma))
      continue;
    const Camera& camera = calibration.array.cameras[held.camera];
    return fmt::format(
        "{}: its lens was held at a focal length of {:.1f} px, but by these pictures it is {:.1f} "
        "+- {:.1f}: was it calibrated at another zoom, focus or size of pictures? Calibrate it "
        "anew, or let it be adjusted",
        camera.name, camera.lens.fx_px, held.focal_ratio * camera.lens.fx_px,
        held.focal_ratio_sigma * camera.lens.fx_px);
  }
  return {};
}

// The first thing that makes it unusable, with what to do; empty where nothing does.
std::string FaultOf(const Calibration& calibration, const CalibrationLimits& limits) {
  // With fewer the residuals do not tell their own standard deviation.
  constexpr int kFewestFreedoms = 10;
  if (calibration.degrees_of_freedom < kFewestFreedoms)
    return fmt::format(
        "the corners seen are only {} more coordinates than there are unknowns, so that nobody can "
        "say how good the calibration is; record more views, with more corners in each",
        calibration.degrees_of_freedom);
  if (std::string fault = FaultOfLinks(calibration); !fault.empty()) return fault;
  if (!(calibration.rms_px() <= limits.max_rms_px))
    return fmt::format(
        "residuals of {:.2f} px, more than {:g}: is the board flat, are its numbers right, were "
        "the "
        "pictures sharp and taken at the same instants? Print the board anew on something stiff "
        "and "
        "record again",
        calibration.rms_px(), limits.max_rms_px);
  for (const Camera& camera : calibration.array.cameras) {
    const double percent = 100 * camera.sigmas.fx_px / camera.lens.fx_px;
    if (!(percent <= limits.max_focal_sigma_percent))
      return fmt::format(
          "{}: the focal length is known to {:.1f} % only, limit {:g}: the views are too parallel; "
          "record the board tilted by 20 to 40 degrees to all sides, and at several distances",
          camera.name, percent, limits.max_focal_sigma_percent);
  }
  if (std::string fault = FaultOfHeldLenses(calibration, limits); !fault.empty()) return fault;
  if (calibration.array.views().size() > 1)
    if (std::string fault = FaultOfViews(calibration, limits); !fault.empty()) return fault;
  if (calibration.held_out.rigidity_mm > limits.max_rigidity_mm)
    return fmt::format(
        "distances on held-out views are wrong by {:.2f} mm, more than {:g}: record more views "
        "that "
        "cameras share, all over the volume",
        calibration.held_out.rigidity_mm, limits.max_rigidity_mm);
  return {};
}

std::string VerdictOn(const Calibration& calibration) {
  std::string verdict = fmt::format("usable: {:.3f} px RMS over {}", calibration.rms_px(),
                                    CountOf(CountUsed(calibration), "sighting"));
  const Camera& first = calibration.array.cameras.front();
  if (calibration.array.cameras.size() == 1)
    verdict +=
        fmt::format(", focal length {:.1f} +- {:.1f} px", first.lens.fx_px, first.sigmas.fx_px);
  if (calibration.held_out.distances > 0)
    verdict += fmt::format("; distances on held-out views right to {:.3f} mm",
                           calibration.held_out.rigidity_mm);
  return verdict;
}

}  // namespace

ReportTable CameraTable(const CameraArray& array) {
  ReportTable table = {
      "camera",
      {"x_mm", "y_mm", "z_mm", "sigma_mm", "sigma_deg", "time_offset_ms", "time_offset_sigma_ms"},
      {}};
  for (const Camera& camera : array.cameras) {
    const Eigen::Vector3d at = camera.cam_from_stage.Inverse().translation_mm;
    table.rows.push_back({camera.name,
                          {at.x(), at.y(), at.z(), camera.sigmas.translation_mm.norm(),
                           camera.sigmas.rotation_rad.norm() / kDegree, 1e3 * camera.time_offset_s,
                           1e3 * camera.sigmas.time_offset_s}});
  }
  return table;
}

void DescribePlacesAnew(const CameraArray& array, StageReport& report) {
  for (ReportTable& table : report.tables) {
    if (table.name == "mirror") table = MirrorTable(array);
    if (table.name != "camera") continue;
    ARTICAP_CHECK(table.rows.size() == array.cameras.size());
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const Camera& camera = array.cameras[i];
      const Eigen::Vector3d at = camera.cam_from_stage.Inverse().translation_mm;
      const std::array<double, 4> place = {at.x(), at.y(), at.z(),
                                           camera.sigmas.translation_mm.norm()};
      // What is not zero for the rounding of a frame's inverse alone is of no use to anybody.
      constexpr double kNothing_mm = 1e-9;
      std::transform(place.begin(), place.end(), table.rows[i].values.begin(),
                     [](double mm) { return std::abs(mm) < kNothing_mm ? 0 : mm; });
    }
  }
}

double Coverage::part() const {
  const auto seen = std::count_if(corners_in_field.begin(), corners_in_field.end(),
                                  [](int corners) { return corners > 0; });
  return static_cast<double>(seen) / static_cast<double>(corners_in_field.size());
}

std::vector<std::string> Coverage::gaps() const {
  const auto any = [&](int left, int right, int top, int bottom) {
    for (int row = top; row <= bottom; ++row)
      for (int column = left; column <= right; ++column)
        if (corners_in_field[row * kColumns + column] > 0) return true;
    return false;
  };
  std::vector<std::string> gaps;
  if (!any(0, 0, 0, kRows - 1)) gaps.emplace_back("the left edge");
  if (!any(kColumns - 1, kColumns - 1, 0, kRows - 1)) gaps.emplace_back("the right edge");
  if (!any(0, kColumns - 1, 0, 0)) gaps.emplace_back("the top");
  if (!any(0, kColumns - 1, kRows - 1, kRows - 1)) gaps.emplace_back("the bottom");
  return gaps;
}

Coverage CoverageOf(const Calibration& calibration, int camera_index) {
  const Camera& camera = calibration.array.cameras[camera_index];
  Coverage coverage;
  for (const SightingResult& sighting : calibration.sightings) {
    if (!sighting.used || sighting.view.camera != camera_index) continue;
    for (const Eigen::Vector2d& point : sighting.points_px) {
      const int column = static_cast<int>((point.x() + 0.5) * Coverage::kColumns / camera.width);
      const int row = static_cast<int>((point.y() + 0.5) * Coverage::kRows / camera.height);
      ++coverage.corners_in_field[std::clamp(row, 0, Coverage::kRows - 1) * Coverage::kColumns +
                                  std::clamp(column, 0, Coverage::kColumns - 1)];
    }
  }
  return coverage;
}

StageReport DescribeCalibration(const std::string& kind, const Calibration& calibration,
                                const CalibrationLimits& limits) {
  StageReport report;
  report.stage = kind;
  const std::string fault = FaultOf(calibration, limits);
  report.usable = fault.empty();
  report.verdict = report.usable ? VerdictOn(calibration) : fault;
  report.figures = {
      {"rms_px", calibration.rms_px()},
      {"sigma_px", calibration.sigma_px},
      {"sightings", static_cast<double>(CountUsed(calibration))},
      {"set_aside", static_cast<double>(calibration.sightings.size() - CountUsed(calibration))}};
  const HeldOut& held_out = calibration.held_out;
  if (!std::isnan(held_out.rms_px)) report.figures.emplace_back("held_out_rms_px", held_out.rms_px);
  if (held_out.distances > 0) {
    report.figures.emplace_back("held_out_rigidity_mm", held_out.rigidity_mm);
    report.figures.emplace_back("expected_rigidity_mm", held_out.expected_rigidity_mm);
  }
  report.texts = {{"board", NameOf(calibration.board)}};
  report.tables = {ViewTable(calibration), LensTable(calibration.array)};
  if (calibration.array.cameras.size() > 1) report.tables.push_back(CameraTable(calibration.array));
  if (!calibration.array.mirrors.empty()) report.tables.push_back(MirrorTable(calibration.array));
  report.tables.push_back(WorstSightings(calibration));
  WarnOfSetAside(calibration, report);
  WarnOfGaps(calibration, report);
  WarnOfFolds(calibration, report);
  return report;
}

}  // namespace articap
