// SPDX-License-Identifier: MIT
#include "fitting/take_fitter.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

#include "fitting/determination.h"
#include "fitting/refinement.h"

namespace articap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How far refinement may move a marker on the rig, mm of the rig: one face's error of attachment to
// another.
constexpr double kRefinementReach_mm = 20;
constexpr int kRefinementRounds = 8;

// Prior weights on second differences; see FitOptions::smoothing_s.
Eigen::VectorXd SmoothingWeights(const FitOptions& options, const Eigen::VectorXd& ranges,
                                 double rate_hz, double sigma_rig_mm) {
  // An acceleration of one range per smoothing_s^2, as a second difference of frames.
  const double frames = options.smoothing_s * rate_hz;
  const Eigen::VectorXd typical = ranges / (frames * frames);
  const double cost =
      options.metric == FitMetric::kDistance ? 0.5 * sigma_rig_mm : sigma_rig_mm * sigma_rig_mm;
  return cost * typical.array().square().inverse();
}

}  // namespace

TakeFitter::TakeFitter(const FaceRig& rig, const Eigen::VectorXd& reference,
                       const RigTracks& measured, double rig_scale, const FitOptions& options)
    : rig_(rig),
      reference_(reference),
      measured_(measured),
      options_(options),
      marker_sigma_mm_(rig_scale * options.marker_sigma_mm),
      ranges_(rig.num_parameters()),
      lower_(rig.num_parameters()),
      upper_(rig.num_parameters()) {
  for (int k = 0; k < rig.num_parameters(); ++k) {
    const RigParameter& parameter = rig.definition().parameters[k];
    ranges_[k] = parameter.max - parameter.min;
    lower_[k] = options.bounded ? parameter.min : -kInfinity;
    upper_[k] = options.bounded ? parameter.max : kInfinity;
  }
}

TakeFitter::Pass TakeFitter::Run(const std::vector<VirtualMarker>& markers, bool smooth,
                                 const std::function<void(double part)>& progress) const {
  const VirtualMarkerEvaluator evaluator(rig_, markers);
  const Determination determination(evaluator, reference_, ranges_, marker_sigma_mm_,
                                    options_.max_sigma_of_range);
  const auto all_seen = std::make_unique<bool[]>(markers.size());
  std::fill_n(all_seen.get(), markers.size(), true);
  Pass pass;
  pass.determined = determination.Determined({all_seen.get(), markers.size()});
  pass.sigmas = determination.Sigmas();
  const MarkerLoss loss{options_.metric, options_.epsilon_mm, options_.huber_mm};
  const FrameFitSetup setup{evaluator, determination,   reference_,
                            lower_,    upper_,          pass.determined,
                            loss,      options_.solver, options_.threads};
  pass.fits = FitFrames(measured_, setup, progress);
  if (smooth && options_.smoothing_s > 0) {
    pass.smoothing = SmoothFits(
        measured_, setup,
        SmoothingWeights(options_, ranges_, measured_.rate_hz(), marker_sigma_mm_), &pass.fits);
    EvaluateFits(measured_, setup, &pass.fits);
  }
  return pass;
}

std::vector<VirtualMarker> TakeFitter::Refine(const std::vector<VirtualMarker>& bound) const {
  std::vector<int> frames(measured_.num_frames());
  std::iota(frames.begin(), frames.end(), 0);
  std::vector<VirtualMarker> markers = bound;
  for (int round = 0; round < kRefinementRounds; ++round) {
    const Pass pass = Run(markers, false, nullptr);
    markers = RefineAttachments(rig_, bound, markers, measured_, frames, pass.fits.parameters,
                                kRefinementReach_mm);
  }
  return markers;
}

}  // namespace articap
