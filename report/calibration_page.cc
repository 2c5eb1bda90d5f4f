// SPDX-License-Identifier: MIT
#include "report/calibration_page.h"

#include "core/check.h"
#include "report/page_template.h"
#include "report/page_text.h"

namespace articap {

std::string CalibrationPage(const std::string& calibration_json) {
  constexpr bool kThrow = false;
  const Json data = Json::parse(calibration_json, nullptr, kThrow);
  ARTICAP_CHECK(data.is_object() && data.contains("calibration"));
  return FillPage(CalibrationPageTemplate(), data.value("stage", ""), data);
}

}  // namespace articap
