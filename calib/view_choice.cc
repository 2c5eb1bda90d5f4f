// SPDX-License-Identifier: MIT
#include "calib/view_choice.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "calib/corner_measurement.h"
#include "core/statistics.h"

namespace articap {
namespace {

// The picture in cells, to see where corners have been.
constexpr int kCellColumns = 12;
constexpr int kCellRows = 9;
using Cells = std::bitset<kCellColumns * kCellRows>;

// Place, distance, tilt and turn of a board; 1 is a large step in each.
using Pose = Eigen::Matrix<double, 7, 1>;

Pose PoseOf(const BoardSpec& board, const FoundBoard& found, double width_px) {
  const BoardHomography homography(board, found.sighting.corners, found.sighting.points_px);
  const Eigen::Vector2d middle(0.5 * (board.corner_columns() - 1), 0.5 * (board.corner_rows() - 1));
  const Eigen::Matrix2d px_from_squares = homography.PxFromSquares(middle);
  const double nearness =
      Eigen::JacobiSVD<Eigen::Matrix2d>(px_from_squares).singularValues()[0] / width_px;
  // A full turn in its plane tells as much as a fifth of the others.
  constexpr double kTurnWeight = 0.1;
  Pose pose;
  pose << homography(middle) / width_px, std::log2(nearness),
      width_px * homography.DepthGradient(middle),
      kTurnWeight * px_from_squares.col(0).normalized();
  return pose;
}

// The sightings of one frame.
struct Candidate {
  std::vector<const FoundBoard*> boards;
  std::vector<Pose> poses;  // of each of them
  Cells cells;
  double edge_px = 0;
  double motion_px = 0;  // to the nearer of the frames before and after; 0 where not known
  std::optional<std::string> reason;  // why it is set aside

  const std::string& source() const { return boards.front()->sighting.source; }
  std::int64_t frame() const { return boards.front()->sighting.frame; }
};

double DistanceBetween(const Candidate& a, const Candidate& b) {
  if (a.poses.size() != b.poses.size()) return 1;
  double distance = 0;
  for (std::size_t i = 0; i < a.poses.size(); ++i)
    distance = std::max(distance, (a.poses[i] - b.poses[i]).norm());
  return distance;
}

std::vector<Candidate> CandidatesOf(const Sightings& sightings, const BoardSpec& board) {
  std::vector<Candidate> candidates;
  for (const FoundBoard& found : sightings.found) {
    if (candidates.empty() || candidates.back().frame() != found.sighting.frame)
      candidates.emplace_back();
    Candidate& candidate = candidates.back();
    candidate.boards.push_back(&found);
    candidate.poses.push_back(PoseOf(board, found, sightings.width));
    candidate.edge_px = std::max(candidate.edge_px, found.quality.edge_px);
    for (const Eigen::Vector2d& point_px : found.sighting.points_px) {
      const int column = static_cast<int>((point_px.x() + 0.5) / sightings.width * kCellColumns);
      const int row = static_cast<int>((point_px.y() + 0.5) / sightings.height * kCellRows);
      candidate.cells.set(std::clamp(row, 0, kCellRows - 1) * kCellColumns +
                          std::clamp(column, 0, kCellColumns - 1));
    }
  }
  return candidates;
}

// Mean over the corners that both show; nothing where there are none.
std::optional<double> MotionBetween(const FoundBoard& a, const FoundBoard& b) {
  if (a.sighting.mirrored != b.sighting.mirrored) return std::nullopt;
  double sum_px = 0;
  int common = 0;
  for (std::size_t i = 0, k = 0; i < a.sighting.corners.size(); ++i) {
    while (k < b.sighting.corners.size() && b.sighting.corners[k] < a.sighting.corners[i]) ++k;
    if (k == b.sighting.corners.size()) break;
    if (b.sighting.corners[k] != a.sighting.corners[i]) continue;
    sum_px += (a.sighting.points_px[i] - b.sighting.points_px[k]).norm();
    ++common;
  }
  if (common == 0) return std::nullopt;
  return sum_px / common;
}

void MeasureMotion(std::vector<Candidate>& candidates) {
  std::vector<std::optional<double>> to_next(candidates.size());
  for (std::size_t i = 0; i + 1 < candidates.size(); ++i)
    if (candidates[i + 1].frame() == candidates[i].frame() + 1)
      to_next[i] = MotionBetween(*candidates[i].boards.front(), *candidates[i + 1].boards.front());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto before = i > 0 ? to_next[i - 1] : std::nullopt;
    constexpr double kNever = std::numeric_limits<double>::infinity();
    if (before || to_next[i])
      candidates[i].motion_px = std::min(before.value_or(kNever), to_next[i].value_or(kNever));
  }
}

// Edges that one picture in ten undercuts.
double SharpestEdge(const std::vector<Candidate>& candidates) {
  std::vector<double> edges;
  for (const Candidate& candidate : candidates) edges.push_back(candidate.edge_px);
  return QuantileOf(std::move(edges), 0.1);
}

void SetAsideBad(std::vector<Candidate>& candidates, double sharpest_px,
                 const ViewChoiceOptions& options) {
  for (Candidate& candidate : candidates) {
    if (candidate.edge_px > options.max_blur_ratio * sharpest_px)
      candidate.reason = fmt::format("blurred: edges {:.1f} px wide, of the sharpest {:.1f}",
                                     candidate.edge_px, sharpest_px);
    else if (candidate.motion_px > options.max_motion_px)
      candidate.reason =
          fmt::format("the board moves: {:.1f} px from frame to frame", candidate.motion_px);
  }
}

class Choice {
 public:
  Choice(std::vector<Candidate>& candidates, const ViewChoiceOptions& options, double sharpest_px)
      : candidates_(candidates),
        options_(options),
        sharpest_px_(sharpest_px),
        nearest_(candidates.size()) {}

  // Leaves a reason with every candidate that is not chosen, and returns what is covered.
  double Choose() {
    for (int views = 0; views < options_.max_views && ChooseOne(); ++views) {
    }
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      if (!IsChosen(i) && !candidates_[i].reason)
        candidates_[i].reason =
            fmt::format("not needed beside {}", candidates_[nearest_[i].chosen].source());
    return static_cast<double>(covered_.count()) / static_cast<double>(covered_.size());
  }

 private:
  struct Nearest {
    std::size_t chosen = 0;
    double distance = 1;
  };

  bool IsChosen(std::size_t i) const {
    return std::find(chosen_.begin(), chosen_.end(), i) != chosen_.end();
  }

  // Sharper and stiller is better; a pixel of motion halves it.
  double QualityOf(const Candidate& candidate) const {
    return std::min(1.0, sharpest_px_ / candidate.edge_px) /
           (1 + candidate.motion_px * candidate.motion_px);
  }

  bool ChooseOne() {
    std::optional<std::size_t> best;
    double best_gain = 0;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (candidates_[i].reason || IsChosen(i)) continue;
      const auto new_cells = static_cast<double>((candidates_[i].cells & ~covered_).count());
      if (new_cells == 0 && nearest_[i].distance < options_.min_novelty) continue;
      // Of the picture's cells a tenth is worth as much as a large step of the board.
      const double gain = QualityOf(candidates_[i]) *
                          (nearest_[i].distance + 10 * new_cells / (kCellColumns * kCellRows));
      if (gain <= best_gain) continue;
      best_gain = gain;
      best = i;
    }
    if (!best) return false;
    chosen_.push_back(*best);
    covered_ |= candidates_[*best].cells;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const double distance = DistanceBetween(candidates_[i], candidates_[*best]);
      if (chosen_.size() == 1 || distance < nearest_[i].distance) nearest_[i] = {*best, distance};
    }
    return true;
  }

  std::vector<Candidate>& candidates_;
  const ViewChoiceOptions& options_;
  double sharpest_px_;
  std::vector<Nearest> nearest_;  // of the chosen ones to each candidate
  std::vector<std::size_t> chosen_;
  Cells covered_;
};

}  // namespace

void VisitOptions(ViewChoiceOptions& options, OptionVisitor& visit) {
  visit("max_views", options.max_views, "views that are used at most");
  visit("max_motion_px", options.max_motion_px,
        "frames of a video in which the board moves further are not used; px a frame");
  visit("max_blur_ratio", options.max_blur_ratio,
        "pictures with edges this many times as wide as the sharpest are not used");
  visit("min_novelty", options.min_novelty,
        "how far from the others a view must be; 1: the picture's width aside, or 45 deg of tilt");
}

Result<void> CheckOptions(const ViewChoiceOptions& options) {
  if (const auto positive = RequirePositive(
          {{"max_views", options.max_views}, {"max_motion_px", options.max_motion_px}});
      !positive)
    return positive;
  if (!(options.max_blur_ratio >= 1))
    return Fail(fmt::format("max_blur_ratio is {}; it must be 1 or more", options.max_blur_ratio));
  return RequireNotNegative({{"min_novelty", options.min_novelty}});
}

ViewChoice ChooseViews(const Sightings& sightings, const BoardSpec& board,
                       const ViewChoiceOptions& options) {
  if (sightings.found.empty()) return {};
  std::vector<Candidate> candidates = CandidatesOf(sightings, board);
  if (sightings.is_video) MeasureMotion(candidates);
  const double sharpest_px = SharpestEdge(candidates);
  SetAsideBad(candidates, sharpest_px, options);
  ViewChoice choice;
  choice.covered = Choice(candidates, options, sharpest_px).Choose();
  for (const Candidate& candidate : candidates) {
    if (candidate.reason) {
      choice.set_aside.push_back({candidate.source(), *candidate.reason});
      continue;
    }
    for (const FoundBoard* found : candidate.boards) choice.views.push_back(*found);
  }
  return choice;
}

}  // namespace articap
