// SPDX-License-Identifier: MIT
#include "tracking/exchange_check.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>

#include "core/alignment.h"
#include "tracking/rigidity.h"

namespace articap {
namespace {

// The pair of references whose exchange makes a frame fit, by their indices in the model.
std::optional<std::pair<int, int>> ExchangeInFrame(const StageTracks& tracks,
                                                   const ReferenceModel& model, int frame,
                                                   double fit_mm) {
  std::vector<Eigen::Vector3d> seen_mm, shape_mm;
  std::vector<int> index;
  for (int i = 0; i < model.size(); ++i) {
    if (tracks.is_missing(frame, model.columns[i]) || !model.points_mm[i].allFinite()) continue;
    seen_mm.push_back(tracks.position_mm(frame, model.columns[i]));
    shape_mm.push_back(model.points_mm[i]);
    index.push_back(i);
  }
  // Of three points, too many exchanges fit by chance.
  if (seen_mm.size() < 4) return std::nullopt;
  const auto rms = [&] { return AlignmentRms(AlignRigid(seen_mm, shape_mm), seen_mm, shape_mm); };
  double best_rms_mm = std::min(fit_mm, rms() / 3);
  std::optional<std::pair<int, int>> best;
  for (std::size_t a = 0; a < seen_mm.size(); ++a)
    for (std::size_t b = a + 1; b < seen_mm.size(); ++b) {
      std::swap(seen_mm[a], seen_mm[b]);
      if (const double rms_mm = rms(); rms_mm < best_rms_mm) {
        best_rms_mm = rms_mm;
        best = {index[a], index[b]};
      }
      std::swap(seen_mm[a], seen_mm[b]);
    }
  return best;
}

}  // namespace

std::vector<std::string> FindExchangesInFrames(const StageTracks& tracks,
                                               const ReferenceModel& model,
                                               std::span<const int> suspects, double fit_mm) {
  constexpr int kMaxFrames = 200;
  std::map<std::pair<int, int>, std::vector<int>> frames_of_pair;
  if (suspects.empty()) return {};
  const std::vector<int> picks = SpreadFrames(static_cast<int>(suspects.size()), kMaxFrames);
  for (const int pick : picks)
    if (const auto pair = ExchangeInFrame(tracks, model, suspects[pick], fit_mm))
      frames_of_pair[*pair].push_back(suspects[pick] + tracks.first_frame());
  std::vector<std::string> sentences;
  for (const auto& [pair, frames] : frames_of_pair)
    sentences.push_back(fmt::format(
        "'{}' and '{}' are exchanged in {} of the {} conspicuous frames looked at (of {}), first "
        "in "
        "frame {}; both counted as outliers there",
        tracks.names()[model.columns[pair.first]], tracks.names()[model.columns[pair.second]],
        frames.size(), picks.size(), suspects.size(), frames.front()));
  return sentences;
}

}  // namespace articap
