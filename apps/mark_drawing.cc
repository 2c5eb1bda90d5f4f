// SPDX-License-Identifier: MIT
#include "apps/mark_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "render/draw.h"
#include "render/label.h"

namespace articap {
namespace {

const Eigen::Vector3f kNamed(0.08F, 0.55F, 1.0F);
const Eigen::Vector3f kHighlighted(1.0F, 0.30F, 0.0F);
const Eigen::Vector3f kHidden(1.0F, 0.15F, 0.75F);
const Eigen::Vector3f kSpare = Eigen::Vector3f::Constant(0.25F);
constexpr int kGlyphHeight = 7;

struct Box {
  double left, top, right, bottom;

  double OverlapWith(const Box& other) const {
    return std::max(0.0, std::min(right, other.right) - std::max(left, other.left)) *
           std::max(0.0, std::min(bottom, other.bottom) - std::max(top, other.top));
  }
};

// Finds free places for names.
class NamePlaces {
 public:
  NamePlaces(int width, int height) : width_(width), height_(height) {}

  void Occupy(const Box& box) { taken_.push_back(box); }

  // Beside the point, as near as there is room; the place that hides least where there is none.
  Box PlaceFor(const Eigen::Vector2d& point, double off_px, double wide, double tall) {
    Box best{};
    double least = std::numeric_limits<double>::infinity();
    for (const double reach : {1.0, 2.0, 3.5, 5.5}) {
      for (const auto& [x, y] : kDirections) {
        const Box box = Beside(point, off_px + (reach - 1) * tall, x, y, wide, tall);
        const double cost = CostOf(box) + 0.02 * reach * wide * tall;
        if (cost >= least) continue;
        least = cost;
        best = box;
      }
      if (least < 0.1 * wide * tall) break;
    }
    Occupy(best);
    return best;
  }

 private:
  static constexpr std::array<std::pair<int, int>, 8> kDirections = {
      {{1, 0}, {-1, 0}, {1, -1}, {1, 1}, {-1, -1}, {-1, 1}, {0, -1}, {0, 1}}};

  static Box Beside(const Eigen::Vector2d& point, double off_px, int x, int y, double wide,
                    double tall) {
    const double left = x > 0   ? point.x() + off_px
                        : x < 0 ? point.x() - off_px - wide
                                : point.x() - wide / 2;
    const double top = y > 0   ? point.y() + off_px
                       : y < 0 ? point.y() - off_px - tall
                               : point.y() - tall / 2;
    return {left, top, left + wide, top + tall};
  }

  double CostOf(const Box& box) const {
    double cost = 0;
    for (const Box& other : taken_) cost += box.OverlapWith(other);
    const double whole = (box.right - box.left) * (box.bottom - box.top);
    const Box picture{0, 0, static_cast<double>(width_), static_cast<double>(height_)};
    return cost + 2 * (whole - box.OverlapWith(picture));
  }

  int width_, height_;
  std::vector<Box> taken_;
};

// How one marker is drawn.
struct Shown {
  const MarkerMark* mark;
  Eigen::Vector2d at_px;  // in the picture that is drawn on
  double radius_px;
  Eigen::Vector3f color;
  bool is_highlighted;
};

bool IsIn(const Picture& picture, const Eigen::Vector2d& point) {
  return point.x() >= 0 && point.y() >= 0 && point.x() < picture.width &&
         point.y() < picture.height;
}

double RingRadius_px(double diameter_px, const Magnification& shown) {
  constexpr double kAround_px = 2;
  return shown.zoom * diameter_px / 2 + kAround_px;
}

std::vector<Shown> MarksIn(const FrameMarks& marks, int camera, const Magnification& shown,
                           const MarkStyle& style, const Picture& picture) {
  constexpr double kCrossRadius_px = 5;
  std::vector<Shown> chosen;
  for (const MarkerMark& mark : marks.markers) {
    if (mark.view.camera != camera) continue;
    const Eigen::Vector2d at_px = shown(mark.dot_px.value_or(mark.place_px));
    if (!IsIn(picture, at_px)) continue;
    const bool is_highlighted = std::find(style.highlighted.begin(), style.highlighted.end(),
                                          mark.marker) != style.highlighted.end();
    chosen.push_back({&mark, at_px,
                      mark.dot_px ? RingRadius_px(mark.diameter_px, shown) : kCrossRadius_px,
                      is_highlighted ? kHighlighted
                      : mark.dot_px  ? kNamed
                                     : kHidden,
                      is_highlighted});
  }
  // Those that matter find the best places for their names.
  std::stable_sort(chosen.begin(), chosen.end(), [](const Shown& a, const Shown& b) {
    return a.is_highlighted && !b.is_highlighted;
  });
  return chosen;
}

void DrawName(const Shown& shown, const std::string& name, int scale, NamePlaces& places,
              Picture& picture) {
  const double wide = TextWidth(name, scale) + 2, tall = kGlyphHeight * scale + 2;
  const Box box = places.PlaceFor(shown.at_px, shown.radius_px + 2, wide, tall);
  const Eigen::Vector2d nearest(std::clamp(shown.at_px.x(), box.left, box.right),
                                std::clamp(shown.at_px.y(), box.top, box.bottom));
  const Eigen::Vector2d towards = nearest - shown.at_px;
  if (towards.norm() > shown.radius_px + tall)
    DrawLine(picture, shown.at_px + shown.radius_px * towards.normalized(), nearest, 1,
             shown.color);
  DrawEdgedText(picture, name, static_cast<int>(std::lround(box.left)) + 1,
                static_cast<int>(std::lround(box.top)) + 1, scale, shown.color);
}

// A pixel as red, green and blue.
void CopyPixel(PixelFormat format, const std::uint8_t* row, int x, std::uint8_t* rgb) {
  switch (format) {
    case PixelFormat::kGray8:
      std::fill_n(rgb, 3, row[x]);
      return;
    case PixelFormat::kGray16: {
      std::uint16_t value;
      std::memcpy(&value, row + 2 * static_cast<std::ptrdiff_t>(x), sizeof value);
      std::fill_n(rgb, 3, static_cast<std::uint8_t>(value >> 8));
      return;
    }
    case PixelFormat::kRgb8:
      std::copy_n(row + 3 * static_cast<std::ptrdiff_t>(x), 3, rgb);
  }
}

// For every pixel of the picture along an axis, from the first, the nearest one of the image; -1
// beyond its border.
std::vector<int> NearestInImage(int first, int size, double scale, double offset_px,
                                int image_size) {
  std::vector<int> nearest;
  nearest.reserve(static_cast<std::size_t>(size));
  for (int at = first; at < first + size; ++at) {
    const double in_image = (at - offset_px) / scale;
    const bool is_beyond = in_image <= -1 || in_image >= image_size;
    nearest.push_back(
        is_beyond ? -1 : std::clamp(static_cast<int>(std::lround(in_image)), 0, image_size - 1));
  }
  return nearest;
}

}  // namespace

Picture PictureOf(const Frame& frame, int left, int top, int width, int height) {
  Picture picture = FilledPicture(width, height, Eigen::Vector3f::Constant(0.03F));
  const ImageView& image = frame.image;
  const PictureFromImage& from = frame.picture_from_image;
  const auto columns = NearestInImage(left, width, from.scale.x(), from.offset_px.x(), image.width);
  const auto rows = NearestInImage(top, height, from.scale.y(), from.offset_px.y(), image.height);
  for (int y = 0; y < height; ++y) {
    if (rows[y] < 0) continue;
    const std::uint8_t* const row = image.row(rows[y]);
    for (int x = 0; x < width; ++x)
      if (columns[x] >= 0) CopyPixel(image.format, row, columns[x], picture.pixel(x, y));
  }
  return picture;
}

void DrawMarks(const FrameMarks& marks, int camera, const Magnification& shown,
               const MarkStyle& style, Picture& picture) {
  constexpr double kLine_px = 1.4;
  NamePlaces places(picture.width, picture.height);
  const auto occupy = [&](const Eigen::Vector2d& at, double radius) {
    places.Occupy({at.x() - radius, at.y() - radius, at.x() + radius, at.y() + radius});
  };
  for (const SpareDot& dot : marks.spare_dots) {
    if (dot.camera != camera) continue;
    const Eigen::Vector2d at_px = shown(dot.center_px);
    DrawRing(picture, at_px, RingRadius_px(dot.diameter_px, shown), kLine_px, kSpare);
    if (IsIn(picture, at_px)) occupy(at_px, RingRadius_px(dot.diameter_px, shown));
  }
  const std::vector<Shown> chosen = MarksIn(marks, camera, shown, style, picture);
  for (const Shown& one : chosen) {
    occupy(one.at_px, one.radius_px);
    if (one.mark->dot_px) DrawRing(picture, one.at_px, one.radius_px, kLine_px, one.color);
    if (!one.mark->dot_px || (style.crosses_in_rings && one.is_highlighted))
      DrawCross(picture, shown(one.mark->place_px), 5, kLine_px, one.color);
  }
  for (const Shown& one : chosen)
    DrawName(one, style.names[one.mark->marker], style.text_scale, places, picture);
}

}  // namespace articap
