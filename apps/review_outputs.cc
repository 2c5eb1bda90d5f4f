// SPDX-License-Identifier: MIT
#include "apps/review_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/output_names.h"
#include "apps/progress.h"
#include "render/picture.h"
#include "report/tracking_page.h"
#include "tracking/review_json.h"

namespace articap {
namespace {

void AddReports(const std::string& output, const std::string& json,
                const std::vector<std::string>& pngs, OutputSet& outputs) {
  const std::string title = std::filesystem::path(output).stem().string();
  outputs.Add(Beside(output, ".report.json"), json);
  outputs.Add(Beside(output, ".report.html"), TrackingPage(title, json, pngs));
}

void AddOverlays(const std::string& output, const PicturedTake& take, const ShowOptions& show,
                 OutputSet& outputs) {
  for (int camera = 0; camera < static_cast<int>(take.array.cameras.size()); ++camera) {
    const std::string& name = take.array.cameras[camera].name;
    const double crf = show.overlay_crf;
    outputs.AddWriter(Beside(output, fmt::format(".{}.overlay.mp4", name)),
                      [&take, camera, crf](const std::filesystem::path& path) {
                        return WithProgress("drawing what was found",
                                            [&] { return WriteOverlay(take, camera, crf, path); });
                      });
  }
}

}  // namespace

void AddReview(const std::string& output, const TakeReview& review,
               const std::vector<Doubt>& doubts, const std::vector<StageReport>& reports,
               OutputSet& outputs) {
  AddReports(output, ReviewJson(review, doubts, reports), {}, outputs);
}

Result<void> AddReview(const std::string& output, const TakeReview& review,
                       const std::vector<Doubt>& doubts, const std::vector<StageReport>& reports,
                       const PicturedTake& take, const ShowOptions& show, OutputSet& outputs) {
  const auto spread = SpreadFirst(doubts, std::max(1, show.doubtful), review.num_frames);
  const std::vector<Doubt> shown(
      spread.begin(), spread.begin() + std::min(show.doubtful, static_cast<int>(spread.size())));
  std::vector<std::string> pngs;
  if (!shown.empty()) {
    const auto pictures =
        WithProgress("drawing doubtful frames", [&] { return DoubtPictures(take, shown); });
    if (!pictures) return tl::unexpected(pictures.error());
    for (const Picture& picture : *pictures) {
      const auto png = EncodePng(picture);
      if (!png) return tl::unexpected(png.error());
      pngs.push_back(*png);
    }
    const auto sheet = EncodePng(DoubtSheet(take, shown, *pictures));
    if (!sheet) return tl::unexpected(sheet.error());
    outputs.Add(Beside(output, ".contact.png"), *sheet);
  }
  AddReports(output, ReviewJson(review, spread, reports), pngs, outputs);
  if (show.overlay) AddOverlays(output, take, show, outputs);
  return {};
}

}  // namespace articap
