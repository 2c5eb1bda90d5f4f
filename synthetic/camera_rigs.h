// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/result.h"
#include "render/scene.h"
#include "render/view_camera.h"

namespace articap {

// What core's Mirror does not say: where in its plane a mirror begins and ends.
struct MirrorOutline {
  Eigen::Vector3d center_in_stage_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d up_in_stage = Eigen::Vector3d::UnitY();
  double width_mm = 200;
  double height_mm = 200;
  double frame_mm = 8;
};

// Cameras and mirrors as they truly are. The stage frame is that of a speaker who looks ahead:
// origin in the middle of the head, x to the speaker's left, y up, z forward.
struct SyntheticCameras {
  CameraArray array;
  std::vector<MirrorOutline> outlines;  // of array.mirrors, one each

  std::vector<RenderMirror> RenderMirrors() const;
};

// Of a camera that stands and looks as told, upright.
Rigid3d CamFromStage(const LookAt& look_at_in_stage);

struct CameraModel {
  int width = 1280;
  int height = 720;
  double focal_px = 1800;  // the mean; each camera is up to 2 % off, with a lens of its own
};

// Cameras on an arc of 100 degrees before the speaker, in turns a little above and below, 800 mm
// from the head and looking at its middle.
SyntheticCameras RingOfCameras(int num_cameras, std::uint64_t seed, const CameraModel& model = {});

// One camera 700 mm before the speaker and a mirror at 45 degrees beside the left cheek, which
// shows the face in profile (Rademan and Niesler's set-up). glass_mm: of a second-surface mirror.
SyntheticCameras MirrorSetUp(double glass_mm, std::uint64_t seed, const CameraModel& model = {});

// The same with a second mirror beside the right cheek, and the camera 850 mm straight before the
// face.
SyntheticCameras TwoMirrorSetUp(double glass_mm, std::uint64_t seed, const CameraModel& model = {});

// By name: "mirror", "two-mirrors", or "ring4" for a ring of so many cameras, 1 to 16.
Result<SyntheticCameras> CamerasByName(const std::string& name, double glass_mm, std::uint64_t seed,
                                       const CameraModel& model);

}  // namespace articap
