// SPDX-License-Identifier: MIT
#include "report/tracking_page.h"

#include "core/check.h"
#include "report/page_template.h"
#include "report/page_text.h"

namespace articap {

std::string TrackingPage(std::string_view title, const std::string& review_json,
                         const std::vector<std::string>& pictures) {
  constexpr bool kThrow = false;
  Json data = Json::parse(review_json, nullptr, kThrow);
  ARTICAP_CHECK(data.is_object() && data.contains("review"));
  ARTICAP_CHECK_LE(pictures.size(), data["review"]["doubts"].size());
  data["title"] = title;
  data["pictures"] = Json::array();
  for (const std::string& picture : pictures)
    data["pictures"].push_back("data:image/png;base64," + Base64(picture));
  return FillPage(TrackingPageTemplate(), title, data);
}

}  // namespace articap
