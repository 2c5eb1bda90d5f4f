// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace articap {

// What is known of a labelled take (tracking/review_json.h) with everything that can go wrong: a
// gap, samples filled and seen by one view, exchanged names, a residual, a marker's name with
// "<b>".
std::string SampleTrackingJson();
// The same markers as a file without cameras would have given them, none of them doubtful.
std::string SampleLabelledFileJson();

}  // namespace articap
