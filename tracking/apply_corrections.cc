// SPDX-License-Identifier: MIT
#include "tracking/apply_corrections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/check.h"
#include "core/statistics.h"
#include "tracking/label_assignment.h"

namespace articap {
namespace {

constexpr double kByHandSigma_px = 0.5;

// The view of that name; nothing for none.
std::optional<View> ViewOf(const CameraArray& array, const std::string& name) {
  for (const View& view : array.views())
    if (array.NameOf(view) == name) return view;
  return std::nullopt;
}

std::string DescriptionOf(const Correction& correction) {
  const Eigen::Vector2d& place = correction.place_px;
  switch (correction.kind) {
    case CorrectionKind::kRelabel:
      return fmt::format("relabel {} as {}", correction.marker, correction.other);
    case CorrectionKind::kSwap:
      return fmt::format("swap {} and {}", correction.marker, correction.other);
    case CorrectionKind::kDelete:
      return fmt::format("delete {}", correction.marker);
    case CorrectionKind::kDeleteDot:
      return fmt::format("delete the dot of {} at ({:.1f}, {:.1f})", correction.view, place.x(),
                         place.y());
    case CorrectionKind::kSplit:
      return correction.marker.empty() ? "split" : "split " + correction.marker;
    case CorrectionKind::kMove:
      return fmt::format("move {} in {} to ({:.1f}, {:.1f})", correction.marker, correction.view,
                         place.x(), place.y());
  }
  return "";
}

std::string FramesOf(const Correction& correction) {
  return correction.first == correction.last
             ? fmt::format("frame {}", correction.first)
             : fmt::format("frames {} to {}", correction.first, correction.last);
}

// Calls use(frame) for those of a correction's frames that the take has, from 0.
template <class Use>
void ForFrames(const Correction& correction, int first_frame, int num_frames, const Use& use) {
  const int first = std::max(0, correction.first - first_frame);
  for (int frame = first; frame < num_frames && frame <= correction.last - first_frame; ++frame)
    use(frame);
}

// The dot that a person meant; -1 for none.
int DotAt(const std::vector<Dot>& dots, const Eigen::Vector2d& place_px) {
  constexpr double kNear_px = 5;
  int nearest = -1;
  double least_px = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(dots.size()); ++i) {
    const double distance_px = (dots[i].center_px - place_px).norm();
    if (distance_px > std::max(kNear_px, dots[i].diameter_px() / 2) || distance_px >= least_px)
      continue;
    least_px = distance_px;
    nearest = i;
  }
  return nearest;
}

// Like the others of its picture.
Dot DotLike(const std::vector<Dot>& others) {
  constexpr double kOtherwise_px = 8;
  std::vector<double> diameters_px;
  for (const Dot& dot : others) diameters_px.push_back(dot.diameter_px());
  const double diameter_px = others.empty() ? kOtherwise_px : MedianOf(std::move(diameters_px));
  Dot dot;
  dot.shape_px2 = diameter_px * diameter_px / 4 * Eigen::Matrix2d::Identity();
  if (!others.empty()) dot.contrast = others.front().contrast;
  return dot;
}

void MoveDot(const Eigen::Vector2d& place_px, std::vector<Dot>& dots) {
  int at = DotAt(dots, place_px);
  if (at < 0) {
    at = static_cast<int>(dots.size());
    dots.push_back(DotLike(dots));
  }
  dots[at].center_px = place_px;
  dots[at].covariance_px2 = kByHandSigma_px * kByHandSigma_px * Eigen::Matrix2d::Identity();
}

// A labelled frame that is changed by hand.
struct FrameByHand {
  const std::vector<CloudPoint>& cloud;
  const MarkerTemplate& marker_template;
  LabelledFrame& labelled;

  // No change for a frame in which the head was not found.
  bool Has(int marker) const {
    return labelled.template_from_stage.has_value() && labelled.points[marker] >= 0;
  }

  void Unlabel(int marker) {
    labelled.points[marker] = -1;
    labelled.margins[marker] = std::numeric_limits<float>::quiet_NaN();
  }

  void Name(int point, int marker) {
    const TemplateMarker& home = marker_template.markers[marker];
    const MarkerPlace expected = {home.position_mm,
                                  home.sigma_mm * home.sigma_mm * Eigen::Matrix3d::Identity()};
    labelled.points[marker] = point;
    labelled.margins[marker] = std::numeric_limits<float>::quiet_NaN();
    labelled.places[marker] = PlaceOf(expected, cloud[point], *labelled.template_from_stage);
  }

  // How many samples changed.
  int Relabel(int marker, int as) {
    if (!Has(marker)) return 0;
    const int point = labelled.points[marker];
    Unlabel(marker);
    Name(point, as);
    return 1;
  }

  int Swap(int a, int b) {
    const bool has_a = Has(a), has_b = Has(b);
    if (!has_a || !has_b) return has_a ? Relabel(a, b) : Relabel(b, a);
    const int point_of_a = labelled.points[a];
    Name(labelled.points[b], a);
    Name(point_of_a, b);
    return 2;
  }

  int Delete(int marker) {
    if (!Has(marker)) return 0;
    Unlabel(marker);
    return 1;
  }

  // The point with this sight that most views agree on, the nearest to them; -1 for none.
  int BestPointWith(const DotSight& sight) const {
    int best = -1;
    const auto rank = [&](int i) {
      return std::pair(-static_cast<int>(cloud[i].sights.size()), cloud[i].residual_px);
    };
    for (int i = 0; i < static_cast<int>(cloud.size()); ++i) {
      const auto& sights = cloud[i].sights;
      if (std::find(sights.begin(), sights.end(), sight) == sights.end()) continue;
      if (best < 0 || rank(i) < rank(best)) best = i;
    }
    return best;
  }

  int NameDot(const DotSight& sight, int marker) {
    const int point = labelled.template_from_stage ? BestPointWith(sight) : -1;
    if (point < 0) return 0;
    for (int m = 0; m < static_cast<int>(labelled.points.size()); ++m)
      if (m != marker && Has(m) && ClaimOneDot(cloud[labelled.points[m]], cloud[point])) Unlabel(m);
    Name(point, marker);
    return 1;
  }
};

void Clear(int frame, int marker, MarkerRecording& recording) {
  const std::size_t sample =
      static_cast<std::size_t>(frame) * static_cast<std::size_t>(recording.tracks.num_markers()) +
      static_cast<std::size_t>(marker);
  recording.tracks.SetMissing(frame, marker);
  if (!recording.residuals_mm.empty())
    recording.residuals_mm[sample] = std::numeric_limits<float>::quiet_NaN();
  if (!recording.camera_masks.empty()) recording.camera_masks[sample] = 0;
}

// Frames from one to before another as a take of their own.
PointClouds PartOf(const PointClouds& clouds, int first, int end) {
  PointClouds part = {clouds.rate_hz, clouds.first_frame + first, clouds.time(first), {}};
  part.frames.assign(clouds.frames.begin() + first, clouds.frames.begin() + end);
  return part;
}

void Append(Labelling part, Labelling& whole) {
  std::move(part.frames.begin(), part.frames.end(), std::back_inserter(whole.frames));
  whole.searches += part.searches;
  whole.relabelled += part.relabelled;
  whole.swaps_repaired += part.swaps_repaired;
}

}  // namespace

AppliedCorrections::AppliedCorrections(Corrections corrections, int first_frame)
    : corrections_(std::move(corrections)),
      changed_(corrections_.list.size(), 0),
      first_frame_(first_frame) {}

Result<void> AppliedCorrections::CheckViews(const CameraArray& array) const {
  std::vector<std::string> names;
  for (const View& view : array.views()) names.push_back(array.NameOf(view));
  for (const Correction& correction : corrections_.list)
    if (!correction.view.empty() && !ViewOf(array, correction.view))
      return Fail(fmt::format("{}: there is no view '{}'; there {}",
                              correction.WhereIn(corrections_.source), correction.view,
                              names.empty() ? "are none in a file of markers"
                                            : fmt::format("are {}", fmt::join(names, ", "))));
  return {};
}

Result<void> AppliedCorrections::CheckMarkers(const MarkerTemplate& marker_template) const {
  for (const Correction& correction : corrections_.list)
    for (const std::string& name : {correction.marker, correction.other})
      if (!name.empty() && !marker_template.Find(name))
        return Fail(fmt::format("{}: there is no marker '{}'; there are {}",
                                correction.WhereIn(corrections_.source), name,
                                fmt::join(marker_template.names(), ", ")));
  return {};
}

void AppliedCorrections::CorrectDots(const CameraArray& array, std::vector<InstantDots>& instants) {
  for (std::size_t i = 0; i < corrections_.list.size(); ++i) {
    const Correction& correction = corrections_.list[i];
    if (correction.view.empty()) continue;
    const int camera = ViewOf(array, correction.view)->camera;
    ForFrames(correction, first_frame_, static_cast<int>(instants.size()), [&](int frame) {
      std::vector<Dot>& dots = instants[frame][camera];
      if (correction.kind == CorrectionKind::kMove) {
        MoveDot(correction.place_px, dots);
        return;
      }
      const int dot = DotAt(dots, correction.place_px);
      if (dot < 0) return;
      dots.erase(dots.begin() + dot);
      ++changed_[i];
    });
  }
}

std::vector<int> AppliedCorrections::SplitFrames(int num_frames) const {
  std::vector<int> frames;
  for (const Correction& correction : corrections_.list) {
    const int frame = correction.first - first_frame_;
    if (correction.kind == CorrectionKind::kSplit && correction.marker.empty() && frame > 0 &&
        frame < num_frames)
      frames.push_back(frame);
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

Labelling AppliedCorrections::Label(const PointClouds& clouds,
                                    const MarkerTemplate& marker_template,
                                    const LabelOptions& options, const CameraArray& array,
                                    const std::vector<InstantDots>& instants) {
  const std::vector<int> splits = SplitFrames(clouds.num_frames());
  Labelling labelling;
  if (splits.empty()) {
    labelling = LabelClouds(clouds, marker_template, options);
  } else {
    int first = 0;
    for (std::size_t i = 0; i <= splits.size(); ++i) {
      const int end = i < splits.size() ? splits[i] : clouds.num_frames();
      Append(LabelClouds(PartOf(clouds, first, end), marker_template, options), labelling);
      first = end;
    }
  }
  CorrectLabels(clouds, marker_template, array, instants, labelling);
  return labelling;
}

void AppliedCorrections::CorrectLabels(const PointClouds& clouds,
                                       const MarkerTemplate& marker_template,
                                       const CameraArray& array,
                                       const std::vector<InstantDots>& instants,
                                       Labelling& labelling) {
  const int num_frames = clouds.num_frames();
  for (std::size_t i = 0; i < corrections_.list.size(); ++i) {
    const Correction& correction = corrections_.list[i];
    const int marker = marker_template.Find(correction.marker).value_or(-1);
    const int other = marker_template.Find(correction.other).value_or(-1);
    ForFrames(correction, first_frame_, num_frames, [&](int frame) {
      FrameByHand by_hand = {clouds.frames[frame], marker_template, labelling.frames[frame]};
      switch (correction.kind) {
        case CorrectionKind::kRelabel:
          changed_[i] += by_hand.Relabel(marker, other);
          break;
        case CorrectionKind::kSwap:
          changed_[i] += by_hand.Swap(marker, other);
          break;
        case CorrectionKind::kDelete:
          changed_[i] += by_hand.Delete(marker);
          break;
        case CorrectionKind::kMove: {
          const View view = *ViewOf(array, correction.view);
          const int dot = DotAt(instants[frame][view.camera], correction.place_px);
          changed_[i] += by_hand.NameDot({view, dot}, marker);
          break;
        }
        case CorrectionKind::kSplit:
          // A split of all is where the parts meet; one at the very beginning parts nothing.
          changed_[i] += frame > 0 ? 1 : 0;
          break;
        case CorrectionKind::kDeleteDot:
          break;
      }
    });
  }
}

void AppliedCorrections::ClearFillsAcrossSplits(const Labelling& labelling,
                                                MarkerRecording& recording) const {
  StageTracks& tracks = recording.tracks;
  for (const Correction& correction : corrections_.list) {
    const int split = correction.first - first_frame_;
    if (correction.kind != CorrectionKind::kSplit || split <= 0 || split >= tracks.num_frames())
      continue;
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      if (!correction.marker.empty() && tracks.names()[marker] != correction.marker) continue;
      const auto is_filled = [&](int frame) {
        return frame >= 0 && frame < tracks.num_frames() &&
               tracks.state(frame, marker) == SampleState::kFilled &&
               labelling.frames[frame].points[marker] < 0;
      };
      // A gap that begins or ends at the split has its other end beyond it, too.
      for (int frame = split; is_filled(frame); ++frame) Clear(frame, marker, recording);
      for (int frame = split - 1; is_filled(frame); --frame) Clear(frame, marker, recording);
    }
  }
}

StageReport AppliedCorrections::Report() const {
  StageReport report;
  report.stage = "correct";
  int total = 0, without_effect = 0;
  for (std::size_t i = 0; i < corrections_.list.size(); ++i) {
    const Correction& correction = corrections_.list[i];
    total += changed_[i];
    if (changed_[i] > 0) continue;
    ++without_effect;
    report.warnings.push_back(fmt::format(
        "{}: {}, {}: nothing there to be corrected; nothing was changed",
        correction.WhereIn(corrections_.source), DescriptionOf(correction), FramesOf(correction)));
  }
  report.verdict = fmt::format("{} of {} corrections applied",
                               corrections_.list.size() - without_effect, corrections_.list.size());
  report.figures = {{"corrections", static_cast<double>(corrections_.list.size())},
                    {"changed_samples", total},
                    {"without_effect", without_effect}};
  report.texts = {{"file", corrections_.source}};
  return report;
}

}  // namespace articap
