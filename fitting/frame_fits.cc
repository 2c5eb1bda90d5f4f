// SPDX-License-Identifier: MIT
#include "fitting/frame_fits.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>

#include "core/parallel.h"
#include "fitting/ceres_shape_solver.h"

namespace articap {
namespace {

// Frames that one thread fits in a row. The first starts at the reference pose: a dozen evaluations
// more in five hundred frames.
constexpr int kRunLength = 512;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Fits one run of frames and keeps what they share: the solver, and which parameters the last set
// of markers seen determined.
class RunFitter {
 public:
  RunFitter(const RigTracks& measured, const FrameFitSetup& setup)
      : measured_(measured),
        setup_(setup),
        seen_(std::make_unique<bool[]>(measured.num_markers())),
        solver_(setup.evaluator, setup.lower, setup.upper, {.loss = setup.loss}) {}

  void FitFrame(int frame, FrameFits* fits, std::int64_t* evaluations) {
    LookAt(frame);
    const bool any_free = std::find(free_.begin(), free_.end(), true) != free_.end();
    if (num_seen_ == 0 || !any_free) {
      fits->statuses[frame] = FitStatus::kTooFewMarkers;
      return;
    }
    Eigen::VectorXd lower = setup_.lower, upper = setup_.upper;
    for (Eigen::Index k = 0; k < lower.size(); ++k)
      if (!free_[k]) lower[k] = upper[k] = setup_.reference[k];
    if (start_.size() == 0) start_ = setup_.reference;
    const ShapeSolution solution = Solve(frame, lower, upper);
    *evaluations += solution.evaluations;
    fits->parameters.row(frame) = start_;
    fits->statuses[frame] = !solution.converged          ? FitStatus::kNotConverged
                            : free_ != setup_.determined ? FitStatus::kWeak
                                                         : FitStatus::kOk;
  }

  void EvaluateFrame(int frame, FrameFits* fits) {
    if (fits->statuses[frame] == FitStatus::kTooFewMarkers) return;
    LookAt(frame);
    const Eigen::VectorXd parameters = fits->parameters.row(frame);
    const auto size = static_cast<std::size_t>(parameters.size());
    const auto pose = setup_.evaluator.PoseOf({parameters.data(), size});
    information_.setZero(parameters.size(), parameters.size());
    jacobian_.resize(3, parameters.size());
    for (int i = 0; i < measured_.num_markers(); ++i) {
      fits->positions_mm.row(frame).segment<3>(3 * i) =
          setup_.evaluator.PositionAndJacobian(pose, i, jacobian_.data());
      if (!seen_[i]) continue;
      const auto active = setup_.evaluator.active_parameters(i);
      for (std::size_t a = 0; a < active.size(); ++a)
        for (std::size_t b = 0; b < active.size(); ++b)
          information_(active[a], active[b]) +=
              jacobian_.col(static_cast<int>(a)).dot(jacobian_.col(static_cast<int>(b)));
    }
    fits->unit_sigmas.row(frame) = UnitSigmas(information_, free_);
  }

 private:
  // Sets seen_, num_seen_ and free_ for a frame; the latter anew only when other markers are seen.
  void LookAt(int frame) {
    bool same = num_seen_ >= 0;
    int num_seen = 0;
    for (int i = 0; i < measured_.num_markers(); ++i) {
      const bool seen = !measured_.is_missing(frame, i);
      same &= seen == seen_[i];
      seen_[i] = seen;
      num_seen += seen;
    }
    if (same) return;
    num_seen_ = num_seen;
    free_ = num_seen == measured_.num_markers()
                ? setup_.determined
                : setup_.determination.Determined(
                      {seen_.get(), static_cast<std::size_t>(measured_.num_markers())});
    for (std::size_t k = 0; k < free_.size(); ++k) free_[k] = free_[k] && setup_.determined[k];
  }

  ShapeSolution Solve(int frame, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
    if (setup_.solver == FitSolver::kCeres)
      return SolveShapeWithCeres(setup_.evaluator, lower, upper, setup_.loss,
                                 measured_.positions_mm(frame), &start_);
    solver_.SetBounds(lower, upper);
    return solver_.Solve(measured_.positions_mm(frame), &start_);
  }

  const RigTracks& measured_;
  const FrameFitSetup& setup_;
  std::unique_ptr<bool[]> seen_;
  int num_seen_ = -1;
  std::vector<bool> free_;
  Eigen::VectorXd start_;
  ShapeSolver solver_;
  Eigen::MatrixXd information_;
  VirtualMarkerEvaluator::Jacobian jacobian_;
};

template <class Work>
void ForRuns(const RigTracks& measured, const FrameFitSetup& setup, Work work) {
  const int num_runs = (measured.num_frames() + kRunLength - 1) / kRunLength;
  ParallelFor(num_runs, setup.threads, [&](int run) {
    RunFitter fitter(measured, setup);
    work(fitter, run * kRunLength, std::min(measured.num_frames(), (run + 1) * kRunLength));
  });
}

}  // namespace

FrameFits FitFrames(const RigTracks& measured, const FrameFitSetup& setup,
                    const std::function<void(double part)>& progress) {
  const int num_frames = measured.num_frames();
  const int num_parameters = setup.evaluator.num_parameters();
  FrameFits fits;
  fits.parameters = Eigen::MatrixXd::Constant(num_frames, num_parameters, kNaN);
  fits.unit_sigmas = Eigen::MatrixXd::Constant(num_frames, num_parameters,
                                               std::numeric_limits<double>::infinity());
  fits.positions_mm = Eigen::MatrixXd::Constant(num_frames, 3 * measured.num_markers(), kNaN);
  fits.statuses.assign(num_frames, FitStatus::kOk);

  std::atomic<std::int64_t> evaluations = 0;
  std::atomic<int> done = 0;
  ForRuns(measured, setup, [&](RunFitter& fitter, int first, int end) {
    std::int64_t run_evaluations = 0;
    for (int frame = first; frame < end; ++frame) fitter.FitFrame(frame, &fits, &run_evaluations);
    evaluations += run_evaluations;
    done += end - first;
    if (progress) progress(static_cast<double>(done) / num_frames);
  });
  fits.evaluations = evaluations;
  EvaluateFits(measured, setup, &fits);
  return fits;
}

void EvaluateFits(const RigTracks& measured, const FrameFitSetup& setup, FrameFits* fits) {
  ForRuns(measured, setup, [&](RunFitter& fitter, int first, int end) {
    for (int frame = first; frame < end; ++frame) fitter.EvaluateFrame(frame, fits);
  });
}

}  // namespace articap
