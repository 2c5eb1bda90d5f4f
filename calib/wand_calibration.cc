// SPDX-License-Identifier: MIT
#include "calib/wand_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "calib/calibration_report.h"
#include "calib/instants.h"
#include "calib/robust.h"
#include "calib/view_noise.h"
#include "calib/wand_network.h"
#include "calib/wand_start.h"
#include "core/triangulation.h"

namespace articap {
namespace {

constexpr int kFewestPictures = 30;

// Pictures that show two markers, no more and no fewer.
std::size_t CountWands(const WandVideo& video) {
  return static_cast<std::size_t>(
      std::count_if(video.pictures.begin(), video.pictures.end(),
                    [](const WandPicture& picture) { return picture.points_px.size() == 2; }));
}

Result<void> RefuseUnknownTimes(const std::vector<WandVideo>& videos, const WandOptions& options) {
  const WandVideo& first = videos.front();
  for (const WandVideo& video : videos)
    if (video.has_times != first.has_times)
      return Fail(fmt::format(
          "{} is a video and {} separate pictures, so that nobody knows which were taken together; "
          "give one kind",
          video.has_times ? video.camera : first.camera,
          video.has_times ? first.camera : video.camera));
  if (!first.has_times && options.free_time_offsets)
    return Fail(fmt::format(
        "{}: separate pictures have no times, by which the cameras' clocks could be compared; give "
        "videos, or say --no-free-time-offsets where pictures of one number were taken together",
        first.camera));
  return {};
}

Result<void> RefuseUnusable(const std::vector<WandVideo>& videos, const WandOptions& options) {
  if (const auto lengths = RequirePositive(
          {{"length_mm", options.length_mm}, {"length_sigma_mm", options.length_sigma_mm}});
      !lengths)
    return lengths;
  if (videos.size() < 2) return Fail("a wand needs two cameras or more to be seen in depth");
  if (const auto times = RefuseUnknownTimes(videos, options); !times) return times;
  for (const WandVideo& video : videos)
    if (CountWands(video) < kFewestPictures)
      return Fail(fmt::format(
          "{}: {} of {} pictures show two markers, at least {} are needed; is the threshold right, "
          "are there other bright spots (lamps, reflections) in the picture?",
          video.camera, CountWands(video), video.pictures.size(), kFewestPictures));
  return {};
}

AdjustOptions OptionsFor(const std::vector<WandVideo>& videos, const WandOptions& options) {
  AdjustOptions adjust;
  LensFreedom freedom;
  freedom.focal = options.adjust_focal;
  freedom.distortion[Lens::kK1] = freedom.distortion[Lens::kK2] = options.adjust_radial;
  adjust.lenses.assign(videos.size(), freedom);
  adjust.free_time_offsets = options.free_time_offsets;
  adjust.huber_px = 2;
  return adjust;
}

// Of a view of the usual noise.
double MarkerSigma_px(const AdjustedWand& adjusted, const AdjustOptions& adjust) {
  std::vector<double> distances_px;
  for (std::size_t i = 0; i < adjusted.residuals_px.size(); ++i)
    for (const Eigen::Vector2d& residual : adjusted.residuals_px[i])
      distances_px.push_back(residual.norm() /
                             adjust.relative_noise[adjusted.network.sightings[i].camera]);
  return RobustSigmaOf(std::move(distances_px));
}

// Pictures whose markers are far from where they should be: reflections, other blobs.
void RemoveOutliers(const AdjustedWand& adjusted, const AdjustOptions& adjust,
                    WandNetwork& network) {
  std::vector<WandSighting> kept;
  for (std::size_t i = 0; i < network.sightings.size(); ++i) {
    const double noise_px = adjust.relative_noise[network.sightings[i].camera] * network.sigma_px;
    const double limit_px = std::max(0.5, 10 * noise_px);
    if (adjusted.residuals_px[i][0].norm() < limit_px &&
        adjusted.residuals_px[i][1].norm() < limit_px)
      kept.push_back(network.sightings[i]);
  }
  network.sightings = std::move(kept);
}

// The motion that the time offsets act on comes from where an adjustment starts: a few rounds, with
// weights and outliers by the last one's residuals.
Result<AdjustedWand> AdjustInRounds(WandNetwork network, AdjustOptions adjust,
                                    const WandOptions& options) {
  constexpr int kRounds = 6;
  constexpr int kFirstToRemove = 2;  // before that the residuals are those of the start
  AdjustedWand adjusted;
  for (int round = 0; round < kRounds; ++round) {
    if (network.sightings.empty())
      return Fail(
          "the cameras' views of the wand meet nowhere with its length; is the length right, are "
          "the bright spots its markers, were all cameras recording at the same time?");
    adjusted = AdjustWand(network, adjust);
    network = adjusted.network;
    WeighViews(adjusted.noise_px, adjusted.sigma_px, adjust);
    network.sigma_px = std::max(1e-3, MarkerSigma_px(adjusted, adjust));
    adjust.huber_px = options.huber_sigmas * network.sigma_px;
    if (round >= kFirstToRemove && round + 1 < kRounds) {
      RemoveOutliers(adjusted, adjust, network);
      KeepSharedInstants(network);
    }
  }
  return adjusted;
}

// Of each instant the distance between its ends, each by the rays of the cameras alone, which are
// first brought to the instant by the motion found.
std::vector<double> LengthsOf_mm(const WandNetwork& network, const std::vector<double>& noise_px) {
  const std::vector<double> times_s = InstantTimes_s(network);
  std::map<int, std::array<std::vector<Sight>, 2>> sights;
  for (const WandSighting& sighting : network.sightings) {
    const WandInstant& instant = network.instants[sighting.instant];
    const double after_s =
        sighting.time_s + network.array.cameras[sighting.camera].time_offset_s - instant.time_s;
    const auto moved = EndsAfter(network, times_s, sighting.instant, after_s);
    for (int end = 0; end < 2; ++end) {
      const View view{sighting.camera, -1};
      const auto now = Project(network.array, view, instant.ends_mm[end]);
      const auto then = Project(network.array, view, moved[end]);
      if (now && then)
        sights[sighting.instant][end].push_back(
            {view, sighting.ends_px[end] + *now - *then, noise_px[sighting.camera]});
    }
  }
  std::vector<double> lengths_mm;
  for (const auto& [instant, of_ends] : sights) {
    const auto a = Triangulate(network.array, of_ends[0]);
    const auto b = Triangulate(network.array, of_ends[1]);
    if (a && b) lengths_mm.push_back((a->point_in_stage_mm - b->point_in_stage_mm).norm());
  }
  return lengths_mm;
}

WandCalibration Summarize(const AdjustedWand& adjusted) {
  WandCalibration result;
  result.array = adjusted.network.array;
  result.sigma_px = adjusted.sigma_px;
  result.noise_px = adjusted.noise_px;
  result.parameters = adjusted.parameters;
  result.covariance = adjusted.covariance;
  DistanceRms rms;
  for (const auto& ends : adjusted.residuals_px) rms.Add(ends);
  result.rms_px = rms.px();
  result.lengths_mm = LengthsOf_mm(adjusted.network, adjusted.noise_px);
  result.instants = static_cast<int>(result.lengths_mm.size());
  const double count = static_cast<double>(result.lengths_mm.size());
  result.mean_length_mm =
      std::accumulate(result.lengths_mm.begin(), result.lengths_mm.end(), 0.0) / count;
  double variance = 0;
  for (double length_mm : result.lengths_mm)
    variance += std::pow(length_mm - result.mean_length_mm, 2) / count;
  result.wand_score = 100 * std::sqrt(variance) / result.mean_length_mm;
  return result;
}

// Groups the pictures by the clocks as they are.
Result<WandCalibration> CalibrateOnce(const std::vector<WandVideo>& videos,
                                      const WandOptions& options) {
  Result<WandNetwork> start = StartWandNetwork(videos, options.length_mm);
  if (!start) return tl::unexpected(start.error());
  start->length_sigma_mm = options.length_sigma_mm;
  const Result<AdjustedWand> adjusted =
      AdjustInRounds(*std::move(start), OptionsFor(videos, options), options);
  if (!adjusted) return tl::unexpected(adjusted.error());
  return Summarize(*adjusted);
}

std::vector<SessionTime> TimesOf(const WandVideo& video) {
  std::vector<SessionTime> times;
  for (const WandPicture& picture : video.pictures) times.push_back(picture.time);
  return times;
}

double LargestOffset_s(const CameraArray& array) {
  double largest_s = 0;
  for (const Camera& camera : array.cameras)
    largest_s = std::max(largest_s, std::abs(camera.time_offset_s));
  return largest_s;
}

// The videos with their clocks set by the offsets found.
std::vector<WandVideo> WithOffsets(std::vector<WandVideo> videos, const CameraArray& array) {
  for (std::size_t camera = 0; camera < videos.size(); ++camera)
    for (WandPicture& picture : videos[camera].pictures)
      picture.time =
          SessionTimeFromSeconds(SecondsOf(picture.time) + array.cameras[camera].time_offset_s);
  return videos;
}

StageReport Describe(const WandCalibration& wand, const WandOptions& options) {
  StageReport report;
  report.stage = "calibrate wand";
  report.usable = wand.rms_px <= options.max_rms_px && wand.wand_score <= options.max_wand_score;
  report.verdict =
      report.usable
          ? fmt::format("usable: wand score {:.3f} (100 SD / mean of {} lengths), {:.3f} px RMS",
                        wand.wand_score, wand.instants, wand.rms_px)
          : fmt::format(
                "the wand's length varies by {:.2f} % (limit {:g}), residuals are {:.2f} px (limit "
                "{:g}): are the lenses those of these cameras and pictures, was the wand stiff, "
                "are "
                "there other bright spots? Wave it slowly through the whole volume and record "
                "again",
                wand.wand_score, options.max_wand_score, wand.rms_px, options.max_rms_px);
  report.figures = {{"rms_px", wand.rms_px},
                    {"sigma_px", wand.sigma_px},
                    {"instants", static_cast<double>(wand.instants)},
                    {"mean_length_mm", wand.mean_length_mm},
                    {"wand_score", wand.wand_score}};
  ReportTable table = CameraTable(wand.array);
  table.columns.insert(table.columns.end(), {"fx_px", "noise_px"});
  for (std::size_t i = 0; i < wand.array.cameras.size(); ++i) {
    std::vector<double>& values = table.rows[i].values;
    values.insert(values.end(), {wand.array.cameras[i].lens.fx_px, wand.noise_px[i]});
  }
  report.tables = {std::move(table)};
  report.options = EchoOptions(options);
  return report;
}

}  // namespace

void VisitOptions(WandOptions& options, OptionVisitor& visit) {
  visit("length_mm", options.length_mm, "between the centres of the wand's two markers; mm");
  visit("length_sigma_mm", options.length_sigma_mm,
        "standard deviation of that length, as measured and while the wand is waved; mm");
  visit("adjust_focal", options.adjust_focal, "the focal lengths are only roughly known");
  visit("adjust_radial", options.adjust_radial,
        "the radial distortion (k1, k2) is only roughly known");
  visit("free_time_offsets", options.free_time_offsets,
        "the cameras are not synchronous: estimate each one's offset; false: the cameras are "
        "synchronous");
  visit("huber_sigmas", options.huber_sigmas, "markers off by more standard deviations count less");
  visit("max_rms_px", options.max_rms_px, "not usable with larger residuals; px");
  visit("max_wand_score", options.max_wand_score,
        "not usable where the wand's length varies more; percent");
}

Result<StageResult<WandCalibration>> CalibrateWand(const std::vector<WandVideo>& videos,
                                                   const WandOptions& options) {
  if (const auto usable = RefuseUnusable(videos, options); !usable)
    return tl::unexpected(usable.error());
  Result<WandCalibration> wand = CalibrateOnce(videos, options);
  if (!wand) return tl::unexpected(wand.error());
  // Clocks that are off by more than half an interval put pictures to the instants beside theirs.
  constexpr int kMostRegroupings = 4;
  for (int i = 0; i < kMostRegroupings; ++i) {
    if (LargestOffset_s(wand->array) < UsualInterval_s(TimesOf(videos[0])) / 2) break;
    Result<WandCalibration> again = CalibrateOnce(WithOffsets(videos, wand->array), options);
    if (!again || !(again->rms_px < wand->rms_px)) break;
    for (std::size_t camera = 0; camera < videos.size(); ++camera)
      again->array.cameras[camera].time_offset_s += wand->array.cameras[camera].time_offset_s;
    wand = std::move(again);
  }
  StageReport report = Describe(*wand, options);
  return StageResult<WandCalibration>{*std::move(wand), std::move(report)};
}

}  // namespace articap
