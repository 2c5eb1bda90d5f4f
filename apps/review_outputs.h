// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/output_set.h"
#include "apps/track_pictures.h"
#include "core/report.h"
#include "core/result.h"
#include "tracking/doubt.h"
#include "tracking/take_review.h"

namespace articap {

// What a person checks of labelled markers, beside them: OUT's stem + .report.json and
// .report.html.
void AddReview(const std::string& output, const TakeReview& review,
               const std::vector<Doubt>& doubts, const std::vector<StageReport>& reports,
               OutputSet& outputs);

// The same where videos were tracked: the report shows the first doubts, which are spread over the
// take; with + .contact.png, and + .CAMERA.overlay.mp4 where asked for. The take must live until
// the outputs are committed.
Result<void> AddReview(const std::string& output, const TakeReview& review,
                       const std::vector<Doubt>& doubts, const std::vector<StageReport>& reports,
                       const PicturedTake& take, const ShowOptions& show, OutputSet& outputs);

}  // namespace articap
