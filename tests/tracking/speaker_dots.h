// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/dots.h"
#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "synthetic/camera_rigs.h"
#include "tracking/label.h"
#include "tracking/reconstruct.h"

namespace articap {

// What cameras see of the synthetic speaker, as dots: no pixels, but everything that pixels leave
// to those who come after.
struct SpeakerDotsOptions {
  SyntheticCameras cameras;
  std::string map = "spectacles30";
  double rate_hz = 60;
  int num_frames = 240;
  double turn_deg = 20;          // the head turns from left to right and back, in 2.5 s
  double noise_px = 0.03;        // of a dot's centre, a coordinate
  double dropout = 0.1;          // part of the dots that are not found, each by itself
  int ghosts = 2;                // false dots in every picture
  double most_oblique_deg = 70;  // a marker is seen up to here between its normal and the ray
  std::uint64_t seed = 1;
};

struct SpeakerDots {
  SyntheticCameras cameras;
  double rate_hz = 0;
  std::vector<std::string> names;
  std::vector<std::vector<Eigen::Vector3d>> positions_mm;  // by frame and marker, stage
  std::vector<std::vector<std::vector<Dot>>> dots;         // by frame and camera
  std::vector<std::vector<std::vector<int>>> owners;       // the same: marker, or -1

  int num_frames() const { return static_cast<int>(positions_mm.size()); }
  // Of a frame: in how many views each marker has a dot.
  std::vector<int> NumSights(int frame) const;
  // The marker that all sights of a point are of; -1 where there is none.
  int OwnerOf(int frame, const CloudPoint& point) const;
  // Whether a sight of the point is another marker's.
  bool HasOther(int frame, const CloudPoint& point, int marker) const;
};

SpeakerDots MakeSpeakerDots(const SpeakerDotsOptions& options);

// The place of every marker in a frame, to learn labels from.
MarkerTemplate TemplateOf(const SpeakerDots& scene, int frame);

PointClouds CloudsOf(const SpeakerDots& scene, const ReconstructOptions& options = {});

struct LabelScore {
  int seen = 0;          // samples of which a view has a dot
  int labelled = 0;      // samples that have a label
  int right = 0;         // of these: all sights are the marker's own
  int longest_swap = 0;  // frames for which a label had another marker's dot
  int measured = 0;      // of the right ones: by two views or more
  double rms_mm = 0;     // of those, a coordinate
  double worst_mm = 0;
};
LabelScore ScoreOf(const SpeakerDots& scene, const PointClouds& clouds, const Labelling& labelling);

}  // namespace articap
