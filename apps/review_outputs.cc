// SPDX-License-Identifier: MIT
#include "apps/review_outputs.h"

#include <filesystem>

#include "apps/output_names.h"
#include "report/tracking_page.h"
#include "tracking/review_json.h"

namespace articap {

void AddReview(const std::string& output, const TakeReview& review,
               const std::vector<Doubt>& doubts, const std::vector<StageReport>& reports,
               const std::vector<std::string>& pictures, OutputSet& outputs) {
  const std::string json = ReviewJson(review, doubts, reports);
  const std::string title = std::filesystem::path(output).stem().string();
  outputs.Add(Beside(output, ".report.json"), json);
  outputs.Add(Beside(output, ".report.html"), TrackingPage(title, json, pictures));
}

}  // namespace articap
