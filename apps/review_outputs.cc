// SPDX-License-Identifier: MIT
#include "apps/review_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/output_names.h"
#include "apps/progress.h"
#include "core/parallel.h"
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

struct DoubtPngs {
  std::vector<std::string> pictures;  // one a doubt
  std::string sheet;                  // of all
};

Result<DoubtPngs> EncodeDoubts(const PicturedTake& take, const std::vector<Doubt>& doubts,
                               const std::vector<Picture>& pictures) {
  const int count = static_cast<int>(pictures.size());
  std::vector<Result<std::string>> pngs(pictures.size() + 1);
  // The sheet is the longest, and comes first.
  ParallelFor(count + 1, 0, [&](int item) {
    const int png = count - item;
    pngs[png] = EncodePng(png == count ? DoubtSheet(take, doubts, pictures) : pictures[png]);
  });
  DoubtPngs result;
  for (Result<std::string>& png : pngs) {
    if (!png) return tl::unexpected(png.error());
    result.pictures.push_back(*std::move(png));
  }
  result.sheet = std::move(result.pictures.back());
  result.pictures.pop_back();
  return result;
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
    auto encoded = EncodeDoubts(take, shown, *pictures);
    if (!encoded) return tl::unexpected(encoded.error());
    outputs.Add(Beside(output, ".contact.png"), std::move(encoded->sheet));
    pngs = std::move(encoded->pictures);
  }
  AddReports(output, ReviewJson(review, spread, reports), pngs, outputs);
  if (show.overlay) AddOverlays(output, take, show, outputs);
  return {};
}

}  // namespace articap
