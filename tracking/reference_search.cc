// SPDX-License-Identifier: MIT
#include "tracking/reference_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/alignment.h"
#include "core/statistics.h"
#include "tracking/reference_shape.h"
#include "tracking/rigidity.h"

namespace articap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMaxCandidates = 24;  // 2024 triples
constexpr int kMaxTrialFrames = 200;
constexpr std::size_t kMaxMembers = 8;  // of a set that grows

// Members are candidate numbers: 0 is candidates[0].
using Members = std::vector<int>;

// By the map, on skin over bone. Brows and lids are on the skull too, but move by themselves.
bool SitsStill(const MarkerSet& set, const std::string& marker_name) {
  const MarkerRole* role = set.Find(marker_name);
  if (!role) return false;
  if (role->head_reference) return true;
  const std::string& landmark = role->landmark;
  const bool is_mobile = landmark.find("brow") != std::string::npos ||
                         landmark.ends_with("eye_upper") || landmark.ends_with("eye_lower");
  return !is_mobile && (RegionOf(*role) == "skull" || RegionOf(*role) == "nose");
}

// Markers seen in four fifths of the frames, on the skull where enough are known to be.
std::vector<int> CandidateColumns(const StageTracks& tracks, const MarkerSet& set,
                                  const std::vector<Eigen::Vector3d>& points_mm,
                                  std::span<const int> frames) {
  std::vector<int> seen, still;
  for (int marker = 0; marker < tracks.num_markers(); ++marker) {
    const auto count = std::ranges::count_if(
        frames, [&](int frame) { return tracks.state(frame, marker) == SampleState::kMeasured; });
    if (count * 5 < std::ssize(frames) * 4 || !points_mm[marker].allFinite()) continue;
    seen.push_back(marker);
    if (SitsStill(set, tracks.names()[marker])) still.push_back(marker);
  }
  return still.size() >= 4 ? still : seen;
}

// The `kMaxCandidates` whose distances from the others vary least.
std::vector<int> MostRigid(const std::vector<int>& columns, const Eigen::MatrixXd& variance_mm2) {
  std::vector<std::pair<double, int>> ranked;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::vector<double> variances;
    for (std::size_t j = 0; j < columns.size(); ++j)
      if (!std::isnan(variance_mm2(i, j))) variances.push_back(variance_mm2(i, j));
    ranked.emplace_back(variances.empty() ? kInfinity : MedianOf(std::move(variances)), columns[i]);
  }
  std::ranges::sort(ranked);
  ranked.resize(std::min(ranked.size(), kMaxCandidates));
  std::vector<int> kept;
  for (const auto& [variance, column] : ranked) kept.push_back(column);
  std::ranges::sort(kept);
  return kept;
}

class Searcher {
 public:
  Searcher(const StageTracks& tracks, const MarkerSet& set,
           const std::vector<Eigen::Vector3d>& points_mm, std::span<const int> frames,
           const AlignerOptions& options)
      : tracks_(tracks), points_mm_(points_mm), options_(options) {
    const std::vector<int> picks =
        SpreadFrames(static_cast<int>(frames.size()), 2 * kMaxTrialFrames);
    for (const int pick : picks) distance_frames_.push_back(frames[pick]);
    for (std::size_t i = 0; i < distance_frames_.size(); i += 2)
      trial_frames_.push_back(distance_frames_[i]);
    candidates_ = CandidateColumns(tracks, set, points_mm, distance_frames_);
    variance_mm2_ = Variances(candidates_);
    candidates_ = MostRigid(candidates_, variance_mm2_);
    variance_mm2_ = Variances(candidates_);
  }

  const std::vector<int>& candidates() const { return candidates_; }

  // Stabilises the trial frames with a set and measures what still moves.
  ReferenceSet Try(const std::vector<int>& columns) const {
    const DistanceStatistics distances =
        MeasureDistances(tracks_, columns, distance_frames_, options_.use_filled);
    Members all(columns.size());
    std::iota(all.begin(), all.end(), 0);
    const auto sigmas_mm = WeightingSigmas(SigmasOfMembers(distances.variance_mm2, all));
    FrameAligner aligner(
        tracks_,
        EstimateReferenceShape(tracks_, columns, sigmas_mm, distances, trial_frames_, options_),
        options_);
    ReferenceSet result{columns, Motion(aligner)};
    DivideByRedundancy(aligner.model(), result);
    result.stillness_mm = Stillness(result.motion_mm);
    return result;
  }

  std::vector<double> DistanceChanges(const std::vector<int>& columns) const {
    constexpr double kOtherPartMm = 50;  // farther than one piece of skin moves as one
    std::vector<double> changes_mm;
    for (const int column : columns) {
      std::vector<double> of_column_mm;
      for (const int candidate : candidates_) {
        if ((points_mm_[column] - points_mm_[candidate]).norm() < kOtherPartMm) continue;
        const double variance_mm2 = Variances({column, candidate})(0, 1);
        if (!std::isnan(variance_mm2))
          of_column_mm.push_back(kSigmasFrom10To90Percent * std::sqrt(variance_mm2));
      }
      changes_mm.push_back(MedianOf(std::move(of_column_mm)));
    }
    return changes_mm;
  }

  std::vector<std::vector<int>> GrownSets() const {
    constexpr std::size_t kNumSeeds = 4;
    std::vector<std::vector<int>> sets;
    for (Members members : BestTriples(kNumSeeds)) {
      Grow(members);
      std::vector<int> columns = ColumnsOf(members);
      std::ranges::sort(columns);
      if (std::ranges::find(sets, columns) == sets.end()) sets.push_back(std::move(columns));
    }
    return sets;
  }

 private:
  // Mean motion over the stillest two thirds of the votes. A candidate's vote is one over the
  // number of candidates in its neighbourhood, so that many markers on one piece of skin count as
  // one.
  double Stillness(const std::vector<double>& motion_mm) const {
    constexpr double kNeighbourhoodMm = 30;
    std::vector<std::pair<double, double>> motions_and_votes;
    double sum_of_votes = 0;
    for (const int candidate : candidates_) {
      if (!std::isfinite(motion_mm[candidate])) continue;
      const auto num_neighbours = std::ranges::count_if(candidates_, [&](int other) {
        return (points_mm_[candidate] - points_mm_[other]).norm() < kNeighbourhoodMm;
      });
      motions_and_votes.emplace_back(motion_mm[candidate],
                                     1.0 / static_cast<double>(num_neighbours));
      sum_of_votes += motions_and_votes.back().second;
    }
    std::ranges::sort(motions_and_votes);
    double sum_mm = 0, votes = 0;
    for (const auto& [motion, vote] : motions_and_votes) {
      if (votes >= 2 * sum_of_votes / 3) break;
      sum_mm += vote * motion;
      votes += vote;
    }
    return votes > 0 ? sum_mm / votes : 0.0;
  }

  Eigen::MatrixXd Variances(const std::vector<int>& columns) const {
    return MeasureDistances(tracks_, columns, distance_frames_, options_.use_filled).variance_mm2;
  }

  std::vector<int> ColumnsOf(const Members& members) const {
    std::vector<int> columns;
    for (const int member : members) columns.push_back(candidates_[member]);
    return columns;
  }

  // Root mean square, over all markers, of how far the pose found from these members would misplace
  // them.
  double PredictedError(const Members& members) const {
    for (const int a : members)
      for (const int b : members)
        if (a != b && std::isnan(variance_mm2_(a, b))) return kInfinity;
    const auto sigmas_mm = WeightingSigmas(SigmasOfMembers(variance_mm2_, members));
    std::vector<Eigen::Vector3d> member_points_mm;
    std::vector<double> weights;
    for (std::size_t i = 0; i < members.size(); ++i) {
      member_points_mm.push_back(points_mm_[candidates_[members[i]]]);
      weights.push_back(1 / (sigmas_mm[i] * sigmas_mm[i]));
    }
    const PointSpread spread = SpreadOf(member_points_mm, weights);
    double sum_mm2 = 0;
    int count = 0;
    for (const Eigen::Vector3d& point : points_mm_) {
      if (!point.allFinite()) continue;
      const double sigma_mm = spread.PlacementSigma(point);
      sum_mm2 += sigma_mm * sigma_mm;
      ++count;
    }
    return std::sqrt(sum_mm2 / count);
  }

  std::vector<Members> BestTriples(std::size_t count) const {
    std::vector<std::pair<double, Members>> ranked;
    const int size = static_cast<int>(candidates_.size());
    for (int a = 0; a < size; ++a)
      for (int b = 0; b < a; ++b)
        for (int c = 0; c < b; ++c)
          ranked.emplace_back(PredictedError({c, b, a}), Members{c, b, a});
    std::ranges::sort(ranked);
    std::vector<Members> best;
    for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i)
      best.push_back(ranked[i].second);
    return best;
  }

  // Adds the most useful candidate as long as it helps by 3 %.
  void Grow(Members& members) const {
    double error_mm = PredictedError(members);
    while (members.size() < kMaxMembers) {
      int best = -1;
      double best_error_mm = 0.97 * error_mm;
      for (int i = 0; i < static_cast<int>(candidates_.size()); ++i) {
        if (std::ranges::find(members, i) != members.end()) continue;
        members.push_back(i);
        const double grown_mm = PredictedError(members);
        members.pop_back();
        if (grown_mm >= best_error_mm) continue;
        best = i;
        best_error_mm = grown_mm;
      }
      if (best < 0) return;
      members.push_back(best);
      error_mm = best_error_mm;
    }
  }

  // A member's residual r becomes r / (1 - h), with h its leverage: its distance from where the
  // others alone would have it.
  static void DivideByRedundancy(const ReferenceModel& model, ReferenceSet& set) {
    std::vector<double> weights;
    for (int i = 0; i < model.size(); ++i)
      weights.push_back(
          model.points_mm[i].allFinite() ? 1 / (model.sigmas_mm[i] * model.sigmas_mm[i]) : 0.0);
    const PointSpread spread = SpreadOf(model.points_mm, weights);
    for (int i = 0; i < model.size(); ++i) {
      const double placement_mm = spread.PlacementSigma(model.points_mm[i]);
      const double leverage = placement_mm * placement_mm * weights[i] / 3;
      constexpr double kLeastRedundancy = 0.02;  // below, the marker alone decides an angle
      set.motion_mm[model.columns[i]] /= std::max(1 - leverage, kLeastRedundancy);
      set.largest_leverage = std::max(set.largest_leverage, leverage);
    }
  }

  std::vector<double> Motion(FrameAligner& aligner) const {
    const std::vector<Eigen::Vector3d> medians_mm =
        MedianPositions(tracks_, aligner, trial_frames_);
    std::vector<std::vector<double>> distances_mm(tracks_.num_markers());
    for (const int frame : trial_frames_) {
      const FrameAlignment alignment = aligner.Align(frame);
      if (alignment.num_used < 3) continue;
      for (int marker = 0; marker < tracks_.num_markers(); ++marker)
        if (tracks_.state(frame, marker) == SampleState::kMeasured)
          distances_mm[marker].push_back(
              (alignment.shape_from_stage * tracks_.position_mm(frame, marker) - medians_mm[marker])
                  .norm());
    }
    std::vector<double> motion_mm;
    for (std::vector<double>& of_marker : distances_mm) {
      std::ranges::sort(of_marker);
      motion_mm.push_back(of_marker.empty() ? std::numeric_limits<double>::quiet_NaN()
                                            : of_marker[(of_marker.size() - 1) * 9 / 10]);
    }
    return motion_mm;
  }

  const StageTracks& tracks_;
  const std::vector<Eigen::Vector3d>& points_mm_;
  const AlignerOptions& options_;
  std::vector<int> distance_frames_;
  std::vector<int> trial_frames_;
  std::vector<int> candidates_;
  Eigen::MatrixXd variance_mm2_;
};

// Better by a twentieth, or as good with fewer references.
bool IsBetter(const ReferenceSet& a, const ReferenceSet& b) {
  if (a.stillness_mm < 0.95 * b.stillness_mm) return true;
  return a.stillness_mm < 1.05 * b.stillness_mm && a.columns.size() < b.columns.size();
}

// Without the fifth of its members, at least one, that moves most.
std::vector<int> WithoutTheWorst(const ReferenceSet& set) {
  std::vector<int> columns = set.columns;
  std::ranges::stable_sort(columns,
                           [&](int a, int b) { return set.motion_mm[a] < set.motion_mm[b]; });
  columns.resize(columns.size() - std::max<std::size_t>(columns.size() / 5, 1));
  std::ranges::sort(columns);
  return columns;
}

}  // namespace

ReferenceSearch SearchReferences(const StageTracks& tracks, const MarkerSet& set,
                                 const std::vector<int>& chosen,
                                 const std::vector<Eigen::Vector3d>& points_mm,
                                 std::span<const int> frames, const AlignerOptions& options) {
  const Searcher searcher(tracks, set, points_mm, frames, options);
  ReferenceSearch search;
  search.chosen = searcher.Try(chosen);
  search.best = search.chosen;
  search.distance_change_mm = searcher.DistanceChanges(chosen);
  const auto consider = [&](ReferenceSet candidate) {
    constexpr double kLargestLeverage = 0.9;
    if (candidate.largest_leverage < kLargestLeverage && IsBetter(candidate, search.best))
      search.best = std::move(candidate);
  };
  for (const std::vector<int>& columns : searcher.GrownSets()) consider(searcher.Try(columns));
  std::vector<int> columns = searcher.candidates();
  while (columns.size() >= 4) {
    ReferenceSet shrinking = searcher.Try(columns);
    columns = WithoutTheWorst(shrinking);
    consider(std::move(shrinking));
  }
  return search;
}

}  // namespace articap
