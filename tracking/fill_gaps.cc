// SPDX-License-Identifier: MIT
#include "tracking/fill_gaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tracking/fill_report.h"
#include "tracking/gap_frames.h"
#include "tracking/gap_regression.h"
#include "tracking/gap_windows.h"

namespace articap {
namespace {

// Gaps of nearly one length share what is learnt: lengths a factor of the fourth root of two apart,
// and all up to 5.
int SharedLength(int length) {
  constexpr double kStepsAnOctave = 4;
  const double step = std::round(kStepsAnOctave * std::log2(length)) / kStepsAnOctave;
  return static_cast<int>(std::lround(std::exp2(step)));
}

bool IsAtEnd(const Gap& gap, int num_frames) {
  return gap.first == 0 || gap.first + gap.length == num_frames;
}

std::vector<Gap> FillableGaps(const StageTracks& tracks, const std::vector<Gap>& gaps,
                              const FillOptions& options) {
  std::vector<Gap> fillable;
  for (const Gap& gap : gaps) {
    const double longest_s = IsAtEnd(gap, tracks.num_frames())
                                 ? std::min(options.longest_s, options.longest_at_end_s)
                                 : options.longest_s;
    constexpr double kRounding = 1e-6;  // of a frame
    if (gap.length <= longest_s * tracks.rate_hz() + kRounding) fillable.push_back(gap);
  }
  return fillable;
}

// Fills gaps one after another; each serves those that follow.
class Filler {
 public:
  Filler(const StageTracks& tracks, std::vector<Rigid3d> local_from_stage)
      : local_from_stage_(std::move(local_from_stage)),
        knowledge_(tracks),
        series_(LocalSeries(tracks, local_from_stage_)),
        filled_(tracks) {}

  void Fill(const Gap& gap) {
    const GapShape shape = ShapeOf(gap, knowledge_);
    const GapShape scale{SharedLength(gap.length), shape.before > 0 ? GapShape::kMostContext : 0,
                         shape.after > 0 ? GapShape::kMostContext : 0};
    const auto regression = regressions_.try_emplace(scale, knowledge_, series_, scale).first;
    GapFill fill = regression->second.Fill(gap, shape);
    if (IsAtEnd(gap, filled_.num_frames()) && !fill.is_regression) return;
    // No better than the last digit of files, 0.1 micrometres, is rounded.
    constexpr double kLeastSigma_mm = 3e-5;
    fill.sigmas_mm = fill.sigmas_mm.array().max(kLeastSigma_mm);
    Accept(gap, fill);
    done_.push_back({gap, fill.is_regression, std::move(fill.sigmas_mm)});
  }

  const StageTracks& tracks() const { return filled_; }
  const std::vector<FilledGap>& done() const { return done_; }

 private:
  void Accept(const Gap& gap, const GapFill& fill) {
    series_.block(gap.first, 3 * gap.marker, gap.length, 3) = fill.positions_mm;
    knowledge_.SetFilled(gap);
    for (int k = 0; k < gap.length; ++k) {
      const Eigen::Vector3d local_mm = fill.positions_mm.row(k);
      filled_.Set(gap.first + k, gap.marker, local_from_stage_[gap.first + k].Inverse() * local_mm,
                  SampleState::kFilled, static_cast<float>(fill.sigmas_mm[k]));
    }
  }

  std::vector<Rigid3d> local_from_stage_;
  Knowledge knowledge_;
  Eigen::MatrixXd series_;
  StageTracks filled_;
  std::map<GapShape, GapRegression> regressions_;
  std::vector<FilledGap> done_;
};

}  // namespace

void VisitOptions(FillOptions& options, OptionVisitor& visit) {
  visit("longest_s", options.longest_s, "longer gaps stay gaps; 0: all do; s");
  visit("longest_at_end_s", options.longest_at_end_s,
        "the same at the beginning and the end of the take; s");
  visit("follow_head", options.follow_head,
        "take the head's movement out first; false: the recording is fixed to the head");
}

Result<void> CheckOptions(const FillOptions& options) {
  return RequireNotNegative(
      {{"longest_s", options.longest_s}, {"longest_at_end_s", options.longest_at_end_s}});
}

Result<StageResult<StageTracks>> FillGaps(const StageTracks& tracks, const FillOptions& options) {
  if (auto checked = CheckOptions(options); !checked) return tl::unexpected(checked.error());
  const std::vector<Gap> gaps = FindGaps(tracks);
  const std::vector<Gap> fillable = FillableGaps(tracks, gaps, options);
  if (fillable.empty())
    return StageResult<StageTracks>{tracks, ReportFills(tracks, gaps, {}, options)};
  Filler filler(
      tracks, options.follow_head ? FollowHead(tracks) : std::vector<Rigid3d>(tracks.num_frames()));
  for (const Gap& gap : fillable) filler.Fill(gap);
  return StageResult<StageTracks>{filler.tracks(),
                                  ReportFills(tracks, gaps, filler.done(), options)};
}

Result<StageResult<MarkerRecording>> FillGaps(const MarkerRecording& recording,
                                              const FillOptions& options) {
  auto filled = FillGaps(recording.tracks, options);
  if (!filled) return tl::unexpected(filled.error());
  StageResult<MarkerRecording> result{recording, std::move(filled->report)};
  std::size_t sample = 0;
  for (int frame = 0; frame < recording.tracks.num_frames(); ++frame)
    for (int marker = 0; marker < recording.tracks.num_markers(); ++marker, ++sample) {
      const bool is_filled =
          recording.tracks.is_missing(frame, marker) && !filled->output.is_missing(frame, marker);
      if (!is_filled) continue;
      if (!recording.residuals_mm.empty()) result.output.residuals_mm[sample] = 0;
      if (!recording.camera_masks.empty()) result.output.camera_masks[sample] = 0;
    }
  result.output.tracks = std::move(filled->output);
  return result;
}

}  // namespace articap
