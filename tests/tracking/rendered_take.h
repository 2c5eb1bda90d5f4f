// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/dots.h"
#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "synthetic/camera_rigs.h"
#include "synthetic/film.h"
#include "tracking/label.h"

namespace articap {

// A synthetic speaker is filmed; pictures are rendered, and their dots detected.
struct RenderedTakeOptions {
  SyntheticCameras cameras;
  std::string map = "mirror6";
  FilmOptions film;
  double rate_hz = 25;
  double rest_s = 0.6;             // before the sentence, exactly still
  std::optional<double> turn_deg;  // of the head, at most
  int num_frames = 60;
  int seed = 1;
};

struct RenderedTake {
  std::vector<std::string> names;
  std::vector<View> views;
  double rate_hz = 0;
  int rest_frames = 0;                                       // at the beginning
  std::vector<std::vector<Eigen::Vector3d>> positions_mm;    // by frame and marker, true stage
  std::vector<std::vector<std::vector<DotTruth>>> in_views;  // by frame, view and marker
  std::vector<std::vector<std::vector<Dot>>> dots;           // by frame and camera, as detected

  int num_frames() const { return static_cast<int>(dots.size()); }
  struct Owner {
    int marker = -1;  // nobody's
    double visible = 0;
  };
  // The marker nearest to a dot; `expected` if it is within a quarter of the diameter.
  Owner OwnerOf(int frame, int camera, const Dot& dot, int expected) const;
  // In how many views at least such a part of the marker is seen.
  int CountViews(int frame, int marker, double least_visible) const;
};
RenderedTake RenderTake(const RenderedTakeOptions& options);

// From the dots to labels, by the map alone.
struct TrackedTake {
  PointClouds clouds;
  MarkerTemplate marker_template;
  Labelling labelling;
};
TrackedTake TrackTake(const RenderedTake& take, const CameraArray& array, const std::string& map);

// Rendered pictures of a board go through CalibrateMirror().
CameraArray CalibrateFromBoards(const SyntheticCameras& cameras, int num_pictures);

}  // namespace articap
