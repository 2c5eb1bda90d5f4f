// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/output_set.h"
#include "core/report.h"
#include "tracking/doubt.h"
#include "tracking/take_review.h"

namespace articap {

// What a person checks of labelled markers, beside them: OUT's stem + .report.json and
// .report.html. `pictures`: PNG files of the first doubts.
void AddReview(const std::string& output, const TakeReview& review,
               const std::vector<Doubt>& doubts, const std::vector<StageReport>& reports,
               const std::vector<std::string>& pictures, OutputSet& outputs);

}  // namespace articap
