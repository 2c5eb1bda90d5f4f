// SPDX-License-Identifier: MIT
#include "tests/tracking/dot_picture.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>

namespace articap {
namespace {

constexpr int kCells = 8;         // a side of a pixel
constexpr int kRowsOfCell = 8;    // that are cut exactly
constexpr double kFar_sigma = 5;  // of the blur, beyond which there is nothing

// How much of [low, high] lies in [from, to].
double Overlap(double low, double high, double from, double to) {
  return std::max(0.0, std::min(high, to) - std::max(low, from));
}

// Where the ellipse begins and ends along a row; a point beside it where the row misses it.
std::pair<double, double> Chord(const PaintedDot& dot, double y) {
  const Eigen::Rotation2Dd turn(dot.angle_rad);
  const Eigen::Matrix2d inverse_shape = turn.toRotationMatrix() *
                                        dot.semi_axes_px.cwiseAbs2().cwiseInverse().asDiagonal() *
                                        turn.toRotationMatrix().transpose();
  const double dy = y - dot.center_px.y();
  const double a = inverse_shape(0, 0), b = inverse_shape(0, 1) * dy;
  const double c = inverse_shape(1, 1) * dy * dy - 1;
  const double root = std::sqrt(std::max(0.0, b * b - a * c)) / a;
  return {dot.center_px.x() - b / a - root, dot.center_px.x() - b / a + root};
}

// Of a pixel's value, the part that a cell has whose middle is (k + 1/2) cells right of the pixel's
// middle; k from -reach to reach - 1.
struct CellWeights {
  int reach = 0;
  std::vector<float> weights;

  explicit CellWeights(double blur_px)
      : reach(static_cast<int>(std::ceil(kCells * (0.5 + kFar_sigma * blur_px)))) {
    // The cells are squares themselves: that much blur is there already.
    const double sigma_px = std::sqrt(blur_px * blur_px - 1.0 / (12 * kCells * kCells));
    const auto below = [&](double x) { return 0.5 * std::erfc(-x / sigma_px / std::sqrt(2.0)); };
    for (int k = -reach; k < reach; ++k) {
      const double x = (k + 0.5) / kCells;
      weights.push_back(static_cast<float>((below(x + 0.5) - below(x - 0.5)) / kCells));
    }
  }
};

}  // namespace

PaintedDot PaintedDot::Disc(const Eigen::Vector2d& center_px, double diameter_px) {
  return {center_px, Eigen::Vector2d::Constant(diameter_px / 2)};
}

LightPicture::LightPicture(int picture_width, int picture_height, double background)
    : width(picture_width),
      height(picture_height),
      light(static_cast<std::size_t>(picture_width) * picture_height, background) {}

void LightPicture::AddSlope(const Eigen::Vector2d& per_px, const Eigen::Vector2d& zero_at_px) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) at(x, y) += per_px.dot(Eigen::Vector2d(x, y) - zero_at_px);
}

void LightPicture::Add(const PaintedDot& dot) {
  const double reach_px = dot.semi_axes_px.maxCoeff() + kFar_sigma * dot.blur_px + 1;
  const int left = static_cast<int>(std::floor(dot.center_px.x() - reach_px));
  const int top = static_cast<int>(std::floor(dot.center_px.y() - reach_px));
  const int side = static_cast<int>(std::ceil(2 * reach_px)) + 2;
  const CellWeights weights(dot.blur_px);
  const int num_cells = side * kCells;
  std::vector<float> cells(num_cells + 2 * weights.reach);  // one row, with a margin
  std::vector<float> columns(static_cast<std::size_t>(side) * (num_cells + 2 * weights.reach));
  for (int row = 0; row < num_cells; ++row) {
    std::fill(cells.begin(), cells.end(), 0.0f);
    bool any = false;
    for (int part = 0; part < kRowsOfCell; ++part) {
      // Of the first pixel of the window, the upper left corner is at left - 1/2, top - 1/2.
      const double y = top - 0.5 + (row + (part + 0.5) / kRowsOfCell) / kCells;
      const auto [begin_px, end_px] = Chord(dot, y);
      const double begin = (begin_px - (left - 0.5)) * kCells;
      const double end = (end_px - (left - 0.5)) * kCells;
      for (int i = std::max(0, static_cast<int>(begin)); i < std::min<double>(num_cells, end); ++i)
        cells[i + weights.reach] += static_cast<float>(Overlap(begin, end, i, i + 1) / kRowsOfCell);
      any = any || end > begin;
    }
    if (!any) continue;
    for (int column = 0; column < side; ++column) {
      // The pixel's middle is at this cell's left border.
      const float* first = &cells[column * kCells + kCells / 2];
      float sum = 0;
      for (int k = 0; k < 2 * weights.reach; ++k) sum += weights.weights[k] * first[k];
      columns[static_cast<std::size_t>(column) * (num_cells + 2 * weights.reach) + row +
              weights.reach] = sum;
    }
  }
  for (int y = std::max(0, top); y < std::min(height, top + side); ++y)
    for (int x = std::max(0, left); x < std::min(width, left + side); ++x) {
      const float* first =
          &columns[static_cast<std::size_t>(x - left) * (num_cells + 2 * weights.reach) +
                   (y - top) * kCells + kCells / 2];
      float sum = 0;
      for (int k = 0; k < 2 * weights.reach; ++k) sum += weights.weights[k] * first[k];
      at(x, y) += dot.contrast * sum;
    }
}

void LightPicture::Cover(double from_px, double value, double blur_px) {
  for (int x = 0; x < width; ++x) {
    const double covered = 0.5 * std::erfc((from_px - x) / blur_px / std::sqrt(2.0));
    for (int y = 0; y < height; ++y) at(x, y) += covered * (value - at(x, y));
  }
}

double PaintSensor::VarianceAt(double value) const {
  const double step = format == PixelFormat::kGray16 ? 1.0 / 65535 : 1.0 / 255;
  const double read = read_noise_e / full_well_e;
  return read * read + value / full_well_e + step * step / 12;
}

Image TakePicture(const LightPicture& light, const PaintSensor& sensor, RandomGenerator& random) {
  Image image(sensor.format, light.width, light.height);
  std::uint8_t* byte = image.bytes.data();
  for (const double value : light.light) {
    const double electrons = random.Poisson(std::max(0.0, value) * sensor.full_well_e) +
                             sensor.read_noise_e * random.Normal();
    double part = std::clamp(electrons / sensor.full_well_e, 0.0, 1.0);
    if (sensor.srgb_tone)  // IEC 61966-2-1
      part = part <= 0.0031308 ? 12.92 * part : 1.055 * std::pow(part, 1 / 2.4) - 0.055;
    if (sensor.format == PixelFormat::kGray16) {
      const auto code = static_cast<std::uint16_t>(std::lround(65535 * part));
      std::memcpy(byte, &code, sizeof(code));
      byte += sizeof(code);
    } else {
      *byte++ = static_cast<std::uint8_t>(std::lround(255 * part));
    }
  }
  return image;
}

Eigen::Matrix2d CenterBound(const PaintedDot& dot, double background, bool with_slope,
                            const PaintSensor& sensor) {
  const int side = static_cast<int>(2 * (dot.semi_axes_px.maxCoeff() * 1.5 + 10));
  PaintedDot middle = dot;
  // The phase is kept.
  middle.center_px =
      dot.center_px - dot.center_px.array().floor().matrix() + Eigen::Vector2d::Constant(side / 2);
  using Vary = std::function<void(PaintedDot&, double)>;
  const std::vector<Vary> parameters = {
      [](PaintedDot& d, double step) { d.center_px.x() += step; },
      [](PaintedDot& d, double step) { d.center_px.y() += step; },
      [](PaintedDot& d, double step) { d.semi_axes_px.x() += step; },
      [](PaintedDot& d, double step) { d.semi_axes_px.y() += step; },
      [](PaintedDot& d, double step) { d.blur_px += step; },
      [](PaintedDot& d, double step) { d.contrast += step; },
      // Of a disc the angle is none.
      [](PaintedDot& d, double step) {
        if (d.semi_axes_px.x() != d.semi_axes_px.y()) d.angle_rad += step;
      }};
  const int num_own = static_cast<int>(parameters.size());
  const int num_all = num_own + 3;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(side * side, num_all);
  LightPicture picture(side, side, background);
  picture.Add(middle);
  constexpr double kStep = 0.02;
  for (int i = 0; i < num_own; ++i) {
    PaintedDot more = middle, less = middle;
    parameters[i](more, kStep);
    parameters[i](less, -kStep);
    LightPicture difference(side, side);
    difference.Add(more);
    less.contrast *= -1;
    difference.Add(less);
    jacobian.col(i) =
        Eigen::Map<const Eigen::VectorXd>(difference.light.data(), side * side) / (2 * kStep);
  }
  Eigen::VectorXd weights(side * side);
  for (int pixel = 0; pixel < side * side; ++pixel) {
    jacobian.row(pixel).tail<3>() << 1, pixel % side - side / 2, pixel / side - side / 2;
    const double light = picture.light[pixel];
    weights[pixel] = light < 1 ? 1 / sensor.VarianceAt(light) : 0;
  }
  const int count = with_slope ? num_all : num_own + 1;
  const auto used = jacobian.leftCols(count);
  Eigen::MatrixXd information = used.transpose() * weights.asDiagonal() * used;
  for (int i = 0; i < count; ++i)
    if (information(i, i) == 0) information(i, i) = 1;
  return information.inverse().topLeftCorner<2, 2>();
}

}  // namespace articap
