// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace articap {

// The pages without their data, made of report/page/ when articap is built: HTML with its style and
// its script, holding the marks {{articap:title}} and {{articap:data}}.
std::string_view PageTemplate();             // of a fit
std::string_view CalibrationPageTemplate();  // of a calibration
std::string_view TrackingPageTemplate();     // of labelled markers

}  // namespace articap
