// SPDX-License-Identifier: MIT
#include "calib/nominal_mirror.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "calib/mirror_rays.h"
#include "core/alignment.h"
#include "core/statistics.h"

namespace articap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Cameras for video, from wide webcams to camcorders: the focal length over the picture's width,
// and how much it varies, SD of the logarithm.
constexpr double kUsualFocal = 1.1, kUsualFocalSigma = 0.5, kGivenFocalSigma = 0.05;
constexpr double kTiltSigma_rad = 3 * kDegree;
// What a lens that nobody calibrated moves dots against one another.
constexpr double kLeastSigma_px = 0.25;
// An edge may be off by so much, SD: blur, compression, saturation.
constexpr double kEdgeSigma_px = 0.1;
constexpr int kMostFrames = 200;
constexpr double kNormal = 1.4826;  // standard deviation over median distance

// What is known before any dot is seen.
struct Prior {
  NominalParameters mean;
  NominalParameters sigma;
  double side;
};

Prior PriorOf(const Camera& camera, double side, const NominalMirrorOptions& options) {
  const double focal_px = options.focal_px.value_or(kUsualFocal * camera.width);
  return {{std::log(focal_px), options.mirror_angle_deg * kDegree, 0},
          {options.focal_px ? kGivenFocalSigma : kUsualFocalSigma,
           options.mirror_angle_sigma_deg * kDegree, kTiltSigma_rad},
          side};
}

// Parameters by the dots and what was known before.
struct Solution {
  NominalParameters parameters;
  std::vector<MatchedDot> matched;
  double sigma_px = 0;
};

double SigmaOf_px(const std::vector<SplitFrame>& frames, const Solution& solution, double side) {
  std::vector<double> distances_px;
  for (const MatchedDot& match : solution.matched) {
    double distance_px = 0;
    MirrorDirectionCost{frames[match.frame].direct_px[match.direct],
                        frames[match.frame].mirrored_px[match.mirrored], side,
                        1}(solution.parameters.data(), &distance_px);
    distances_px.push_back(std::abs(distance_px));
  }
  return kNormal * MedianOf(std::move(distances_px));
}

// The problem of the parameters in `solution`, which it refers to.
void AddResiduals(const std::vector<SplitFrame>& frames, const Prior& prior, Solution& solution,
                  ceres::Problem& problem) {
  constexpr double kHuberSigmas = 2.5;
  const double sigma_px = std::max(kLeastSigma_px, solution.sigma_px);
  for (const MatchedDot& match : solution.matched)
    problem.AddResidualBlock(
        MirrorDirectionCost::Create(frames[match.frame].direct_px[match.direct],
                                    frames[match.frame].mirrored_px[match.mirrored], prior.side,
                                    sigma_px),
        // All frames together count as one.
        new ceres::ScaledLoss(new ceres::HuberLoss(kHuberSigmas),
                              1 / static_cast<double>(frames.size()), ceres::TAKE_OWNERSHIP),
        solution.parameters.data());
  const Eigen::Map<const Eigen::Array3d> sigma(prior.sigma.data());
  problem.AddResidualBlock(
      new ceres::NormalPrior(Eigen::Matrix3d(sigma.inverse().matrix().asDiagonal()),
                             Eigen::Map<const Eigen::Vector3d>(prior.mean.data())),
      nullptr, solution.parameters.data());
}

void Solve(const std::vector<SplitFrame>& frames, const Prior& prior, Solution& solution) {
  solution.sigma_px = SigmaOf_px(frames, solution, prior.side);
  ceres::Problem problem;
  AddResiduals(frames, prior, solution, problem);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  solution.sigma_px = SigmaOf_px(frames, solution, prior.side);
}

// Of the parameters; nothing where they cannot be told.
std::optional<Eigen::Matrix3d> CovarianceOf(const std::vector<SplitFrame>& frames,
                                            const Prior& prior, Solution solution) {
  ceres::Problem problem;
  AddResiduals(frames, prior, solution, problem);
  ceres::Covariance covariance((ceres::Covariance::Options()));
  const double* const block = solution.parameters.data();
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> result;
  const std::vector<std::pair<const double*, const double*>> blocks = {{block, block}};
  if (!covariance.Compute(blocks, &problem) ||
      !covariance.GetCovarianceBlock(block, block, result.data()))
    return std::nullopt;
  return Eigen::Matrix3d(result);
}

// Where directions of mirrors are tried that match dots at all, the best first.
std::vector<NominalParameters> TryDirections(const std::vector<SplitFrame>& frames,
                                             const Prior& prior, double gate_px) {
  constexpr int kFocals = 61, kTilts = 81, kKept = 8;
  constexpr double kSigmas = 3;
  constexpr std::size_t kFramesTried = 12;
  std::vector<SplitFrame> tried;
  for (std::size_t i = 0; i < frames.size(); i += frames.size() / kFramesTried + 1)
    tried.push_back(frames[i]);
  // Another angle is, to the lines, another focal length.
  const double by_angle = prior.sigma[kMirrorAngle] / std::sin(2 * prior.mean[kMirrorAngle]) * 2;
  const double reach = kSigmas * std::hypot(prior.sigma[kLogFocal], by_angle);
  std::vector<std::pair<std::size_t, NominalParameters>> counted;
  for (int i = 0; i < kFocals; ++i)
    for (int k = 0; k < kTilts; ++k) {
      NominalParameters parameters = prior.mean;
      parameters[kLogFocal] += reach * (2.0 * i / (kFocals - 1) - 1);
      parameters[kMirrorTilt] += kSigmas * prior.sigma[kMirrorTilt] * (2.0 * k / (kTilts - 1) - 1);
      counted.emplace_back(MatchMirrored(tried, parameters, prior.side, gate_px).size(),
                           parameters);
    }
  std::stable_sort(counted.begin(), counted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<NominalParameters> best;
  for (int i = 0; i < kKept; ++i) best.push_back(counted[i].second);
  return best;
}

// Matches and solves in turns, with less and less tolerance.
std::optional<Solution> Refine(const std::vector<SplitFrame>& frames, const Prior& prior,
                               const NominalParameters& start, double diameter_px) {
  constexpr std::array kGates = {0.25, 0.25, 0.12, 0.12};  // diameters of dots
  Solution solution = {start, {}, 0};
  for (const double gate : kGates) {
    solution.matched = MatchMirrored(frames, solution.parameters, prior.side, gate * diameter_px);
    if (solution.matched.size() < frames.size()) return std::nullopt;
    Solve(frames, prior, solution);
  }
  return solution;
}

double MedianDiameter_px(const std::vector<SplitFrame>& frames) {
  std::vector<double> diameters_px;
  for (const SplitFrame& frame : frames)
    for (const Dot* dot : frame.direct) diameters_px.push_back(dot->diameter_px());
  return MedianOf(std::move(diameters_px));
}

std::optional<Solution> FindMirror(const std::vector<SplitFrame>& frames, const Prior& prior) {
  const double diameter_px = MedianDiameter_px(frames);
  std::optional<Solution> best;
  for (const NominalParameters& start : TryDirections(frames, prior, diameter_px / 4)) {
    std::optional<Solution> found = Refine(frames, prior, start, diameter_px);
    if (found && (!best || found->matched.size() > best->matched.size())) best = std::move(found);
  }
  return best;
}

// The matched dots for a mirror at distance 1, with what their diameters would be of 1, px.
struct PlacedDots {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> scales;  // of the mirror's distance to the dots' diameter
  double oblique = 0;          // how much more a ball's outline is, than a disc's, on the average
};

PlacedDots PlaceDots(const std::vector<SplitFrame>& frames, const std::vector<MatchedDot>& matched,
                     const NominalParameters& parameters, double side) {
  const double focal_px = std::exp(parameters[kLogFocal]);
  const Eigen::Vector3d normal = NominalNormal(parameters.data(), side);
  PlacedDots placed;
  for (const MatchedDot& match : matched) {
    const SplitFrame& frame = frames[match.frame];
    const RayPair rays = {(frame.direct_px[match.direct] / focal_px).homogeneous(),
                          (frame.mirrored_px[match.mirrored] / focal_px).homogeneous()};
    const auto point = PlaceDot(rays, normal);
    if (!point) continue;
    placed.points.push_back(*point);
    const Dot& dot = *frame.direct[match.direct];
    // Of a disc, however it is turned, the longest diameter is its own. A ball's is longer beside
    // the axis, by the cosine; half of that is allowed for, and the other half is uncertain.
    const double longest_px =
        2 * std::sqrt(dot.shape_px2.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
    const double cosine = rays.direct.normalized().z();
    placed.scales.push_back(focal_px / (longest_px * std::sqrt(cosine) * point->z()));
    placed.oblique += (1 - cosine) / static_cast<double>(matched.size());
  }
  return placed;
}

struct ScaleFound {
  double distance_mm;  // of the mirror
  double sigma;        // over it
};

ScaleFound ScaleByDiameter(const PlacedDots& placed, double dot_diameter_mm, double diameter_px) {
  const double median = MedianOf(placed.scales);
  std::vector<double> apart;
  for (const double scale : placed.scales) apart.push_back(std::abs(scale / median - 1));
  return {median * dot_diameter_mm, std::hypot(kNormal * MedianOf(std::move(apart)),
                                               placed.oblique / 2, kEdgeSigma_px / diameter_px)};
}

// By how far apart the direct dots of a frame lie in height, on the median.
ScaleFound ScaleByHeights(const std::vector<SplitFrame>& frames, const PlacedDots& placed,
                          double focal_px, double usual_spread_mm) {
  constexpr double kRoughly = 0.15;
  std::vector<double> depths, spreads_px;
  for (const Eigen::Vector3d& point : placed.points) depths.push_back(point.z());
  for (const SplitFrame& frame : frames) {
    double sum = 0, squares = 0;
    for (const Eigen::Vector2d& dot : frame.direct_px) {
      sum += dot.y();
      squares += dot.y() * dot.y();
    }
    const auto count = static_cast<double>(frame.direct_px.size());
    spreads_px.push_back(std::sqrt(std::max(0.0, squares / count - std::pow(sum / count, 2))));
  }
  const double spread = MedianOf(std::move(spreads_px)) * MedianOf(std::move(depths)) / focal_px;
  return {usual_spread_mm / std::max(spread, 1e-9), kRoughly};
}

// What errors of the parameters do to the shape; over the mirror's distance.
double ShapeSigma(const std::vector<SplitFrame>& frames, const Solution& solution,
                  const Eigen::Matrix3d& covariance, double side) {
  const PlacedDots nominal = PlaceDots(frames, solution.matched, solution.parameters, side);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  double squares = 0;
  for (int axis = 0; axis < kNumNominal; ++axis) {
    NominalParameters other = solution.parameters;
    Eigen::Map<Eigen::Vector3d>(other.data()) +=
        std::sqrt(std::max(0.0, axes.eigenvalues()(axis))) * axes.eigenvectors().col(axis);
    const PlacedDots moved = PlaceDots(frames, solution.matched, other, side);
    if (moved.points.size() != nominal.points.size()) continue;
    squares += std::pow(
        AlignmentRms(AlignSimilarity(moved.points, nominal.points), moved.points, nominal.points),
        2);
  }
  return std::sqrt(squares);
}

NominalMirror MirrorOf(const CameraArray& array, const std::vector<SplitFrame>& frames,
                       const Solution& solution, const Eigen::Matrix3d& covariance, double side) {
  NominalMirror result;
  result.array = array;
  result.array.source = "articap track --uncalibrated: nominal, from dots";
  result.pairs = static_cast<int>(solution.matched.size());
  result.frames = static_cast<int>(frames.size());
  result.sigma_px = solution.sigma_px;
  result.angle_rad = solution.parameters[kMirrorAngle];
  result.angle_sigma_rad = std::sqrt(covariance(kMirrorAngle, kMirrorAngle));
  result.tilt_rad = solution.parameters[kMirrorTilt];
  result.focal_sigma = std::sqrt(covariance(kLogFocal, kLogFocal));
  result.shape_sigma = ShapeSigma(frames, solution, covariance, side);
  Camera& camera = result.array.cameras[0];
  camera.lens = CentredLens(std::exp(solution.parameters[kLogFocal]), camera.width, camera.height);
  camera.sigmas.fx_px = camera.sigmas.fy_px = camera.lens.fx_px * result.focal_sigma;
  Mirror& mirror = result.array.mirrors[0];
  mirror.normal_in_stage = NominalNormal(solution.parameters.data(), side).normalized();
  mirror.distance_mm = 1;
  mirror.normal_sigma_rad = std::sqrt(
      std::max(covariance(kMirrorAngle, kMirrorAngle), covariance(kMirrorTilt, kMirrorTilt)));
  return result;
}

// Whether the mirror is on the right, from its region.
double SideOf(const CameraArray& array) {
  const PictureRegion& region = *array.mirrors[0].region;
  return 2 * region.left + region.width > array.cameras[0].width ? 1 : -1;
}

// How to draw a region, for messages.
std::string Drawn(const DotVideo& video, MirrorSide side) {
  const int half = video.width / 2;
  const int left = side == MirrorSide::kLeft ? 0 : video.width - half;
  return fmt::format("--view-regions {}/mirror={}", video.camera,
                     FormatPictureRegion({left, 0, half, video.height}));
}

Result<CameraArray> WithMirrorRegion(const DotVideo& video, CameraArray array, MirrorSide side) {
  if (array.mirrors[0].region) return array;
  if (side == MirrorSide::kByRegion)
    return Fail(fmt::format(
        "which part of the picture shows the mirror? Say --mirror-side left or right, of the "
        "picture, or draw its region, as {}",
        Drawn(video, side)));
  const Result<PictureBand> band = BandBesideMirror(video);
  if (!band)
    return Fail(fmt::format("{} Draw its region, as {}", band.error().message, Drawn(video, side)));
  const auto middle = static_cast<int>(std::lround((band->from_px + band->to_px) / 2));
  array.mirrors[0].region = side == MirrorSide::kLeft
                                ? PictureRegion{0, 0, middle, video.height}
                                : PictureRegion{middle, 0, video.width - middle, video.height};
  return array;
}

// Of all frames, on the average.
double PairsToBeFound(const std::vector<SplitFrame>& frames) {
  constexpr double kFewest = 2, kLeastShare = 0.5;
  double direct = 0, mirrored = 0;
  for (const SplitFrame& frame : frames) {
    direct += static_cast<double>(frame.direct_px.size());
    mirrored += static_cast<double>(frame.mirrored_px.size());
  }
  return std::max(kFewest,
                  kLeastShare * std::min(direct, mirrored) / static_cast<double>(frames.size()));
}

Result<Solution> SolutionOf(const DotVideo& video, const std::vector<SplitFrame>& frames,
                            const Prior& prior) {
  constexpr int kFewestFrames = 5;
  if (static_cast<int>(frames.size()) < kFewestFrames)
    return Fail(fmt::format(
        "{}: {} of {} frames show two dots or more both on the face and in the mirror, at least {} "
        "are needed: is the mirror on that side of the picture, and does it show the dots?",
        video.camera, frames.size(), video.pictures.size(), kFewestFrames));
  const double wanted = PairsToBeFound(frames);
  const std::optional<Solution> found = FindMirror(frames, prior);
  const double pairs =
      found ? static_cast<double>(found->matched.size()) / static_cast<double>(frames.size()) : 0;
  if (pairs < wanted)
    return Fail(fmt::format(
        "{}: the dots of face and mirror do not match: {:.1f} a frame lie as dots and their "
        "reflections would, at least {:.1f} are needed; is the mirror upright and plane, its angle "
        "right (--mirror-angle-deg), and on that side of the picture?",
        video.camera, pairs, wanted));
  return *found;
}

}  // namespace

void VisitOptions(NominalMirrorOptions& options, OptionVisitor& visit) {
  visit.Enumeration("mirror_side", options.mirror_side, {"by-region", "left", "right"},
                    "the side of the picture that shows the mirror");
  visit("mirror_angle_deg", options.mirror_angle_deg,
        "between the mirror and the camera's axis; degrees");
  visit("mirror_angle_sigma_deg", options.mirror_angle_sigma_deg,
        "how well that is known, SD; degrees");
  visit("focal_px", options.focal_px,
        "focal length, where it is known to 5 %; else the mirror's angle tells it; "
        "px");
}

Result<void> CheckOptions(const NominalMirrorOptions& options) {
  if (auto checked = RequirePositive({{"mirror_angle_sigma_deg", options.mirror_angle_sigma_deg},
                                      {"focal_px", options.focal_px.value_or(1)}});
      !checked)
    return checked;
  constexpr double kLeast_deg = 20, kMost_deg = 70;
  if (!(options.mirror_angle_deg >= kLeast_deg && options.mirror_angle_deg <= kMost_deg))
    return Fail(fmt::format("mirror_angle_deg is {}; it must lie between {} and {}",
                            options.mirror_angle_deg, kLeast_deg, kMost_deg));
  return {};
}

CameraArray UnknownMirror(const std::string& camera, int width, int height) {
  CameraArray array;
  array.cameras = {{.name = camera,
                    .width = width,
                    .height = height,
                    .lens = CentredLens(kUsualFocal * width, width, height)}};
  array.mirrors = {{.name = "mirror"}};
  return array;
}

void NominalMirror::Rescale(double factor, double sigma) {
  Mirror& mirror = array.mirrors[0];
  mirror.distance_mm *= factor;
  mirror.distance_sigma_mm = sigma * mirror.distance_mm;
  scale_sigma = sigma;
}

Result<NominalMirror> EstimateNominalMirror(const DotVideo& video, const CameraArray& array,
                                            const NominalScale& scale,
                                            const NominalMirrorOptions& options) {
  const Result<CameraArray> split = WithMirrorRegion(video, array, options.mirror_side);
  if (!split) return tl::unexpected(split.error());
  const double side = SideOf(*split);
  const std::vector<SplitFrame> frames = SplitFrames(video, *split, kMostFrames);
  const Prior prior = PriorOf(split->cameras[0], side, options);
  const Result<Solution> solution = SolutionOf(video, frames, prior);
  if (!solution) return tl::unexpected(solution.error());
  const auto covariance = CovarianceOf(frames, prior, *solution);
  const PlacedDots placed = PlaceDots(frames, solution->matched, solution->parameters, side);
  if (!covariance || 2 * placed.points.size() < solution->matched.size())
    return Fail(fmt::format(
        "{}: no mirror on that side of the picture could show the dots so; is the face on it, and "
        "the mirror on the other?",
        video.camera));
  NominalMirror result = MirrorOf(*split, frames, *solution, *covariance, side);
  const ScaleFound found =
      scale.dot_diameter_mm
          ? ScaleByDiameter(placed, *scale.dot_diameter_mm, MedianDiameter_px(frames))
          : ScaleByHeights(frames, placed, result.array.cameras[0].lens.fx_px,
                           scale.usual_spread_mm);
  result.Rescale(found.distance_mm, found.sigma);
  std::vector<double> distances;
  for (const Eigen::Vector3d& point : placed.points) distances.push_back(point.norm());
  result.distance = MedianOf(std::move(distances));
  return result;
}

StageReport DescribeNominalMirror(const NominalMirror& mirror, const std::string& scale_source,
                                  const NominalMirrorOptions& options) {
  const double distance_mm = mirror.array.mirrors[0].distance_mm;
  const double shape_mm = mirror.shape_sigma * distance_mm;
  StageReport report;
  report.stage = "uncalibrated";
  report.verdict = fmt::format(
      "nothing was calibrated: lengths, by {}, are right to {:.1f} %, and the face's shape to "
      "{:.1f} mm besides (standard deviations); positions are relative to the nose",
      scale_source, 100 * mirror.scale_sigma, shape_mm);
  report.figures = {{"pairs", mirror.pairs},
                    {"frames_looked_at", mirror.frames},
                    {"epipolar_sigma_px", mirror.sigma_px},
                    {"focal_px", mirror.array.cameras[0].lens.fx_px},
                    {"focal_sigma_percent", 100 * mirror.focal_sigma},
                    {"mirror_angle_deg", mirror.angle_rad / kDegree},
                    {"mirror_angle_sigma_deg", mirror.angle_sigma_rad / kDegree},
                    {"mirror_tilt_deg", mirror.tilt_rad / kDegree},
                    {"face_distance_mm", mirror.distance * distance_mm},
                    {"scale_sigma_percent", 100 * mirror.scale_sigma},
                    {"shape_sigma_mm", shape_mm}};
  report.options = EchoOptions(options);
  report.warnings = {
      "the lens is taken to be a pinhole without distortion in the middle of the picture, the "
      "mirror to be a plane at its given angle: depths may be stretched against heights, and the "
      "head be turned, by what these are off; articap calibrate mirror, with a board, measures "
      "them"};
  return report;
}

}  // namespace articap
