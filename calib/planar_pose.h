// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/board.h"
#include "core/camera.h"

namespace articap {

// Where a board may be that was seen so. A plane has up to two poses that explain its picture
// nearly as well; which one is right, other views tell.
struct PlanarPose {
  Rigid3d cam_from_board;
  double rms_px = 0;
};

// The poses, the better one first; none where the corners do not determine any. Corners that the
// lens, as it is, shows nowhere are passed over, as long as they are not the most.
// T. Collins, A. Bartoli, "Infinitesimal plane-based pose estimation", IJCV 109, 2014; each then
// refined by least squares on the pixels.
std::vector<PlanarPose> PlanarPosesOf(const BoardSpec& board, const Lens& lens,
                                      const std::vector<int>& corners,
                                      const std::vector<Eigen::Vector2d>& points_px);

// Root mean square of the distances, px, of corners to where a pose of the board shows them, of
// those that it shows; infinite where it shows less than half of them.
double RmsOfPose_px(const BoardSpec& board, const Lens& lens, const std::vector<int>& corners,
                    const std::vector<Eigen::Vector2d>& points_px, const Rigid3d& cam_from_board);

// The focal length of pictures of a plane, fx = fy, without distortion, the principal point given;
// nothing where all views are too parallel to the picture to tell.
// Z. Zhang, "A flexible new technique for camera calibration", PAMI 22(11), 2000.
struct PlaneView {
  const std::vector<int>* corners = nullptr;
  const std::vector<Eigen::Vector2d>* points_px = nullptr;
};
std::optional<double> FocalLengthOf_px(const BoardSpec& board, const std::vector<PlaneView>& views,
                                       const Eigen::Vector2d& principal_point_px);

}  // namespace articap
