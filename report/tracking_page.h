// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace articap {

// What ReviewJson() (tracking/review_json.h) says of labelled markers, as one HTML page that needs
// no network: the verdict in words, who was seen when, residuals, margins, the sub-pixel histogram
// and the doubtful frames. `pictures`: PNG files of the doubts, in their order, as many as there
// are; `title` names the take. The same gives the same bytes.
std::string TrackingPage(std::string_view title, const std::string& review_json,
                         const std::vector<std::string>& pictures);

}  // namespace articap
