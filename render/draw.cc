// SPDX-License-Identifier: MIT
#include "render/draw.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "render/label.h"

namespace articap {
namespace {

// Paints what lies within `width_px` / 2 of a shape, given the distance of a point from it, inside
// the box from `low` to `high`.
template <class Distance>
void Stroke(Picture& picture, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
            double width_px, const Eigen::Vector3f& linear_color, const Distance& distance_px) {
  const double reach_px = width_px / 2 + 1;
  const auto first = [&](double at) {
    return std::max(0, static_cast<int>(std::floor(at - reach_px)));
  };
  const auto end = [&](double at, int size) {
    return std::min(size, static_cast<int>(std::ceil(at + reach_px)) + 1);
  };
  const float color[3] = {static_cast<float>(SrgbByte(linear_color[0])),
                          static_cast<float>(SrgbByte(linear_color[1])),
                          static_cast<float>(SrgbByte(linear_color[2]))};
  for (int y = first(low.y()); y < end(high.y(), picture.height); ++y)
    for (int x = first(low.x()); x < end(high.x(), picture.width); ++x) {
      const auto share = static_cast<float>(
          std::clamp(width_px / 2 + 0.5 - distance_px(Eigen::Vector2d(x, y)), 0.0, 1.0));
      std::uint8_t* const pixel = picture.pixel(x, y);
      for (int channel = 0; channel < 3; ++channel)
        pixel[channel] = static_cast<std::uint8_t>(
            std::lround(share * color[channel] + (1 - share) * static_cast<float>(pixel[channel])));
    }
}

bool IsDrawable(const Eigen::Vector2d& point_px) {
  constexpr double kFarthest_px = 1e6;  // beyond, pixels are no longer whole numbers
  return point_px.allFinite() && point_px.cwiseAbs().maxCoeff() < kFarthest_px;
}

}  // namespace

void DrawLine(Picture& picture, const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
              double width_px, const Eigen::Vector3f& linear_color) {
  if (!IsDrawable(from_px) || !IsDrawable(to_px)) return;
  const Eigen::Vector2d along = to_px - from_px;
  Stroke(picture, from_px.cwiseMin(to_px), from_px.cwiseMax(to_px), width_px, linear_color,
         [&](const Eigen::Vector2d& point) {
           const double part = std::clamp(
               (point - from_px).dot(along) / std::max(1e-12, along.squaredNorm()), 0.0, 1.0);
           return (point - from_px - part * along).norm();
         });
}

void DrawRing(Picture& picture, const Eigen::Vector2d& center_px, double radius_px, double width_px,
              const Eigen::Vector3f& linear_color) {
  if (!IsDrawable(center_px)) return;
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius_px);
  Stroke(picture, center_px - reach, center_px + reach, width_px, linear_color,
         [&](const Eigen::Vector2d& point) {
           return std::abs((point - center_px).norm() - radius_px);
         });
}

void DrawCross(Picture& picture, const Eigen::Vector2d& center_px, double radius_px,
               double width_px, const Eigen::Vector3f& linear_color) {
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector2d arm = radius_px / std::sqrt(2.0) * Eigen::Vector2d(1, side);
    DrawLine(picture, center_px - arm, center_px + arm, width_px, linear_color);
  }
}

void DrawEdgedText(Picture& picture, std::string_view text, int x, int y, int scale,
                   const Eigen::Vector3f& linear_color) {
  for (const int dx : {-1, 0, 1})
    for (const int dy : {-1, 0, 1})
      DrawText(picture, text, x + dx, y + dy, scale, Eigen::Vector3f::Zero());
  DrawText(picture, text, x, y, scale, linear_color);
}

Picture Enlarged(const Picture& picture, int zoom) {
  ARTICAP_CHECK_GT(zoom, 0);
  Picture enlarged;
  enlarged.width = picture.width * zoom;
  enlarged.height = picture.height * zoom;
  enlarged.rgb8.resize(picture.rgb8.size() * static_cast<std::size_t>(zoom) * zoom);
  for (int row = 0; row < enlarged.height; ++row)
    for (int x = 0; x < picture.width; ++x)
      for (int column = x * zoom; column < (x + 1) * zoom; ++column)
        std::copy_n(picture.pixel(x, row / zoom), 3, enlarged.pixel(column, row));
  return enlarged;
}

void Paste(Picture& picture, const Picture& part, int left, int top) {
  const int first_x = std::max(0, -left), end_x = std::min(part.width, picture.width - left);
  if (end_x <= first_x) return;
  for (int y = std::max(0, -top); y < std::min(part.height, picture.height - top); ++y)
    std::copy_n(part.pixel(first_x, y), 3 * static_cast<std::size_t>(end_x - first_x),
                picture.pixel(left + first_x, top + y));
}

}  // namespace articap
