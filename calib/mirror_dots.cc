// SPDX-License-Identifier: MIT
#include "calib/mirror_dots.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "calib/mirror_rays.h"
#include "core/csv_rows.h"
#include "core/csv_values.h"
#include "core/file_io.h"
#include "core/statistics.h"

namespace articap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kFewestPairs = 12;
constexpr std::array<std::string_view, 6> kColumns = {"frame", "marker",      "x_px",
                                                      "y_px",  "mirror_x_px", "mirror_y_px"};

Result<std::optional<DotPair>> ParsePair(const std::vector<std::string_view>& cells,
                                         const std::string& where) {
  if (cells.size() != kColumns.size())
    return Fail(
        fmt::format("{}: {} cells where the header has {}", where, cells.size(), kColumns.size()));
  const auto frame = ParseInteger(cells[0]);
  if (!frame) return Fail(fmt::format("{}: frame '{}' is no whole number", where, cells[0]));
  DotPair pair{*frame, std::string(cells[1]), {}, {}};
  if (std::any_of(cells.begin() + 2, cells.end(), [](auto cell) { return cell.empty(); }))
    return std::nullopt;
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = ParseFinite(cells[i + 2]);
    if (!value)
      return Fail(fmt::format("{}: {} is '{}', not a number of pixels", where, kColumns[i + 2],
                              cells[i + 2]));
    values[i] = *value;
  }
  pair.direct_px = {values[0], values[1]};
  pair.mirrored_px = {values[2], values[3]};
  return pair;
}

std::vector<RayPair> RaysOf(const Lens& lens, const std::vector<DotPair>& dots) {
  std::vector<RayPair> rays;
  for (const DotPair& dot : dots) {
    const auto direct = Unproject(lens, dot.direct_px);
    const auto mirrored = Unproject(lens, dot.mirrored_px);
    if (direct && mirrored) rays.push_back({*direct, *mirrored});
  }
  return rays;
}

struct FoundNormal {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double sigma_px = 0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // across the normal, rad^2
};

// Two directions across a normal.
Eigen::Matrix<double, 3, 2> AcrossOf(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = normal.unitOrthogonal();
  across.col(1) = normal.cross(across.col(0));
  return across;
}

// Nothing where the planes of the dots hardly differ, so that any normal within them would do.
std::optional<Eigen::Vector3d> NormalByLines(const std::vector<RayPair>& rays) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const RayPair& pair : rays) {
    const Eigen::Vector3d plane = pair.direct.cross(pair.mirrored);
    sum += plane * plane.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
  if (!(eigen.eigenvalues()(1) > 1e-6 * eigen.eigenvalues()(2))) return std::nullopt;
  return eigen.eigenvectors().col(0);
}

// Minimises the squared Sampson distances, those beyond 2.5 deviations weighted down (Huber), by
// Gauss and Newton's method on the sphere.
std::optional<FoundNormal> FindNormal(const std::vector<RayPair>& rays, double focal_px) {
  constexpr int kSteps = 25;
  constexpr double kStep_rad = 1e-6;
  const auto start = NormalByLines(rays);
  if (!start) return std::nullopt;
  FoundNormal found{*start, 0, {}};
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Matrix<double, 3, 2> across = AcrossOf(found.normal);
    std::vector<double> sizes;
    for (const RayPair& pair : rays)
      sizes.push_back(std::abs(SampsonDistance_px(pair, found.normal, focal_px)));
    found.sigma_px = std::max(1e-9, 1.4826 * MedianOf(std::move(sizes)));
    Eigen::Matrix2d normal_matrix = Eigen::Matrix2d::Zero();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (const RayPair& pair : rays) {
      const double residual = SampsonDistance_px(pair, found.normal, focal_px);
      Eigen::Vector2d slope;
      for (int i = 0; i < 2; ++i)
        slope(i) = (SampsonDistance_px(pair, found.normal + kStep_rad * across.col(i), focal_px) -
                    SampsonDistance_px(pair, found.normal - kStep_rad * across.col(i), focal_px)) /
                   (2 * kStep_rad);
      const double weight = std::min(1.0, 2.5 * found.sigma_px / std::abs(residual));
      normal_matrix += weight * slope * slope.transpose();
      gradient += weight * residual * slope;
    }
    const Eigen::Vector2d change = -normal_matrix.ldlt().solve(gradient);
    found.covariance = found.sigma_px * found.sigma_px * normal_matrix.inverse();
    if (!change.allFinite()) return std::nullopt;
    found.normal = (found.normal + across * change).normalized();
    if (change.norm() < 1e-12) break;
  }
  return found;
}

struct UnitLengths {
  std::vector<double> lengths;  // of the known one, for a mirror at distance 1
  int placed = 0;               // dots that such a mirror could show
};

UnitLengths LengthsFor(const Lens& lens, const std::vector<DotPair>& dots,
                       const Eigen::Vector3d& normal, const MirrorDotsOptions& options) {
  std::map<std::int64_t, std::array<std::optional<Eigen::Vector3d>, 2>> ends;
  UnitLengths result;
  for (const DotPair& dot : dots) {
    const std::vector<RayPair> rays = RaysOf(lens, {dot});
    if (rays.empty()) continue;
    const auto place = PlaceDot(rays[0], normal);
    if (!place) continue;
    ++result.placed;
    if (dot.marker == options.length_from) ends[dot.frame][0] = *place;
    if (dot.marker == options.length_to) ends[dot.frame][1] = *place;
  }
  for (const auto& [frame, both] : ends)
    if (both[0] && both[1]) result.lengths.push_back((*both[0] - *both[1]).norm());
  return result;
}

double MeanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

struct SolvedMirror {
  FoundNormal normal;
  double distance_mm = 0;
  double length_sd_mm = 0;
  int lengths = 0;
};

Result<SolvedMirror> SolveMirror(const Lens& lens, const std::vector<DotPair>& dots,
                                 const MirrorDotsOptions& options) {
  const auto normal = FindNormal(RaysOf(lens, dots), lens.fx_px);
  if (!normal)
    return Fail(
        "the dots do not tell the mirror's direction: they lie in one plane with the camera; use "
        "dots "
        "above and below one another");
  SolvedMirror solved{*normal, 0, 0, 0};
  UnitLengths lengths = LengthsFor(lens, dots, solved.normal.normal, options);
  const UnitLengths other = LengthsFor(lens, dots, -solved.normal.normal, options);
  if (other.placed > lengths.placed) {
    solved.normal.normal *= -1;
    lengths = other;
  }
  if (2 * lengths.placed < static_cast<int>(dots.size()))
    return Fail(
        "no plane mirror could show most of the dots so; are the columns of the direct view and of "
        "the mirror exchanged?");
  if (lengths.lengths.empty())
    return Fail(fmt::format("in no picture are both {} and {} seen both ways; name two other dots",
                            options.length_from, options.length_to));
  double variance = 0;
  const auto count = static_cast<double>(lengths.lengths.size());
  const double mean = MeanOf(lengths.lengths);
  for (double length : lengths.lengths) variance += (length - mean) * (length - mean) / count;
  solved.distance_mm = options.length_mm / mean;
  solved.length_sd_mm = solved.distance_mm * std::sqrt(variance);
  solved.lengths = static_cast<int>(lengths.lengths.size());
  return solved;
}

// What the normal's own uncertainty does to the distance, mm: along both of its directions.
double DistanceSigmaByNormal_mm(const Lens& lens, const std::vector<DotPair>& dots,
                                const SolvedMirror& solved, const MirrorDotsOptions& options) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(solved.normal.covariance);
  double variance_mm2 = 0;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d turned = AcrossOf(solved.normal.normal) * eigen.eigenvectors().col(i) *
                                   std::sqrt(eigen.eigenvalues()(i));
    const UnitLengths lengths =
        LengthsFor(lens, dots, (solved.normal.normal + turned).normalized(), options);
    if (lengths.lengths.empty()) continue;
    variance_mm2 += std::pow(options.length_mm / MeanOf(lengths.lengths) - solved.distance_mm, 2);
  }
  return std::sqrt(variance_mm2);
}

// What a lens that is wrong by its sigma would change.
Result<SolvedMirror> SolveWithOtherFocal(const Camera& camera, const std::vector<DotPair>& dots,
                                         const MirrorDotsOptions& options) {
  Lens other = camera.lens;
  other.fx_px *= 1 + options.focal_sigma_percent / 100;
  other.fy_px *= 1 + options.focal_sigma_percent / 100;
  return SolveMirror(other, dots, options);
}

StageReport Describe(const DotMirror& result, const MirrorDotsOptions& options) {
  const Mirror& mirror = result.array.mirrors[0];
  const double sigma_deg = mirror.normal_sigma_rad / kDegree;
  StageReport report;
  report.stage = "calibrate mirror-dots";
  report.usable = sigma_deg <= options.max_normal_sigma_deg;
  report.verdict =
      report.usable
          ? fmt::format(
                "usable: the mirror's direction is known to {:.2f} degrees, its distance to "
                "{:.1f} mm of {:.0f}; a board would tell both ten times better",
                sigma_deg, mirror.distance_sigma_mm, mirror.distance_mm)
          : fmt::format(
                "the mirror's direction is known to {:.2f} degrees only, limit {:g}: use more "
                "dots, farther apart, and a lens that was calibrated",
                sigma_deg, options.max_normal_sigma_deg);
  report.figures = {{"pairs", static_cast<double>(result.pairs)},
                    {"epipolar_sigma_px", result.epipolar_sigma_px},
                    {"lengths", static_cast<double>(result.lengths)},
                    {"length_sd_mm", result.length_sd_mm},
                    {"normal_sigma_deg", sigma_deg},
                    {"distance_mm", mirror.distance_mm},
                    {"distance_sigma_mm", mirror.distance_sigma_mm}};
  report.options = EchoOptions(options);
  return report;
}

}  // namespace

void VisitOptions(MirrorDotsOptions& options, OptionVisitor& visit) {
  visit("length_from", options.length_from, "a dot from which a length is known");
  visit("length_to", options.length_to, "the dot to which it is known");
  visit("length_mm", options.length_mm, "the distance between the two, which must not change; mm");
  visit("length_sigma_mm", options.length_sigma_mm, "how well a ruler tells it; mm");
  visit("focal_sigma_percent", options.focal_sigma_percent,
        "how well the lens' focal length is known; percent");
  visit("max_normal_sigma_deg", options.max_normal_sigma_deg,
        "not usable where the mirror's direction is known worse; degrees");
}

Result<std::vector<DotPair>> ParseDotPairs(const std::string& text,
                                           const std::string& source_name) {
  CsvRows rows(text, source_name);
  std::vector<std::string_view> cells;
  const auto has_header = rows.Next(cells);
  if (!has_header) return tl::unexpected(has_header.error());
  if (!*has_header || !std::ranges::equal(cells, kColumns))
    return Fail(fmt::format(
        "{}: its first line must be frame,marker,x_px,y_px,mirror_x_px,mirror_y_px", source_name));
  std::vector<DotPair> dots;
  std::set<std::pair<std::int64_t, std::string>> seen;
  for (;;) {
    const auto has_row = rows.Next(cells);
    if (!has_row) return tl::unexpected(has_row.error());
    if (!*has_row) return dots;
    auto pair = ParsePair(cells, rows.Where());
    if (!pair) return tl::unexpected(pair.error());
    if (!*pair) continue;
    if (!seen.emplace((*pair)->frame, (*pair)->marker).second)
      return Fail(fmt::format("{}: dot '{}' is there twice in frame {}", rows.Where(),
                              (*pair)->marker, (*pair)->frame));
    dots.push_back(**std::move(pair));
  }
}

Result<std::vector<DotPair>> ReadDotPairs(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseDotPairs(*text, path.string());
}

Result<StageResult<DotMirror>> CalibrateMirrorFromDots(const Camera& camera,
                                                       const std::vector<DotPair>& dots,
                                                       const MirrorDotsOptions& options) {
  if (const auto lengths = RequirePositive({{"length_mm", options.length_mm}}); !lengths)
    return tl::unexpected(lengths.error());
  if (static_cast<int>(dots.size()) < kFewestPairs)
    return Fail(fmt::format("{} dots are seen both ways, at least {} are needed, better hundreds",
                            dots.size(), kFewestPairs));
  const Result<SolvedMirror> solved = SolveMirror(camera.lens, dots, options);
  if (!solved) return tl::unexpected(solved.error());
  const Result<SolvedMirror> other = SolveWithOtherFocal(camera, dots, options);
  if (!other) return tl::unexpected(other.error());

  DotMirror result;
  result.array.cameras = {camera};
  Mirror mirror;
  mirror.name = "mirror";
  mirror.normal_in_stage = solved->normal.normal;
  mirror.distance_mm = solved->distance_mm;
  const double by_dots_rad =
      std::sqrt(solved->normal.covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
  const double by_lens_rad = solved->normal.normal.cross(other->normal.normal).norm();
  mirror.normal_sigma_rad = std::hypot(by_dots_rad, by_lens_rad);
  // The mean length is as uncertain as the ruler, and as its scatter leaves it.
  const double of_length =
      std::hypot(options.length_sigma_mm, solved->length_sd_mm / std::sqrt(solved->lengths));
  mirror.distance_sigma_mm = std::hypot(
      solved->distance_mm * of_length / options.length_mm, other->distance_mm - solved->distance_mm,
      DistanceSigmaByNormal_mm(camera.lens, dots, *solved, options));
  result.array.mirrors = {mirror};
  result.pairs = static_cast<int>(dots.size());
  result.epipolar_sigma_px = solved->normal.sigma_px;
  result.length_sd_mm = solved->length_sd_mm;
  result.lengths = solved->lengths;
  StageReport report = Describe(result, options);
  return StageResult<DotMirror>{std::move(result), std::move(report)};
}

}  // namespace articap
