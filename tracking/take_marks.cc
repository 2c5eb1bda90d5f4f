// SPDX-License-Identifier: MIT
#include "tracking/take_marks.h"

#include <algorithm>
#include <set>
#include <utility>

namespace articap {
namespace {

constexpr double kLeastShareOfFrames = 0.05;

bool IsWithin(const Camera& camera, const Eigen::Vector2d& point_px) {
  return point_px.x() > -0.5 && point_px.y() > -0.5 && point_px.x() < camera.width - 0.5 &&
         point_px.y() < camera.height - 0.5;
}

}  // namespace

TakeMarks::TakeMarks(const CameraArray& array, const PointClouds& clouds,
                     const Labelling& labelling, const StageTracks& tracks,
                     const TakeReview& review,
                     const std::vector<std::vector<std::vector<Dot>>>& instants)
    : array_(array),
      clouds_(clouds),
      labelling_(labelling),
      tracks_(tracks),
      review_(review),
      instants_(instants) {}

// Where it is, or should be.
std::optional<Eigen::Vector3d> TakeMarks::PlaceInStage_mm(int frame, int marker) const {
  if (!tracks_.is_missing(frame, marker)) return tracks_.position_mm(frame, marker);
  if (!labelling_.frames[frame].template_from_stage) return std::nullopt;
  const auto known = [&](int at) {
    return !tracks_.is_missing(at, marker) && labelling_.frames[at].template_from_stage.has_value();
  };
  const auto in_head_mm = [&](int at) {
    return Eigen::Vector3d(*labelling_.frames[at].template_from_stage *
                           tracks_.position_mm(at, marker));
  };
  int before = frame, after = frame;
  while (before >= 0 && !known(before)) --before;
  while (after < num_frames() && !known(after)) ++after;
  if (before < 0 && after == num_frames()) return std::nullopt;
  if (before < 0) before = after;
  if (after == num_frames()) after = before;
  const double part = after > before ? 1.0 * (frame - before) / (after - before) : 0;
  return labelling_.frames[frame].template_from_stage->Inverse() *
         ((1 - part) * in_head_mm(before) + part * in_head_mm(after));
}

void TakeMarks::AddMarks(int frame, int marker, const CloudPoint* point, FrameMarks& marks) const {
  const auto place_mm = PlaceInStage_mm(frame, marker);
  if (!place_mm) return;
  const std::vector<View> views = array_.views();
  for (std::size_t v = 0; v < views.size(); ++v) {
    MarkerMark mark = {marker, views[v], std::nullopt, 0, Eigen::Vector2d::Zero()};
    if (point)
      for (const DotSight& sight : point->sights) {
        if (!(sight.view == views[v])) continue;
        const Dot& dot = instants_[frame][sight.view.camera][sight.dot];
        mark.dot_px = dot.center_px;
        mark.diameter_px = dot.diameter_px();
      }
    if (!mark.dot_px && review_.markers[marker].seen_by_view[v] < kLeastShareOfFrames) continue;
    const auto place_px = Project(array_, views[v], *place_mm);
    if (!place_px || !IsWithin(array_.cameras[views[v].camera], *place_px) ||
        !array_.MayShow(views[v], *place_px))
      continue;
    mark.place_px = *place_px;
    marks.markers.push_back(mark);
  }
}

FrameMarks TakeMarks::At(int frame) const {
  FrameMarks marks;
  std::set<std::pair<int, int>> named;  // camera and dot
  const LabelledFrame& labelled = labelling_.frames[frame];
  for (int marker = 0; marker < tracks_.num_markers(); ++marker) {
    const bool has_point = labelled.template_from_stage && labelled.points[marker] >= 0;
    const CloudPoint* point = has_point ? &clouds_.frames[frame][labelled.points[marker]] : nullptr;
    AddMarks(frame, marker, point, marks);
    if (!point) continue;
    for (const DotSight& sight : point->sights) named.insert({sight.view.camera, sight.dot});
  }
  for (int camera = 0; camera < static_cast<int>(instants_[frame].size()); ++camera)
    for (int i = 0; i < static_cast<int>(instants_[frame][camera].size()); ++i) {
      if (named.contains({camera, i})) continue;
      const Dot& dot = instants_[frame][camera][i];
      marks.spare_dots.push_back({camera, dot.center_px, dot.diameter_px()});
    }
  return marks;
}

}  // namespace articap
