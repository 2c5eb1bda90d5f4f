// SPDX-License-Identifier: MIT
#include "calib/gray_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/opencv_picture.h"
#include "core/check.h"

namespace articap {
namespace {

// The image's memory as OpenCV sees it; only read.
cv::Mat MatOf(const ImageView& image) {
  const int type = image.format == PixelFormat::kGray8    ? CV_8UC1
                   : image.format == PixelFormat::kGray16 ? CV_16UC1
                                                          : CV_8UC3;
  return {image.height, image.width, type, const_cast<std::uint8_t*>(image.data),
          static_cast<std::size_t>(image.stride_bytes)};
}

GrayPicture EmptyPicture(int width, int height) {
  return {width, height, std::vector<float>(static_cast<std::size_t>(width) * height)};
}

}  // namespace

cv::Mat MatOf(GrayPicture& picture) {
  return {picture.height, picture.width, CV_32FC1, picture.pixels.data()};
}

cv::Mat EightBitsOf(const GrayPicture& picture) {
  const cv::Mat gray(picture.height, picture.width, CV_32FC1,
                     const_cast<float*>(picture.pixels.data()));
  double darkest = 0, brightest = 0;
  cv::minMaxLoc(gray, &darkest, &brightest);
  const double scale = 255 / std::max(brightest - darkest, 1e-6);
  cv::Mat eight_bits;
  gray.convertTo(eight_bits, CV_8U, scale, -darkest * scale);
  return eight_bits;
}

double GrayPicture::At(const Eigen::Vector2d& point_px) const {
  ARTICAP_CHECK(Contains(point_px));
  const int x0 = std::min(static_cast<int>(point_px.x()), std::max(width - 2, 0));
  const int y0 = std::min(static_cast<int>(point_px.y()), std::max(height - 2, 0));
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const double fx = point_px.x() - x0, fy = point_px.y() - y0;
  const double upper = (1 - fx) * at(x0, y0) + fx * at(x1, y0);
  const double lower = (1 - fx) * at(x0, y1) + fx * at(x1, y1);
  return (1 - fy) * upper + fy * lower;
}

Eigen::Vector2i PictureSize(const ImageView& image, const PictureFromImage& picture_from_image) {
  return {static_cast<int>(std::lround(picture_from_image.scale.x() * image.width)),
          static_cast<int>(std::lround(picture_from_image.scale.y() * image.height))};
}

GrayPicture GrayPictureOf(const ImageView& image, const PictureFromImage& picture_from_image) {
  cv::Mat gray = MatOf(image);
  if (image.format == PixelFormat::kRgb8) cv::cvtColor(gray, gray, cv::COLOR_RGB2GRAY);
  GrayPicture own = EmptyPicture(image.width, image.height);
  cv::Mat own_mat = MatOf(own);
  gray.convertTo(own_mat, CV_32F, image.format == PixelFormat::kGray16 ? 1.0 / 65535 : 1.0 / 255);
  if (picture_from_image.is_identity()) return own;

  const Eigen::Vector2d& scale = picture_from_image.scale;
  const Eigen::Vector2d& offset_px = picture_from_image.offset_px;
  const Eigen::Vector2i size = PictureSize(image, picture_from_image);
  GrayPicture picture = EmptyPicture(size.x(), size.y());
  cv::Mat picture_mat = MatOf(picture);
  const cv::Mat picture_from_own =
      (cv::Mat_<double>(2, 3) << scale.x(), 0, offset_px.x(), 0, scale.y(), offset_px.y());
  cv::warpAffine(own_mat, picture_mat, picture_from_own, picture_mat.size(), cv::INTER_CUBIC,
                 cv::BORDER_REPLICATE);
  return picture;
}

GrayPicture Reversed(const GrayPicture& picture) {
  GrayPicture reversed = picture;
  for (int y = 0; y < picture.height; ++y) {
    const auto row = reversed.pixels.begin() + static_cast<std::ptrdiff_t>(y) * picture.width;
    std::reverse(row, row + picture.width);
  }
  return reversed;
}

}  // namespace articap
