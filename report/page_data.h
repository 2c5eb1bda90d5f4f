// SPDX-License-Identifier: MIT
#pragma once

#include "report/packed.h"
#include "report/report_page.h"

namespace articap {

// The parts of the page's data; report/page/src/data.js reads them.
Json StagesData(const std::vector<StageReport>& reports);
Json TakeData(const ReportPageInput& input);
Json ParameterData(const ReportPageInput& input);
Json PhoneData(const ParameterTrack& track);
Json StatusData(const ParameterTrack& track);
Json ResidualData(const MarkerResiduals& residuals);
Json HeadPoseData(const HeadPoseTrack& head_pose, const ParameterTrack& track);
Json SceneData(const ReportPageInput& input, const FrameWindow& window);

// How many frames one point of a plot stands for, so that `num_series` series of a take stay within
// their share of the page.
int FramesPerPoint(int num_frames, int num_series);

FrameWindow DefaultWindow(const ParameterTrack& track);

}  // namespace articap
