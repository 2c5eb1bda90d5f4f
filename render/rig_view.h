// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "render/render.h"
#include "rig/face_rig.h"

namespace articap {

struct RigViewOptions {
  bool show_spectacles = true;  // the part "spectacles", where the rig has one
  bool show_landmarks = false;  // a red dot at every landmark
  double landmark_radius_mm = 1.2;
  std::vector<RenderSphere> markers = {};  // measured or virtual markers, mm, rig frame
};

// A pose of the rig, lit for a portrait; each part has smooth normals of its own.
Scene SceneOf(const FaceRig& rig, const Eigen::VectorXd& parameters,
              const RigViewOptions& options = {});
// The same of a pose whose vertices are known, in whatever frame these are.
Scene SceneOf(const FaceRig& rig, const std::vector<Eigen::Vector3d>& posed_mm,
              const RigViewOptions& options = {});

// How a part of a rig shines, by its name; skin where the name is not known.
Material MaterialOfPart(std::string_view part_name);

enum class FaceView { kFront, kThreeQuarter, kSide };

// The whole neutral head fills the picture. Three quarters and side show the speaker's left.
PinholeView HeadCamera(const FaceRig& rig, FaceView view, int width, int height);

// The same from any side: yaw about y, positive to the speaker's left; pitch, positive from above.
PinholeView HeadCamera(const FaceRig& rig, double yaw_rad, double pitch_rad, int width, int height);

// The lower face, from the nose to below the chin, framed by the landmarks; the whole head where
// the rig lacks the landmarks nose_tip and menton.
PinholeView MouthCamera(const FaceRig& rig, double yaw_rad, double pitch_rad, int width,
                        int height);

}  // namespace articap
