// SPDX-License-Identifier: MIT
#include "fitting/fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/bind.h"
#include "fitting/fit_report.h"
#include "fitting/spikes.h"
#include "fitting/take_fitter.h"
#include "rig/attachment.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The spatial median of three-dimensional normal noise needs 3 pi / 8 times the variance of the
// mean (Brown 1983).
const double kDistanceInefficiency = std::sqrt(3 * M_PI / 8);

struct FaceMarkers {
  std::vector<VirtualMarker> markers;
  std::vector<int> columns;  // of the take's tracks
};

Result<void> CheckOptions(const FitOptions& options) {
  if (auto good = RequirePositive({{"epsilon_mm", options.epsilon_mm},
                                   {"huber_mm", options.huber_mm},
                                   {"marker_sigma_mm", options.marker_sigma_mm},
                                   {"max_sigma_of_range", options.max_sigma_of_range}});
      !good)
    return good;
  return RequireNotNegative({{"smoothing_s", options.smoothing_s},
                             {"max_acceleration_m_s2", options.max_acceleration_m_s2},
                             {"refine_frames", options.refine_frames},
                             {"threads", options.threads}});
}

// The binding's virtual markers that the take has.
FaceMarkers MatchMarkers(const HeadTracks& tracks, const Binding& binding, StageReport* report) {
  FaceMarkers face;
  std::vector<std::string> absent;
  for (const VirtualMarker& marker : binding.virtual_markers) {
    const auto column = tracks.Find(marker.name);
    if (column && tracks.CountMissing(*column) < tracks.num_frames()) {
      face.markers.push_back(marker);
      face.columns.push_back(*column);
    } else {
      absent.push_back(marker.name);
    }
  }
  if (!absent.empty())
    report->warnings.push_back(fmt::format(
        "face markers of the binding that this take does not have: {}", fmt::join(absent, ", ")));
  return face;
}

RigTracks MeasuredInRig(const HeadTracks& tracks, const FaceMarkers& face,
                        const Sim3d& rig_from_head) {
  std::vector<std::string> names;
  for (const VirtualMarker& marker : face.markers) names.push_back(marker.name);
  HeadTracks chosen(names, tracks.num_frames(), tracks.rate_hz(), tracks.first_frame(),
                    tracks.start());
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (std::size_t i = 0; i < face.columns.size(); ++i)
      if (const int column = face.columns[i]; !tracks.is_missing(frame, column))
        chosen.Set(frame, static_cast<int>(i), tracks.position_mm(frame, column),
                   tracks.state(frame, column), tracks.sigma_mm(frame, column));
  return AlignToRig(chosen, rig_from_head);
}

void CountFilled(const RigTracks& tracks, StageReport* report) {
  int filled = 0;
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (const SampleState state : tracks.states(frame)) filled += state == SampleState::kFilled;
  if (filled == 0) return;
  report->figures.emplace_back("filled_samples", filled);
  report->warnings.push_back(
      fmt::format("{} samples were not seen but filled in by whoever made the file, and are fitted "
                  "like the others: what is fitted to them alone is that filling",
                  filled));
}

// The tracks without their spikes, which the report counts and names.
RigTracks WithoutSpikes(RigTracks tracks, const FitOptions& options, double rig_scale,
                        StageReport* report) {
  if (options.max_acceleration_m_s2 <= 0) return tracks;
  SpikeLimits limits;
  limits.max_acceleration_mm_s2 = 1e3 * rig_scale * options.max_acceleration_m_s2;
  limits.noise_mm *= rig_scale;
  std::vector<int> counts(tracks.num_markers());
  const std::vector<Spike> spikes = FindSpikes(tracks, limits);
  for (const Spike& spike : spikes) {
    tracks.SetMissing(spike.frame, spike.marker);
    ++counts[spike.marker];
  }
  report->figures.emplace_back("spikes", static_cast<double>(spikes.size()));
  if (spikes.empty()) return tracks;
  const auto worst = std::max_element(counts.begin(), counts.end());
  report->warnings.push_back(
      fmt::format("{} samples are spikes, which no face could have followed ({}: {} of them), and "
                  "were left out "
                  "of the fit (--max-acceleration-m-s2 0 keeps them)",
                  spikes.size(), tracks.names()[worst - counts.begin()], *worst));
  return tracks;
}

// Frames spread evenly over the take.
std::vector<int> SpreadFrames(int num_frames, int wanted) {
  std::vector<int> frames;
  const int count = std::min(num_frames, wanted);
  for (int i = 0; i < count; ++i)
    frames.push_back(static_cast<int>((2LL * i + 1) * num_frames / (2LL * count)));
  return frames;
}

// Some frames of a take, one after the other.
RigTracks ChosenFrames(const RigTracks& tracks, const std::vector<int>& frames) {
  RigTracks chosen(tracks.names(), static_cast<int>(frames.size()), tracks.rate_hz());
  for (int i = 0; i < chosen.num_frames(); ++i)
    for (int marker = 0; marker < tracks.num_markers(); ++marker)
      if (!tracks.is_missing(frames[i], marker))
        chosen.Set(i, marker, tracks.position_mm(frames[i], marker));
  return chosen;
}

RigTracks VirtualMarkerTracks(const RigTracks& measured, const FrameFits& fits) {
  RigTracks tracks(measured.names(), measured.num_frames(), measured.rate_hz(),
                   measured.first_frame(), measured.start());
  for (int frame = 0; frame < measured.num_frames(); ++frame)
    for (int marker = 0; marker < measured.num_markers(); ++marker) {
      const Eigen::Vector3d position = fits.positions_mm.row(frame).segment<3>(3 * marker);
      if (position.allFinite()) tracks.Set(frame, marker, position);
    }
  return tracks;
}

// |q - p| in mm of the speaker, frames x markers.
Eigen::MatrixXf Residuals(const RigTracks& measured, const RigTracks& virtual_markers,
                          double rig_scale) {
  Eigen::MatrixXf residuals = Eigen::MatrixXf::Constant(
      measured.num_frames(), measured.num_markers(), std::numeric_limits<float>::quiet_NaN());
  for (int frame = 0; frame < measured.num_frames(); ++frame)
    for (int marker = 0; marker < measured.num_markers(); ++marker)
      if (!measured.is_missing(frame, marker) && !virtual_markers.is_missing(frame, marker))
        residuals(frame, marker) = static_cast<float>(
            (virtual_markers.position_mm(frame, marker) - measured.position_mm(frame, marker))
                .norm() /
            rig_scale);
  return residuals;
}

const char* UnitName(ParameterUnit unit) {
  switch (unit) {
    case ParameterUnit::kRadian:
      return "rad";
    case ParameterUnit::kMillimetre:
      return "mm";
    case ParameterUnit::kWeight:
      break;
  }
  return "1";
}

ParameterTrack TrackOf(const FaceRig& rig, const RigTracks& measured, const FrameFits& fits,
                       const Eigen::MatrixXf& residuals_mm, double sigma_per_unit) {
  ParameterTrack track;
  for (const RigParameter& parameter : rig.definition().parameters) {
    track.names.push_back(parameter.name);
    track.units.push_back(UnitName(parameter.unit));
  }
  track.rate_hz = measured.rate_hz();
  track.first_frame = measured.first_frame();
  track.start = measured.start();
  track.values = fits.parameters;
  track.sigmas = sigma_per_unit * fits.unit_sigmas;
  track.statuses = fits.statuses;
  for (Eigen::Index frame = 0; frame < residuals_mm.rows(); ++frame) {
    double sum = 0;
    int count = 0;
    for (Eigen::Index marker = 0; marker < residuals_mm.cols(); ++marker)
      if (std::isfinite(residuals_mm(frame, marker))) {
        sum += residuals_mm(frame, marker);
        ++count;
      }
    track.residuals_mm.push_back(count == 0 ? kNaN : sum / count);
  }
  return track;
}

std::vector<bool> MouthOrChin(const FaceRig& rig, const std::vector<VirtualMarker>& markers) {
  std::vector<bool> is_mouth_or_chin;
  for (const VirtualMarker& marker : markers) {
    const auto region = RegionOfTriangle(rig, marker.triangle);
    const std::string name = region ? rig.definition().region_names[*region] : "";
    is_mouth_or_chin.push_back(name == "upper_lip" || name == "lower_lip" || name == "jaw");
  }
  return is_mouth_or_chin;
}

// The head was lost where nothing at all is left of a frame.
void MarkFramesWithoutHead(const HeadTracks& tracks, std::vector<FitStatus>* statuses) {
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    if (std::ranges::all_of(tracks.states(frame),
                            [](SampleState state) { return state == SampleState::kMissing; }))
      (*statuses)[frame] = FitStatus::kNoHeadPose;
}

}  // namespace

void VisitOptions(FitOptions& options, OptionVisitor& visit) {
  visit.Enumeration("metric", options.metric, {"distance", "squared", "huber"},
                    "what a marker's residual costs; distance is the paper's");
  visit("epsilon_mm", options.epsilon_mm, "smooths the distance at zero; mm of the rig");
  visit("huber_mm", options.huber_mm, "where the Huber metric turns linear; mm of the rig");
  visit.Enumeration("solver", options.solver, {"fast", "ceres"},
                    "fast, or Ceres, its reference, a hundred times slower");
  visit("bounded", options.bounded, "keep parameters within the rig's ranges");
  visit("marker_sigma_mm", options.marker_sigma_mm,
        "noise of a marker's coordinate that decides which parameters are determined; mm");
  visit("max_sigma_of_range", options.max_sigma_of_range,
        "parameters less certain than this part of their range are held at the reference");
  visit("smoothing_s", options.smoothing_s,
        "prior on smooth trajectories: accelerations of one range per this time squared are usual; "
        "0: none; s");
  visit("max_acceleration_m_s2", options.max_acceleration_m_s2,
        "samples that would need more are spikes and left out of the fit; 0: keep all; m/s^2");
  visit("refine_frames", options.refine_frames,
        "refine where the markers sit on the rig from this many frames; 0: not");
  visit("threads", options.threads, "threads; 0: one a processor; the result is the same");
}

Result<StageResult<ShapeFit>> Fit(const HeadTracks& tracks, const Binding& binding,
                                  const FaceRig& rig, const FitOptions& options,
                                  const BindingFrames& binding_frames,
                                  const std::function<void(double part)>& progress) {
  StageReport report{.stage = "fit", .options = EchoOptions(options)};
  if (const auto good = CheckOptions(options); !good) return tl::unexpected(good.error());
  const auto own_rig = RigOfBinding(binding, rig);
  if (!own_rig) return tl::unexpected(own_rig.error());
  const auto reference = ReferenceParameters(binding, rig);
  if (!reference) return tl::unexpected(reference.error());
  if (const auto fault = FaultOfVirtualMarkers(binding.virtual_markers, *own_rig))
    return Fail(
        fmt::format("the binding does not fit the rig '{}': {}; use the rig that it was made "
                    "with, or bind again",
                    rig.definition().name, *fault));
  FaceMarkers face = MatchMarkers(tracks, binding, &report);
  if (face.markers.empty())
    return Fail(
        "the take has none of the binding's face markers; check that it is of the same "
        "marker set");

  const double scale = binding.rig_from_head.scale;
  const RigTracks measured =
      WithoutSpikes(MeasuredInRig(tracks, face, binding.rig_from_head), options, scale, &report);
  CountFilled(measured, &report);
  std::vector<bool> judged(measured.num_frames());
  for (int frame = 0; frame < measured.num_frames(); ++frame)
    judged[frame] = !binding_frames.Contains(measured.first_frame() + frame);

  if (options.refine_frames > 0) {
    const std::vector<int> chosen = SpreadFrames(measured.num_frames(), options.refine_frames);
    for (const int frame : chosen) judged[frame] = false;
    const RigTracks frames = ChosenFrames(measured, chosen);
    face.markers = TakeFitter(*own_rig, *reference, frames, scale, options).Refine(face.markers);
    report.figures.emplace_back("refined_from_frames", static_cast<double>(chosen.size()));
  }
  TakeFitter::Pass pass =
      TakeFitter(*own_rig, *reference, measured, scale, options).Run(face.markers, true, progress);
  MarkFramesWithoutHead(tracks, &pass.fits.statuses);
  NoteUndetermined(*own_rig, pass.sigmas, pass.determined, options, &report);
  NoteSmoothing(options, pass.smoothing, &report);

  const int num_determined =
      static_cast<int>(std::count(pass.determined.begin(), pass.determined.end(), true));
  ShapeFit fit{.parameters = {},
               .measured = measured,
               .virtual_markers = VirtualMarkerTracks(measured, pass.fits),
               .residuals_mm = {}};
  fit.residuals_mm = Residuals(measured, fit.virtual_markers, scale);
  const double sigma_mm = EstimateSigma(fit, pass.fits, options, &report);
  const double inefficiency = options.metric == FitMetric::kDistance ? kDistanceInefficiency : 1;
  fit.parameters =
      TrackOf(*own_rig, measured, pass.fits, fit.residuals_mm, inefficiency * scale * sigma_mm);
  report.figures.emplace_back("evaluations_per_frame", static_cast<double>(pass.fits.evaluations) /
                                                           std::max(1, measured.num_frames()));
  const ExplainedVariance explained =
      ExplainVariance(fit, judged, MouthOrChin(*own_rig, face.markers));
  DescribeFit(fit, *own_rig, pass.determined, explained, &report);
  Judge(fit, explained, num_determined, &report);
  return StageResult<ShapeFit>{std::move(fit), std::move(report)};
}

}  // namespace articap
