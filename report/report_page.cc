// SPDX-License-Identifier: MIT
#include "report/report_page.h"

#include <algorithm>

#include "core/check.h"
#include "core/parameter_units.h"
#include "core/version.h"
#include "report/page_data.h"
#include "report/page_template.h"
#include "report/page_text.h"

namespace articap {
namespace {

FrameWindow Clamped(FrameWindow window, int num_frames) {
  window.first = std::clamp(window.first, 0, std::max(0, num_frames - 1));
  window.count = std::clamp(window.count, 0, num_frames - window.first);
  return window;
}

}  // namespace

std::string BuildReportPage(const ReportPageInput& input) {
  ARTICAP_CHECK(input.parameters != nullptr);
  const ParameterTrack& track = *input.parameters;
  CheckSizes(track);
  Json data = {{"articap_version", kVersion},
               {"take", TakeData(input)},
               {"stages", StagesData(input.reports)},
               {"tracks", ParameterData(input)},
               {"statuses", StatusData(track)}};
  data["phones"] = track.phones.empty() ? Json(nullptr) : PhoneData(track);
  data["residuals"] = input.residuals ? ResidualData(*input.residuals) : Json(nullptr);
  data["head_pose"] = input.head_pose ? HeadPoseData(*input.head_pose, track) : Json(nullptr);
  const bool has_scene = input.rig || input.measured || input.virtual_markers;
  const FrameWindow window =
      Clamped(input.window.value_or(DefaultWindow(track)), track.num_frames());
  data["scene"] = has_scene && window.count > 0 ? SceneData(input, window) : Json(nullptr);

  return FillPage(PageTemplate(), input.title, data);
}

}  // namespace articap
