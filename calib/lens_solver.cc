// SPDX-License-Identifier: MIT
#include "calib/lens_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "calib/held_out.h"
#include "calib/lens_model.h"
#include "calib/network_screening.h"
#include "calib/planar_pose.h"
#include "calib/view_screening.h"

namespace articap {
namespace {

std::vector<int> AllSightings(const CameraSightings& camera) {
  std::vector<int> all(camera.sightings.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// The camera before anything is known but its focal length.
Camera StartCamera(const CameraSightings& camera, double focal_px) {
  return CameraWith(camera, CentredLens(focal_px, camera.width, camera.height));
}

// A placement for every sighting whose pose can be found.
Network PlaceSightings(const BoardSpec& board, const CameraSightings& input, const Camera& camera,
                       const std::vector<int>& which) {
  Network network;
  network.board = board;
  network.array.cameras = {camera};
  for (int index : which) {
    const BoardSighting& sighting = input.sightings[index];
    const std::vector<PlanarPose> poses =
        PlanarPosesOf(board, camera.lens, sighting.corners, sighting.points_px);
    if (poses.empty()) continue;
    network.sightings.push_back({{0, -1},
                                 static_cast<int>(network.placements.size()),
                                 0,
                                 index,
                                 sighting.corners,
                                 sighting.points_px});
    network.placements.push_back({poses.front().cam_from_board, 0});
  }
  return network;
}

AdjustOptions OptionsFor(const LensFreedom& freedom, double huber_px, int max_iterations = 100) {
  AdjustOptions options;
  options.lenses = {freedom};
  options.huber_px = huber_px;
  options.max_iterations = max_iterations;
  return options;
}

tl::unexpected<Error> NoPlane(const CameraSightings& input) {
  return Fail(
      fmt::format("{}: in none of the {} pictures do the corners make a plane; are the board's "
                  "numbers right{}?",
                  input.camera, input.sightings.size(),
                  input.lens ? ", and is the lens that of this camera" : ""));
}

// A pinhole with a little radial distortion, from nothing: from the homographies' focal length, or,
// where they are of no help, from the best of several guesses.
Result<AdjustedNetwork> StartFromNothing(const BoardSpec& board, const CameraSightings& input) {
  std::vector<PlaneView> views;
  for (const BoardSighting& sighting : input.sightings)
    views.push_back({&sighting.corners, &sighting.points_px});
  const Camera centred = StartCamera(input, 1);
  const auto focal_px = FocalLengthOf_px(board, views, {centred.lens.cx_px, centred.lens.cy_px});
  std::vector<double> guesses_px;
  if (focal_px) guesses_px = {*focal_px};
  const double size_px = std::max(input.width, input.height);
  if (!focal_px || *focal_px < 0.2 * size_px || *focal_px > 20 * size_px)
    for (double factor : {0.6, 1.0, 1.7, 3.0}) guesses_px.push_back(factor * size_px);

  LensFreedom freedom;
  freedom.focal = true;
  freedom.distortion[Lens::kK1] = true;
  std::optional<AdjustedNetwork> best;
  for (double guess_px : guesses_px) {
    const Network network =
        PlaceSightings(board, input, StartCamera(input, guess_px), AllSightings(input));
    if (network.sightings.empty()) continue;
    AdjustedNetwork adjusted = Adjust(network, OptionsFor(freedom, 1, 15));
    if (!best || MedianOf(adjusted.residuals_px) < MedianOf(best->residuals_px))
      best = std::move(adjusted);
  }
  if (!best) return NoPlane(input);
  return *std::move(best);
}

void Simplify(SolvedLens& solved, const LensOptions& options) {
  std::vector<LensModel> models = {solved.model};
  const double huber_px = HuberFor_px(solved.adjusted, {}, options.huber_sigmas);
  AdjustOptions adjust = OptionsFor(FreedomOf(solved.model, options), huber_px);
  solved.adjusted = SimplifyLenses(std::move(solved.adjusted), options, adjust, models);
  solved.model = models[0];
}

// The full model on the sightings that are kept, and which of them do not fit.
Result<AdjustedNetwork> SolveFullModel(const BoardSpec& board, const CameraSightings& input,
                                       const Camera& start, const std::vector<int>& kept,
                                       const LensOptions& options) {
  const LensModel model = std::min(options.model, LensModel::kBrown5);
  const LensFreedom freedom = FreedomOf(model, options);
  // Coefficients that are not of the model are none, whatever the start has of them.
  Camera from = start;
  for (int i = 0; i < Lens::kNumDistortion; ++i)
    if (!freedom.distortion[i]) from.lens.distortion[i] = 0;
  const Network network = PlaceSightings(board, input, from, kept);
  if (network.sightings.empty()) return NoPlane(input);
  const double first_huber_px = options.huber_sigmas == 0 ? 0 : 1;
  AdjustedNetwork adjusted = Adjust(network, OptionsFor(freedom, first_huber_px));
  // Now that the lens is known, a board may turn out to stand in its other pose.
  const Network again = PlaceSightings(board, input, adjusted.network.array.cameras[0], kept);
  if (again.sightings.empty()) return NoPlane(input);
  return Adjust(again, OptionsFor(freedom, HuberFor_px(adjusted, {}, options.huber_sigmas)));
}

Result<Camera> StartOf(const BoardSpec& board, const CameraSightings& camera) {
  if (camera.sightings.empty())
    return Fail(fmt::format("{}: in no picture is there a board to calibrate from", camera.camera));
  if (camera.lens) return CameraWith(camera, *camera.lens);
  const Result<AdjustedNetwork> from_nothing = StartFromNothing(board, camera);
  if (!from_nothing) return tl::unexpected(from_nothing.error());
  return from_nothing->network.array.cameras[0];
}

// The full model before it is simplified: sets aside what does not fit the rest, until everything
// does.
Result<SolvedLens> SolveAndScreen(const BoardSpec& board, const CameraSightings& camera,
                                  const Camera& start, const LensOptions& options) {
  constexpr int kMostRounds = 3;
  SolvedLens solved;
  solved.model = std::min(options.model, LensModel::kBrown5);
  Camera from = start;
  for (int round = 0;; ++round) {
    std::vector<int> kept;
    for (int index : AllSightings(camera))
      if (!solved.set_aside.contains({0, index})) kept.push_back(index);
    Result<AdjustedNetwork> adjusted = SolveFullModel(board, camera, from, kept, options);
    if (!adjusted) return tl::unexpected(adjusted.error());
    solved.adjusted = *std::move(adjusted);
    if (!options.set_views_aside || round == kMostRounds) break;
    const std::vector<BadSighting> bad = ScreenSightings(solved.adjusted);
    if (bad.empty()) break;
    const Network& network = solved.adjusted.network;
    for (const BadSighting& sighting : bad)
      solved.set_aside[{0, network.sightings[sighting.sighting].input}] = sighting.reason;
    from = network.array.cameras[0];
  }
  SetAsideUnplaced({&camera, 1}, solved.adjusted.network, solved.set_aside);
  return solved;
}

// Whether the lens still maps the whole picture one to one.
bool ShowsWholePicture(const Camera& camera) {
  for (double x : {0.0, 0.5, 1.0})
    for (double y : {0.0, 0.5, 1.0})
      if (!Unproject(camera.lens, {x * (camera.width - 1), y * (camera.height - 1)})) return false;
  return true;
}

// Whether the leading coefficient of the rational model's denominator stands out from its own
// noise.
bool IsDenominatorKnown(const Camera& camera) {
  constexpr double kSigmas = 3;
  return std::abs(camera.lens.distortion[Lens::kK4]) >
         kSigmas * camera.sigmas.distortion[Lens::kK4];
}

// The rational model needs views that reach into the corners of a wide lens; where they do not, its
// numerator and denominator cancel and wander off together.
void TryRational(SolvedLens& solved, const LensOptions& options) {
  const double huber_px = HuberFor_px(solved.adjusted, {}, options.huber_sigmas);
  AdjustedNetwork rational = Adjust(solved.adjusted.network,
                                    OptionsFor(FreedomOf(LensModel::kRational, options), huber_px));
  const double before_px = HeldOutRms_px(solved.adjusted.network, FreedomOf(solved.model, options));
  const double after_px = HeldOutRms_px(rational.network, FreedomOf(LensModel::kRational, options));
  std::string against;
  if (!rational.converged || !std::isfinite(rational.sigma_px))
    against = "it does not converge";
  else if (!IsSupported(rational, 0, LensModel::kRational) ||
           !IsDenominatorKnown(rational.network.array.cameras[0]))
    against = fmt::format(
        "k4 would be {:.2f} +- {:.2f}, as its numerator and denominator make up for one another",
        rational.network.array.cameras[0].lens.distortion[Lens::kK4],
        rational.network.array.cameras[0].sigmas.distortion[Lens::kK4]);
  else if (!ShowsWholePicture(rational.network.array.cameras[0]))
    against = "it folds the picture over within its edges";
  else if (!(after_px < 0.99 * before_px))
    against = fmt::format("on held-out views its residuals are {:.3f} px, without it {:.3f}",
                          after_px, before_px);
  if (!against.empty()) {
    solved.warnings.push_back(
        fmt::format("the rational model is refused: {}; take more pictures with the board in the "
                    "corners of the picture, or do without it",
                    against));
    return;
  }
  solved.model = LensModel::kRational;
  solved.adjusted = std::move(rational);
}

}  // namespace

Result<SolvedLens> SolveLens(const BoardSpec& board, const CameraSightings& camera,
                             const LensOptions& options) {
  const Result<Camera> start = StartOf(board, camera);
  if (!start) return tl::unexpected(start.error());
  Result<SolvedLens> screened = SolveAndScreen(board, camera, *start, options);
  if (!screened) return screened;
  SolvedLens& solved = *screened;
  if (3 * solved.set_aside.size() > camera.sightings.size()) {
    const auto& [first, reason] = *solved.set_aside.begin();
    return Fail(fmt::format(
        "{}: {} of {} pictures do not fit the others, {} among them ({}); record the board anew",
        camera.camera, solved.set_aside.size(), camera.sightings.size(),
        camera.sightings[first.sighting].source, reason));
  }
  if (options.simplify) Simplify(solved, options);
  if (options.model == LensModel::kRational) TryRational(solved, options);
  return screened;
}

Result<StartingLens> StartLens(const BoardSpec& board, const CameraSightings& camera,
                               const LensOptions& options, bool hold_known_lens) {
  StartingLens start;
  if (camera.lens && hold_known_lens) {
    start.camera = CameraWith(camera, *camera.lens);
    return start;
  }
  LensOptions full = options;
  full.simplify = false;
  Result<SolvedLens> solved = SolveLens(board, camera, full);
  if (!solved) return tl::unexpected(solved.error());
  start.camera = solved->adjusted.network.array.cameras[0];
  start.model = solved->model;
  start.freedom = FreedomOf(solved->model, options);
  start.set_aside = std::move(solved->set_aside);
  start.warnings = std::move(solved->warnings);
  return start;
}

}  // namespace articap
