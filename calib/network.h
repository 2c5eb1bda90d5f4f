// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/board.h"
#include "core/camera.h"

namespace articap {

// A sighting of a board within a network.
struct NetworkSighting {
  View view;
  int placement = 0;  // which pose of the board
  double time_s = 0;  // of the picture, by its camera's clock
  int input = 0;      // index of the sighting it was made from, in the caller's list
  std::vector<int> corners;
  std::vector<Eigen::Vector2d> points_px;
};

// Where the board was at an instant.
struct Placement {
  Rigid3d stage_from_board;
  double time_s = 0;  // on the clock of the array
};

// Cameras and mirrors that saw a board in many places: what bundle adjustment adjusts.
struct Network {
  BoardSpec board;
  CameraArray array;
  std::vector<Placement> placements;
  std::vector<NetworkSighting> sightings;
  // The placements are one path in time, and each picture shows the board where it was at the
  // picture's own time: placement times, picture times and time offsets count.
  bool moving = false;
};

// Which parameters of a lens are estimated; the others keep their values.
struct LensFreedom {
  bool focal = false;
  bool aspect = false;
  bool principal_point = false;
  std::array<bool, Lens::kNumDistortion> distortion{};

  bool any() const;
};

struct AdjustOptions {
  // One a camera. The first camera's pose is always held: it is the gauge.
  std::vector<LensFreedom> lenses;
  // Of all cameras but the first, in a moving network.
  bool free_time_offsets = false;
  // The noise of each view (CameraArray::views()) over the usual one: its residuals count the less.
  // Empty: all alike.
  std::vector<double> relative_noise;
  // Huber's loss from here on, px of a view of the usual noise; 0: plain least squares.
  double huber_px = 0;
  int max_iterations = 100;
};

// A parameter of the cameras in the order of AdjustedNetwork::covariance.
struct CameraParameter {
  enum class Kind {
    kFocal,
    kAspect,
    kPrincipalX,
    kPrincipalY,
    kDistortion,
    kRotation,
    kTranslation,
    kMirror,
    kTimeOffset
  };
  Kind kind = Kind::kFocal;
  int index = 0;      // of the camera; of the mirror for kMirror
  int component = 0;  // of the distortion, of an axis

  bool operator==(const CameraParameter&) const = default;
};

struct AdjustedNetwork {
  Network network;
  bool converged = false;
  std::string solver_message;
  int iterations = 0;
  // seen - expected, px; one list a sighting, one entry a corner.
  std::vector<std::vector<Eigen::Vector2d>> residuals_px;
  // Standard deviation of one coordinate of a corner, without outliers (HuberSums): of all views
  // together, and of each (calib/view_noise.h). NaN where there are no degrees of freedom.
  double sigma_px = 0;
  std::vector<double> noise_px;
  int degrees_of_freedom = 0;
  // Of the cameras' free parameters, everything else being free too. Rotations are about the
  // camera's axes (exp(w) R), mirrors by the foot of the perpendicular in the camera frame.
  std::vector<CameraParameter> parameters;
  Eigen::MatrixXd covariance;

  double rms_px() const;  // over all corners, of the distance
};

// The root mean square of distances, list by list; NaN of none.
class DistanceRms {
 public:
  void Add(std::span<const Eigen::Vector2d> residuals_px);
  double px() const;

 private:
  double squares_px2_ = 0;
  std::size_t count_ = 0;
};

double RmsOf(std::span<const Eigen::Vector2d> residuals_px);

// Bundle adjustment: lenses, camera poses, mirrors, time offsets and the board's placements that
// together minimise the squared distances between where corners were seen and where they should
// be, over the noise of their views. The sigmas of cameras and mirrors in the network are filled
// in.
// Triggs et al., "Bundle adjustment - a modern synthesis", 1999.
AdjustedNetwork Adjust(const Network& network, const AdjustOptions& options);

// The part of Adjust() that needs no iterations: the residuals of a network as it stands.
std::vector<std::vector<Eigen::Vector2d>> ResidualsOf(const Network& network);

}  // namespace articap
