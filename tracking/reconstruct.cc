// SPDX-License-Identifier: MIT
#include "tracking/reconstruct.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "core/check.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace articap {
namespace {

// A dot in a view, ready for triangulation.
struct Candidate {
  int view = 0;  // index in the projections
  int camera = 0;
  int dot = 0;
  double sigma_px = 0;   // of the centre, the mean of both directions
  double hidden_px = 0;  // how far off the centre may be if the marker is half hidden
  double px_of_rad = 0;
  SightLine line;
};

// A marker as some views may have seen it; members are candidates, one a view, in their order.
struct Hypothesis {
  std::vector<int> members;
  SightedPoint point;

  double chi2_per_freedom() const {
    return point.chi2 / (2.0 * static_cast<double>(members.size()) - 3.0);
  }
};

// All that one instant shows, and what may be made of it.
class Instant {
 public:
  Instant(const CameraArray& array, const std::vector<ViewProjection>& projections,
          const ReconstructOptions& options, std::span<const std::vector<Dot>> dots)
      : array_(array), projections_(projections), options_(options) {
    for (int view = 0; view < static_cast<int>(projections.size()); ++view) {
      first_of_view_.push_back(static_cast<int>(candidates_.size()));
      AddView(view, dots[projections[view].view.camera]);
    }
    first_of_view_.push_back(static_cast<int>(candidates_.size()));
  }

  std::vector<CloudPoint> Points(const std::optional<WorkingVolume>& volume) {
    PairAllViews();
    for (const Hypothesis& hypothesis : hypotheses_)
      for (const int member : hypothesis.members) matched_.insert(KeyOf(member));
    second_chance_ = HalvesCount();
    if (second_chance_) PairAllViews();
    std::set<DotKey> taken;
    std::vector<CloudPoint> points = Choose(taken);
    if (volume) AddSingleSights(*volume, taken, points);
    return points;
  }

 private:
  using DotKey = std::pair<int, int>;  // camera and dot

  int num_views() const { return static_cast<int>(projections_.size()); }

  void AddView(int view, const std::vector<Dot>& dots) {
    const ViewProjection& projection = projections_[view];
    const Lens& lens = array_.cameras[projection.view.camera].lens;
    for (int dot = 0; dot < static_cast<int>(dots.size()); ++dot) {
      // Of its diameter, SD and the farthest: half of a disc has its middle 0.21 diameters aside.
      constexpr double kHidden = 0.1, kMostHidden = 0.25;
      if (!array_.MayShow(projection.view, dots[dot].center_px)) continue;
      const double diameter_px = dots[dot].diameter_px();
      const bool is_hidden = dots[dot].occluded && HalvesCount();
      const double slack_px =
          std::hypot(options_.calibration_px, is_hidden ? kHidden * diameter_px : 0);
      const auto line = SightLineOf(array_, projection, dots[dot], slack_px);
      if (!line) continue;
      candidates_.push_back(
          {.view = view,
           .camera = projection.view.camera,
           .dot = dot,
           .sigma_px = std::sqrt(dots[dot].covariance_px2.trace() / 2 + slack_px * slack_px),
           .hidden_px = kMostHidden * diameter_px,
           .px_of_rad = std::min(lens.fx_px, lens.fy_px),
           .line = *line});
    }
  }

  // Where several cameras look, others see a half-hidden marker whole.
  bool HalvesCount() const { return array_.cameras.size() == 1; }

  double Gate_px(double sigma_px) const {
    return std::max(*options_.match_px, options_.match_sigmas * sigma_px);
  }
  double Gate_px(const Candidate& candidate) const {
    const double gate_px = Gate_px(candidate.sigma_px);
    return second_chance_ ? std::max(gate_px, candidate.hidden_px) : gate_px;
  }

  bool IsReachable(double along_mm) const {
    return along_mm > options_.nearest_mm && along_mm < options_.farthest_mm;
  }
  bool IsBeforeMirror(int view, const Eigen::Vector3d& point) const {
    const View& seen_by = projections_[view].view;
    if (seen_by.mirror < 0) return true;
    const Mirror& mirror = array_.mirrors[seen_by.mirror];
    return mirror.normal_in_stage.dot(point) < mirror.distance_mm;
  }

  void PairAllViews() {
    for (int first = 0; first < num_views(); ++first)
      for (int second = first + 1; second < num_views(); ++second) PairViews(first, second);
  }

  void PairViews(int first_view, int second_view) {
    for (int i = first_of_view_[first_view]; i < first_of_view_[first_view + 1]; ++i) {
      if (matched_.contains(KeyOf(i))) continue;
      for (int k = first_of_view_[second_view]; k < first_of_view_[second_view + 1]; ++k)
        if (!matched_.contains(KeyOf(k)) && Meet(candidates_[i], candidates_[k]) &&
            !settled_.contains({i, k}))
          Grow(i, k);
    }
  }

  bool Meet(const Candidate& first, const Candidate& second) const {
    if (first.camera == second.camera && first.dot == second.dot) return false;
    const auto meeting = MeetingOf(first.line, second.line);
    if (!meeting || !IsReachable(meeting->along_first_mm) || !IsReachable(meeting->along_second_mm))
      return false;
    const double gate_mm =
        std::hypot(meeting->along_first_mm * Gate_px(first) / first.px_of_rad,
                   meeting->along_second_mm * Gate_px(second) / second.px_of_rad);
    return meeting->apart_mm < gate_mm && IsBeforeMirror(first.view, meeting->middle_mm) &&
           IsBeforeMirror(second.view, meeting->middle_mm);
  }

  std::optional<SightedPoint> PointOfMembers(const std::vector<int>& members) const {
    std::vector<const SightLine*> lines;
    lines.reserve(members.size());
    for (const int member : members) lines.push_back(&candidates_[member].line);
    return PointOf(lines);
  }

  // Every sight lies where the point puts it.
  bool Agrees(const std::vector<int>& members, const SightedPoint& point) const {
    for (const int member : members) {
      const Candidate& candidate = candidates_[member];
      const auto residual = candidate.line.Residual_px(point.point_in_stage_mm);
      if (!residual || residual->norm() > Gate_px(candidate)) return false;
    }
    return true;
  }

  // How far a candidate lies from where its view would show the point, whose own uncertainty is
  // allowed for; nothing where that is too far.
  std::optional<double> DistanceOf(const Candidate& candidate, const SightedPoint& point) const {
    const SightLine& line = candidate.line;
    const auto residual = line.Residual_px(point.point_in_stage_mm);
    if (!residual) return std::nullopt;
    const double depth_mm = (point.point_in_stage_mm - line.eye_in_stage_mm).norm();
    // Across the ray.
    const double along = line.ray_in_stage.dot(point.covariance_mm2 * line.ray_in_stage);
    const double spread_px = std::sqrt(std::max(0.0, point.covariance_mm2.trace() - along)) *
                             line.px_of_plane.norm() / depth_mm;
    if (residual->norm() > Gate_px(std::hypot(candidate.sigma_px, spread_px))) return std::nullopt;
    return residual->norm();
  }

  // Adds, view by view, the dot that is nearest to where the point would appear.
  void Grow(int first, int second) {
    Hypothesis grown;
    grown.members = {first, second};
    auto point = PointOfMembers(grown.members);
    if (!point || !Agrees(grown.members, *point)) return;
    grown.point = *point;
    for (int view = 0; view < num_views(); ++view) {
      if (view == candidates_[first].view || view == candidates_[second].view) continue;
      const std::optional<int> nearest = NearestIn(view, grown);
      if (!nearest) continue;
      std::vector<int> more = grown.members;
      more.insert(std::lower_bound(more.begin(), more.end(), *nearest), *nearest);
      point = PointOfMembers(more);
      if (!point || !Agrees(more, *point)) continue;
      grown = {std::move(more), *point};
    }
    Keep(std::move(grown));
  }

  std::optional<int> NearestIn(int view, const Hypothesis& grown) const {
    std::optional<int> nearest;
    double least_px = std::numeric_limits<double>::infinity();
    if (!IsBeforeMirror(view, grown.point.point_in_stage_mm)) return nearest;
    for (int i = first_of_view_[view]; i < first_of_view_[view + 1]; ++i) {
      const bool taken = std::any_of(grown.members.begin(), grown.members.end(), [&](int member) {
        return candidates_[member].camera == candidates_[i].camera &&
               candidates_[member].dot == candidates_[i].dot;
      });
      if (taken) continue;
      const auto distance_px = DistanceOf(candidates_[i], grown.point);
      if (!distance_px || *distance_px >= least_px) continue;
      least_px = *distance_px;
      nearest = i;
    }
    return nearest;
  }

  void Keep(Hypothesis grown) {
    // What all views agree on need not be found again from its other pairs.
    if (static_cast<int>(grown.members.size()) == num_views())
      for (const int i : grown.members)
        for (const int k : grown.members)
          if (i < k) settled_.insert({i, k});
    if (!known_.insert(grown.members).second) return;
    hypotheses_.push_back(std::move(grown));
  }

  DotKey KeyOf(int candidate) const {
    return {candidates_[candidate].camera, candidates_[candidate].dot};
  }

  // `taken`: the dots of what three views or more see.
  std::vector<CloudPoint> Choose(std::set<DotKey>& taken) {
    std::sort(hypotheses_.begin(), hypotheses_.end(), [](const Hypothesis& a, const Hypothesis& b) {
      if (a.members.size() != b.members.size()) return a.members.size() > b.members.size();
      return a.chi2_per_freedom() < b.chi2_per_freedom();
    });
    std::vector<CloudPoint> points;
    for (const Hypothesis& hypothesis : hypotheses_) {
      const bool free = std::none_of(hypothesis.members.begin(), hypothesis.members.end(),
                                     [&](int member) { return taken.contains(KeyOf(member)); });
      if (!free) continue;
      if (hypothesis.members.size() > 2)
        for (const int member : hypothesis.members) taken.insert(KeyOf(member));
      points.push_back(CloudPointOf(hypothesis));
    }
    return points;
  }

  CloudPoint CloudPointOf(const Hypothesis& hypothesis) const {
    CloudPoint result;
    result.position_in_stage_mm = hypothesis.point.point_in_stage_mm;
    // Where the sights contradict one another more than their noise explains, the noise is larger.
    result.covariance_mm2 =
        hypothesis.point.covariance_mm2 * std::max(1.0, hypothesis.chi2_per_freedom());
    double squares = 0, squares_mm2 = 0;
    for (const int member : hypothesis.members) {
      const Candidate& candidate = candidates_[member];
      result.sights.push_back({projections_[candidate.view].view, candidate.dot});
      squares += candidate.line.Residual_px(result.position_in_stage_mm)->squaredNorm();
      squares_mm2 += candidate.line.ray_in_stage
                         .cross(result.position_in_stage_mm - candidate.line.eye_in_stage_mm)
                         .squaredNorm();
    }
    const auto count = static_cast<double>(hypothesis.members.size());
    result.residual_px = std::sqrt(squares / count);
    result.residual_mm = std::sqrt(squares_mm2 / count);
    return result;
  }

  void AddSingleSights(const WorkingVolume& volume, const std::set<DotKey>& taken,
                       std::vector<CloudPoint>& points) const {
    for (int i = 0; i < static_cast<int>(candidates_.size()); ++i) {
      const Candidate& candidate = candidates_[i];
      const SightLine& line = candidate.line;
      const double along_mm = line.ray_in_stage.dot(volume.center_mm - line.eye_in_stage_mm);
      const Eigen::Vector3d nearest = line.eye_in_stage_mm + along_mm * line.ray_in_stage;
      constexpr double kVolumes = 2;
      if (taken.contains(KeyOf(i)) || !IsReachable(along_mm) ||
          (nearest - volume.center_mm).norm() > kVolumes * volume.sigma_mm ||
          !IsBeforeMirror(candidate.view, nearest))
        continue;
      const double across_mm =
          along_mm * candidate.sigma_px / line.px_of_plane.norm() * std::numbers::sqrt2;
      const Eigen::Matrix3d along = line.ray_in_stage * line.ray_in_stage.transpose();
      CloudPoint point;
      point.position_in_stage_mm = nearest;
      point.covariance_mm2 = across_mm * across_mm * (Eigen::Matrix3d::Identity() - along) +
                             volume.sigma_mm * volume.sigma_mm * along;
      point.sights = {{projections_[candidate.view].view, candidate.dot}};
      points.push_back(std::move(point));
    }
  }

  const CameraArray& array_;
  const std::vector<ViewProjection>& projections_;
  const ReconstructOptions& options_;
  std::vector<Candidate> candidates_;  // view by view
  std::vector<int> first_of_view_;
  std::vector<Hypothesis> hypotheses_;
  std::set<std::vector<int>> known_;
  std::set<std::pair<int, int>> settled_;
  // Dots that nothing met within their noise may be half hidden, and get a second chance.
  std::set<DotKey> matched_;
  bool second_chance_ = false;
};

RecordingSurvey SurveyOf(const std::vector<CloudPoint>& points, double widest_px) {
  constexpr double kLeast_px = 0.02;
  constexpr double kMedians = 5;
  RecordingSurvey survey;
  survey.match_px = widest_px;
  if (points.empty()) return survey;
  std::vector<double> residuals, distances;
  std::array<std::vector<double>, 3> coordinates;
  for (const CloudPoint& point : points) {
    residuals.push_back(point.residual_px);
    for (int axis = 0; axis < 3; ++axis)
      coordinates[axis].push_back(point.position_in_stage_mm[axis]);
  }
  survey.match_px = std::clamp(kMedians * MedianOf(residuals), kLeast_px, widest_px);
  WorkingVolume volume;
  for (int axis = 0; axis < 3; ++axis) volume.center_mm[axis] = MedianOf(coordinates[axis]);
  for (const CloudPoint& point : points)
    distances.push_back((point.position_in_stage_mm - volume.center_mm).norm());
  constexpr double kLeast_mm = 30;  // a few markers close together are not the whole head
  volume.sigma_mm = std::max(kLeast_mm, 3 * MedianOf(distances));
  survey.volume = volume;
  return survey;
}

}  // namespace

void VisitOptions(ReconstructOptions& options, OptionVisitor& visit) {
  visit("calibration_px", options.calibration_px, "what calibration is off at a dot, SD; px");
  visit("match_px", options.match_px,
        "how far a dot may lie from where the other views put it; else as far as the recording "
        "shows; px");
  visit("match_sigmas", options.match_sigmas, "standard deviations of its noise, where more");
  visit("nearest_mm", options.nearest_mm, "no marker is nearer to a camera; mm");
  visit("farthest_mm", options.farthest_mm, "no marker is farther from a camera; mm");
}

Result<void> CheckOptions(const ReconstructOptions& options) {
  return RequirePositive({{"calibration_px", options.calibration_px},
                          {"match_px", options.match_px.value_or(1)},
                          {"match_sigmas", options.match_sigmas},
                          {"nearest_mm", options.nearest_mm},
                          {"farthest_mm", options.farthest_mm}});
}

Reconstructor::Reconstructor(const CameraArray& array, const ReconstructOptions& options,
                             const std::optional<WorkingVolume>& volume)
    : array_(array), options_(options), volume_(volume) {
  ARTICAP_CHECK(options_.match_px.has_value());
  for (const View& view : array_.views()) projections_.push_back(ProjectionOf(array_, view));
}

std::vector<CloudPoint> Reconstructor::operator()(std::span<const std::vector<Dot>> dots) const {
  ARTICAP_CHECK_EQ(dots.size(), array_.cameras.size());
  return Instant(array_, projections_, options_, dots).Points(volume_);
}

RecordingSurvey Survey(const CameraArray& array, std::span<const InstantDots> instants,
                       const ReconstructOptions& options) {
  constexpr std::size_t kMostFrames = 60;
  constexpr double kWide_px = 1.5;
  ReconstructOptions wide = options;
  wide.match_px = kWide_px;
  const Reconstructor reconstruct(array, wide);
  std::vector<CloudPoint> of_many, of_two;
  const std::size_t step = instants.size() / kMostFrames + 1;
  for (std::size_t frame = 0; frame < instants.size(); frame += step)
    for (CloudPoint& point : reconstruct(instants[frame]))
      (point.sights.size() > 2 ? of_many : of_two).push_back(std::move(point));
  return SurveyOf(of_many.empty() ? of_two : of_many, kWide_px);
}

std::vector<std::vector<CloudPoint>> Reconstruct(const CameraArray& array,
                                                 std::span<const InstantDots> instants,
                                                 const ReconstructOptions& options) {
  const RecordingSurvey survey = Survey(array, instants, options);
  ReconstructOptions used = options;
  if (!used.match_px) used.match_px = survey.match_px;
  const Reconstructor reconstruct(array, used, survey.volume);
  std::vector<std::vector<CloudPoint>> clouds(instants.size());
  ParallelFor(static_cast<int>(instants.size()), 0,
              [&](int frame) { clouds[frame] = reconstruct(instants[frame]); });
  return clouds;
}

}  // namespace articap
