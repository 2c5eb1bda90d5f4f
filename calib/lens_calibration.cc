// SPDX-License-Identifier: MIT
#include "calib/lens_calibration.h"

#include <fmt/format.h>

#include <utility>

#include "calib/calibration_report.h"
#include "calib/held_out.h"
#include "calib/lens_model.h"
#include "calib/lens_solver.h"

namespace articap {

void VisitOptions(LensOptions& options, OptionVisitor& visit) {
  visit.Enumeration("model", options.model,
                    {"pinhole", "k1", "k1k2", "brown4", "brown5", "rational"},
                    "the richest lens model to try: radial k1, k2, tangential p1, p2 (brown4), k3 "
                    "(brown5), k4 to k6 (rational)");
  visit("simplify", options.simplify,
        "leave out coefficients that the views do not support; false: keep the model as asked for");
  visit("fixed_aspect", options.fixed_aspect, "fx = fy: square pixels");
  visit("fixed_principal_point", options.fixed_principal_point,
        "the lens' axis meets the middle of the picture");
  visit("huber_sigmas", options.huber_sigmas,
        "corners off by more standard deviations count less; 0: plain least squares");
  visit("set_views_aside", options.set_views_aside,
        "leave out views that do not fit the others; false: keep views that do not fit the others");
  visit("max_rms_px", options.max_rms_px, "not usable with larger residuals; px");
  visit("max_focal_sigma_percent", options.max_focal_sigma_percent,
        "not usable where the focal length is known worse; percent");
}

Result<StageResult<Calibration>> CalibrateLens(const BoardSpec& board,
                                               const CameraSightings& camera,
                                               const LensOptions& options) {
  constexpr std::size_t kFewest = 3;
  if (camera.sightings.size() < kFewest)
    return Fail(fmt::format(
        "{}: {} usable picture{} of the board; a lens needs {} at the very least, "
        "better 15, with "
        "the board tilted to all sides and in all parts of the picture",
        camera.camera, camera.sightings.size(), camera.sightings.size() == 1 ? "" : "s", kFewest));
  Result<SolvedLens> solved = SolveLens(board, camera, options);
  if (!solved) return tl::unexpected(solved.error());
  Calibration calibration = MakeCalibration({camera}, solved->adjusted, solved->set_aside);
  calibration.held_out.rms_px =
      HeldOutRms_px(solved->adjusted.network, FreedomOf(solved->model, options));
  StageReport report = DescribeCalibration("calibrate lens", calibration,
                                           {options.max_rms_px, options.max_focal_sigma_percent});
  report.warnings.insert(report.warnings.begin(), solved->warnings.begin(), solved->warnings.end());
  report.options = EchoOptions(options);
  return StageResult<Calibration>{std::move(calibration), std::move(report)};
}

}  // namespace articap
