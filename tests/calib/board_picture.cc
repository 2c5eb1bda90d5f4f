// SPDX-License-Identifier: MIT
#include "tests/calib/board_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "calib/board_pattern.h"
#include "synthetic/random.h"
#include "tests/support/result.h"

namespace articap {
namespace {

// The ink of a board, found by square.
class Print {
 public:
  explicit Print(const BoardSpec& board)
      : board_(board), pattern_(OrThrow(PatternOf(board))), rectangles_(Columns() * Rows()) {
    for (const BoardRectangle& dark : pattern_.dark)
      rectangles_[SquareOf((dark.min_mm + dark.max_mm) / 2)].push_back(dark);
  }

  bool IsPaper(const Eigen::Vector2d& board_mm) const { return IsIn(pattern_.paper, board_mm); }
  bool IsDark(const Eigen::Vector2d& board_mm) const {
    const std::vector<BoardRectangle>& near = rectangles_[SquareOf(board_mm)];
    return std::any_of(near.begin(), near.end(),
                       [&](const BoardRectangle& dark) { return IsIn(dark, board_mm); });
  }

 private:
  // The squares, and the margin around them.
  std::size_t Columns() const { return board_.square_columns() + 2; }
  std::size_t Rows() const { return board_.square_rows() + 2; }
  std::size_t SquareOf(const Eigen::Vector2d& board_mm) const {
    const auto index = [&](double along_mm, std::size_t count) {
      return static_cast<std::size_t>(std::clamp(std::floor(along_mm / board_.square_mm) + 2, 0.0,
                                                 static_cast<double>(count - 1)));
    };
    return index(board_mm.y(), Rows()) * Columns() + index(board_mm.x(), Columns());
  }
  static bool IsIn(const BoardRectangle& rectangle, const Eigen::Vector2d& point_mm) {
    return (point_mm.array() >= rectangle.min_mm.array()).all() &&
           (point_mm.array() < rectangle.max_mm.array()).all();
  }

  BoardSpec board_;
  BoardPattern pattern_;
  std::vector<std::vector<BoardRectangle>> rectangles_;
};

Eigen::Vector2d MiddleOf(const BoardSpec& board) {
  return 0.5 * board.square_mm *
         Eigen::Vector2d(board.corner_columns() - 1, board.corner_rows() - 1);
}

// Board coordinates that each pixel corner looks at; the lens hardly bends within a pixel.
std::vector<Eigen::Vector2d> BoardCoordinates(const BoardSpec& board, const BoardPose& pose,
                                              const BoardPictureOptions& options) {
  const Eigen::Vector3d normal = pose.x_axis.cross(pose.y_axis);
  std::vector<Eigen::Vector2d> coordinates;
  for (int y = 0; y <= options.height; ++y)
    for (int x = 0; x <= options.width; ++x) {
      const Eigen::Vector3d ray =
          Unproject(options.lens, {x - 0.5, y - 0.5}).value_or(Eigen::Vector3d(1e9, 0, 1));
      const Eigen::Vector3d point =
          ray * (normal.dot(pose.middle_mm) / normal.dot(ray)) - pose.middle_mm;
      coordinates.push_back(Eigen::Vector2d(pose.x_axis.dot(point), pose.y_axis.dot(point)) +
                            MiddleOf(board));
    }
  return coordinates;
}

// 64 points of a pixel, each in a column and a row of its own (a rank-1 lattice): on a square grid
// of as many points upright edges would be off by up to 1/16 px.
std::vector<Eigen::Vector2d> SamplesOfPixel() {
  constexpr int kSamples = 64, kStep = 19;
  std::vector<Eigen::Vector2d> samples;
  for (int i = 0; i < kSamples; ++i)
    samples.emplace_back((i + 0.5) / kSamples, (i * kStep % kSamples + 0.5) / kSamples);
  return samples;
}

void Paint(cv::Mat& light, const Print& print, const std::vector<Eigen::Vector2d>& corners,
           const BoardPictureOptions& options) {
  static const std::vector<Eigen::Vector2d> samples = SamplesOfPixel();
  const std::size_t stride = options.width + 1;
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x) {
      const Eigen::Vector2d* corner = &corners[y * stride + x];
      if (!print.IsPaper(corner[0]) && !print.IsPaper(corner[stride + 1])) continue;
      double sum = 0;
      for (const Eigen::Vector2d& sample : samples) {
        const double u = sample.x(), v = sample.y();
        const Eigen::Vector2d point = (1 - v) * ((1 - u) * corner[0] + u * corner[1]) +
                                      v * ((1 - u) * corner[stride] + u * corner[stride + 1]);
        const bool is_paper = print.IsPaper(point);
        sum += !is_paper             ? light.at<float>(y, x)
               : print.IsDark(point) ? options.black
                                     : options.white;
      }
      light.at<float>(y, x) = static_cast<float>(sum / static_cast<double>(samples.size()));
    }
}

Image Exposed(const cv::Mat& light, const BoardPictureOptions& options) {
  RandomGenerator random(options.seed, 0);
  Image image(options.quantized ? PixelFormat::kGray8 : PixelFormat::kGray16, options.width,
              options.height);
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x) {
      const double lamp = options.exposure * (1 - options.falloff * x / options.width);
      const double noise = options.noise > 0 ? options.noise * random.Normal() : 0;
      const double level = std::clamp(lamp * light.at<float>(y, x) + noise, 0.0, 1.0);
      if (options.quantized)
        image.row(y)[x] = static_cast<std::uint8_t>(std::lround(255 * level));
      else
        reinterpret_cast<std::uint16_t*>(image.row(y))[x] =
            static_cast<std::uint16_t>(std::lround(65535 * level));
    }
  return image;
}

}  // namespace

BoardPose BoardPose::Turned(double pitch_rad, double yaw_rad, double roll_rad) {
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  BoardPose pose;
  pose.x_axis = turn.col(0);
  pose.y_axis = turn.col(1);
  return pose;
}

BoardPose BoardPose::Reversed() const {
  BoardPose reversed = *this;
  reversed.x_axis = -x_axis;
  return reversed;
}

Eigen::Vector3d BoardPose::InCamera(const BoardSpec& board, const Eigen::Vector2d& board_mm) const {
  const Eigen::Vector2d from_middle = board_mm - MiddleOf(board);
  return middle_mm + from_middle.x() * x_axis + from_middle.y() * y_axis;
}

Image PictureOf(const BoardSpec& board, const std::vector<BoardPose>& poses,
                const BoardPictureOptions& options) {
  const Print print(board);
  cv::Mat light(options.height, options.width, CV_32FC1, cv::Scalar::all(options.ground));
  for (const BoardPose& pose : poses)
    Paint(light, print, BoardCoordinates(board, pose, options), options);
  if (options.blur_px > 0)
    cv::GaussianBlur(light, light, {}, options.blur_px, options.blur_px, cv::BORDER_REPLICATE);
  return Exposed(light, options);
}

Image PictureOf(const BoardSpec& board, const BoardPose& pose, const BoardPictureOptions& options) {
  return PictureOf(board, std::vector<BoardPose>{pose}, options);
}

std::vector<Eigen::Vector2d> TrueCorners(const BoardSpec& board, const BoardPose& pose,
                                         const BoardPictureOptions& options) {
  std::vector<Eigen::Vector2d> corners;
  for (int corner = 0; corner < board.num_corners(); ++corner) {
    const Eigen::Vector3d point = pose.InCamera(board, board.corner_in_board_mm(corner).head<2>());
    corners.push_back(
        Project(options.lens, point).value_or(Eigen::Vector2d::Constant(std::nan(""))));
  }
  return corners;
}

}  // namespace articap
