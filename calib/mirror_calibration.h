// SPDX-License-Identifier: MIT
#pragma once

#include "calib/calibration.h"
#include "calib/lens_calibration.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

struct MirrorOptions {
  int mirrors = 1;  // how many plane mirrors the camera sees
  // Of a second-surface mirror: the glass before its reflecting plane; 0 for a front-surface
  // mirror.
  double glass_mm = 0;
  double glass_index = 1.52;  // crown and float glass
  bool adjust_lens = true;    // a lens that was calibrated before is adjusted too; false: held
  double huber_sigmas = 3;
  bool set_views_aside = true;
  double max_rms_px = 1;
  double max_rigidity_mm = 1;
  double max_held_focal_percent = 2;
  double max_misfit = 3;
};
void VisitOptions(MirrorOptions& options, OptionVisitor& visit);

// One camera whose picture shows the board directly and in one or more plane mirrors: its lens and
// the mirrors' planes, three parameters each, jointly. Sightings of one picture have the same
// `frame`; those in a mirror are marked so. The stage frame is the camera's. Refused: pictures that
// never show the board both ways, mirrors that contradict one another.
Result<StageResult<Calibration>> CalibrateMirror(const BoardSpec& board,
                                                 const CameraSightings& camera,
                                                 const LensOptions& lens_options,
                                                 const MirrorOptions& options);

}  // namespace articap
