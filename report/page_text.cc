// SPDX-License-Identifier: MIT
#include "report/page_text.h"

#include "core/check.h"

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

}  // namespace

std::string FillPage(std::string_view page_template, std::string_view title, const Json& data) {
  constexpr std::string_view kTitle = "{{articap:title}}";
  constexpr std::string_view kData = "{{articap:data}}";
  const std::size_t title_at = page_template.find(kTitle);
  const std::size_t data_at = page_template.find(kData);
  ARTICAP_CHECK(title_at < data_at && data_at != std::string_view::npos);
  std::string html(page_template.substr(0, title_at));
  html += EscapeHtml(title);
  html += page_template.substr(title_at + kTitle.size(), data_at - title_at - kTitle.size());
  html += ScriptJson(data);
  html += page_template.substr(data_at + kData.size());
  return html;
}

}  // namespace articap
