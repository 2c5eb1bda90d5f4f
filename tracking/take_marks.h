// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/dots.h"
#include "core/point_cloud.h"
#include "core/tracks.h"
#include "tracking/label.h"
#include "tracking/take_review.h"

namespace articap {

// A marker in one view of a frame, as a person is shown it.
struct MarkerMark {
  int marker = 0;
  View view;
  std::optional<Eigen::Vector2d> dot_px;  // its dot there; nothing where that view shows none
  double diameter_px = 0;                 // of the dot
  // Where the marker is, or, where nobody saw it, where it should be.
  Eigen::Vector2d place_px = Eigen::Vector2d::Zero();
};

// A dot that is no marker's.
struct SpareDot {
  int camera = 0;
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  double diameter_px = 0;
};

struct FrameMarks {
  std::vector<MarkerMark> markers;
  std::vector<SpareDot> spare_dots;
};

// What is to be shown of a take, frame by frame. A marker that a frame does not have is expected in
// the head where it was before and is afterwards, on a straight line between; in the views that
// show it now or do so in a twentieth of the frames, as far as it lies within the picture.
class TakeMarks {
 public:
  // `tracks`: the take as it is written. What is given must outlive this.
  TakeMarks(const CameraArray& array, const PointClouds& clouds, const Labelling& labelling,
            const StageTracks& tracks, const TakeReview& review,
            const std::vector<std::vector<std::vector<Dot>>>& instants);

  FrameMarks At(int frame) const;
  int num_frames() const { return clouds_.num_frames(); }

 private:
  std::optional<Eigen::Vector3d> PlaceInStage_mm(int frame, int marker) const;
  void AddMarks(int frame, int marker, const CloudPoint* point, FrameMarks& marks) const;

  const CameraArray& array_;
  const PointClouds& clouds_;
  const Labelling& labelling_;
  const StageTracks& tracks_;
  const TakeReview& review_;
  const std::vector<std::vector<std::vector<Dot>>>& instants_;
};

}  // namespace articap
