// SPDX-License-Identifier: MIT
#include "report/report_page.h"

#include <algorithm>
#include <string_view>

#include "core/check.h"
#include "core/parameter_units.h"
#include "core/version.h"
#include "report/page_data.h"
#include "report/page_template.h"

namespace articap {
namespace {

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

// JSON inside a script element: no "<" may end it. What is not UTF-8 is replaced.
std::string ScriptJson(const Json& data) {
  const std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  return safe;
}

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

  const std::string_view page = PageTemplate();
  constexpr std::string_view kTitle = "{{articap:title}}";
  constexpr std::string_view kData = "{{articap:data}}";
  const std::size_t title_at = page.find(kTitle);
  const std::size_t data_at = page.find(kData);
  ARTICAP_CHECK(title_at < data_at && data_at != std::string_view::npos);
  std::string html(page.substr(0, title_at));
  html += EscapeHtml(input.title);
  html += page.substr(title_at + kTitle.size(), data_at - title_at - kTitle.size());
  html += ScriptJson(data);
  html += page.substr(data_at + kData.size());
  return html;
}

}  // namespace articap
