// SPDX-License-Identifier: MIT
#include "calib/planar_pose.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "calib/network.h"

namespace articap {
namespace {

std::vector<cv::Point3d> CornersInBoard(const BoardSpec& board, const std::vector<int>& corners) {
  std::vector<cv::Point3d> points;
  for (int corner : corners) {
    const Eigen::Vector3d in_board = board.corner_in_board_mm(corner);
    points.emplace_back(in_board.x(), in_board.y(), 0);
  }
  return points;
}

Rigid3d ToRigid(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  const Eigen::Vector3d w(rotation_vector.ptr<double>());
  const double angle = w.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(w / angle) : Eigen::Vector3d::UnitX();
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)),
          Eigen::Vector3d(translation.ptr<double>())};
}

// A lens that is only roughly known may fold the picture over before its edges: most of a board
// does.
bool IsEnough(std::size_t shown, std::size_t corners) {
  constexpr std::size_t kFewest = 4;
  return shown >= kFewest && 2 * shown >= corners;
}

bool IsAhead(const BoardSpec& board, const std::vector<int>& corners, const Rigid3d& pose) {
  return std::all_of(corners.begin(), corners.end(),
                     [&](int corner) { return (pose * board.corner_in_board_mm(corner)).z() > 0; });
}

}  // namespace

double RmsOfPose_px(const BoardSpec& board, const Lens& lens, const std::vector<int>& corners,
                    const std::vector<Eigen::Vector2d>& points_px, const Rigid3d& cam_from_board) {
  double sum = 0;
  std::size_t shown = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (const auto expected =
            Project(lens, cam_from_board * board.corner_in_board_mm(corners[i]))) {
      sum += (*expected - points_px[i]).squaredNorm();
      ++shown;
    }
  return IsEnough(shown, corners.size()) ? std::sqrt(sum / static_cast<double>(shown)) : HUGE_VAL;
}

std::vector<PlanarPose> PlanarPosesOf(const BoardSpec& board, const Lens& lens,
                                      const std::vector<int>& corners,
                                      const std::vector<Eigen::Vector2d>& points_px) {
  std::vector<cv::Point2d> in_plane;
  std::vector<int> shown;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!points_px[i].allFinite()) return {};
    const auto direction = Unproject(lens, points_px[i]);
    if (!direction) continue;
    in_plane.emplace_back(direction->x(), direction->y());
    shown.push_back(corners[i]);
  }
  if (!IsEnough(shown.size(), corners.size())) return {};
  const std::vector<cv::Point3d> in_board = CornersInBoard(board, shown);
  const cv::Mat ideal = cv::Mat::eye(3, 3, CV_64F);
  std::vector<cv::Mat> rotations, translations;
  std::vector<PlanarPose> poses;
  try {
    cv::solvePnPGeneric(in_board, in_plane, ideal, {}, rotations, translations, false,
                        cv::SOLVEPNP_IPPE);
    for (std::size_t i = 0; i < rotations.size(); ++i)
      cv::solvePnPRefineLM(in_board, in_plane, ideal, {}, rotations[i], translations[i]);
  } catch (const cv::Exception&) {
    return {};  // corners on a line
  }
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Rigid3d pose = ToRigid(rotations[i], translations[i]);
    const double rms_px = RmsOfPose_px(board, lens, corners, points_px, pose);
    if (IsAhead(board, corners, pose) && std::isfinite(rms_px)) poses.push_back({pose, rms_px});
  }
  std::sort(poses.begin(), poses.end(),
            [](const PlanarPose& a, const PlanarPose& b) { return a.rms_px < b.rms_px; });
  return poses;
}

std::optional<double> FocalLengthOf_px(const BoardSpec& board, const std::vector<PlaneView>& views,
                                       const Eigen::Vector2d& principal_point_px) {
  // Of each homography H = [h1 h2 h3], with the principal point at the origin and w = 1 / f^2:
  //   w (h1x h2x + h1y h2y) + h1z h2z = 0,
  //   w (h1x^2 + h1y^2 - h2x^2 - h2y^2) + h1z^2 - h2z^2 = 0,
  // weighted alike by scaling h1 and h2 to unit length in pixels.
  double above = 0, below = 0;
  for (const PlaneView& view : views) {
    std::vector<cv::Point2d> in_picture, in_board;
    for (std::size_t i = 0; i < view.corners->size(); ++i) {
      const Eigen::Vector3d corner = board.corner_in_board_mm((*view.corners)[i]);
      const Eigen::Vector2d point = (*view.points_px)[i] - principal_point_px;
      in_board.emplace_back(corner.x(), corner.y());
      in_picture.emplace_back(point.x(), point.y());
    }
    constexpr std::size_t kFewestCorners = 4;  // of a homography
    if (in_board.size() < kFewestCorners) continue;
    const cv::Mat found = cv::findHomography(in_board, in_picture);
    if (found.empty()) continue;
    Eigen::Matrix3d h =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(found.ptr<double>());
    h /= h.leftCols<2>().topRows<2>().norm();
    const Eigen::Vector3d h1 = h.col(0), h2 = h.col(1);
    const Eigen::Vector2d of_w{h1.head<2>().dot(h2.head<2>()),
                               h1.head<2>().squaredNorm() - h2.head<2>().squaredNorm()};
    const Eigen::Vector2d alone{h1.z() * h2.z(), h1.z() * h1.z() - h2.z() * h2.z()};
    above -= of_w.dot(alone);
    below += of_w.squaredNorm();
  }
  const double w = above / below;
  if (!(w > 0) || !std::isfinite(w)) return std::nullopt;
  return 1 / std::sqrt(w);
}

}  // namespace articap
