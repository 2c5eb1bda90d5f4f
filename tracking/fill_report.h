// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/report.h"
#include "core/tracks.h"
#include "tracking/fill_gaps.h"
#include "tracking/gap_windows.h"

namespace articap {

struct FilledGap {
  Gap gap;
  bool is_regression = false;  // or interpolation alone
  Eigen::VectorXd sigmas_mm;   // a frame of the gap, of each coordinate
};

// A row a marker that has gaps: how many, the longest, what they were filled with, what is left,
// and the estimated error. `gaps`: all of the take.
StageReport ReportFills(const StageTracks& tracks, const std::vector<Gap>& gaps,
                        const std::vector<FilledGap>& filled, const FillOptions& options);

}  // namespace articap
