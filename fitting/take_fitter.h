// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/tracks.h"
#include "core/virtual_marker.h"
#include "fitting/fit.h"
#include "fitting/frame_fits.h"
#include "fitting/smoothing.h"
#include "rig/face_rig.h"

namespace articap {

// The markers of one take, fitted as often as their places on the rig change.
class TakeFitter {
 public:
  // Everything must outlive the fitter. `rig` with the speaker's identity; `reference` is where
  // undetermined parameters are held.
  TakeFitter(const FaceRig& rig, const Eigen::VectorXd& reference, const RigTracks& measured,
             double rig_scale, const FitOptions& options);

  struct Pass {
    FrameFits fits;
    std::vector<bool> determined;
    Eigen::VectorXd sigmas;  // of each parameter were all of them free
    Smoothing smoothing;
  };

  // Frame by frame, then with the smoothness prior where `smooth` and the options ask for it.
  Pass Run(const std::vector<VirtualMarker>& markers, bool smooth,
           const std::function<void(double part)>& progress) const;

  // Poses and places in turn, from the markers as they were bound.
  std::vector<VirtualMarker> Refine(const std::vector<VirtualMarker>& bound) const;

 private:
  const FaceRig& rig_;
  const Eigen::VectorXd& reference_;
  const RigTracks& measured_;
  const FitOptions& options_;
  double marker_sigma_mm_;         // mm of the rig
  Eigen::VectorXd ranges_;         // of the parameters
  Eigen::VectorXd lower_, upper_;  // within which they are fitted
};

}  // namespace articap
