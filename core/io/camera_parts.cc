// SPDX-License-Identifier: MIT
#include "core/io/camera_parts.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace articap {
namespace {

constexpr int kLeastSide_px = 16;
constexpr int kMostSide_px = 65536;

Eigen::Vector3d RotationVector(const Eigen::Quaterniond& rotation) {
  // A rotation by pi has two vectors. The sign turns well outside of the rounding of the vectors,
  // so that writing and reading does not flip it back and forth.
  constexpr double kSignTurns = -1e-12;
  const double sign = rotation.w() < kSignTurns ? -1 : 1;
  const Eigen::Vector3d axis = sign * rotation.vec();
  const double sine = axis.norm();
  if (sine == 0) return Eigen::Vector3d::Zero();
  return 2 * std::atan2(sine, sign * rotation.w()) / sine * axis;
}

Eigen::Quaterniond Rotation(const Eigen::Vector3d& vector_rad) {
  const double angle = vector_rad.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d axis = std::sin(angle / 2) / angle * vector_rad;
  return Eigen::Quaterniond(std::cos(angle / 2), axis.x(), axis.y(), axis.z()).normalized();
}

Eigen::Vector3d RoundedVector(const Eigen::Vector3d& vector_rad) {
  constexpr double kPerRad = 1e13;  // a hundred times coarser than what the conversions leave
  // The sum makes -0 a plain 0.
  return ((vector_rad * kPerRad).array().round() / kPerRad + 0.0).matrix();
}

}  // namespace

Result<Lens> LensFromMatrix(const Eigen::Matrix3d& matrix, const std::string& where) {
  if (!matrix.allFinite())
    return Fail(fmt::format("{}: the camera matrix holds numbers that are not finite", where));
  if (matrix(1, 0) != 0 || matrix(2, 0) != 0 || matrix(2, 1) != 0 || matrix(2, 2) != 1)
    return Fail(fmt::format(
        "{}: the camera matrix is not [fx 0 cx; 0 fy cy; 0 0 1]; is it transposed?", where));
  if (matrix(0, 1) != 0)
    return Fail(
        fmt::format("{}: the camera matrix has a skew of {} px, which articap's cameras have not; "
                    "calibrate with square axes",
                    where, matrix(0, 1)));
  if (!(matrix(0, 0) > 0) || !(matrix(1, 1) > 0))
    return Fail(fmt::format("{}: the focal lengths {} and {} px are not positive", where,
                            matrix(0, 0), matrix(1, 1)));
  Lens lens;
  lens.fx_px = matrix(0, 0);
  lens.fy_px = matrix(1, 1);
  lens.cx_px = matrix(0, 2);
  lens.cy_px = matrix(1, 2);
  return lens;
}

Eigen::Matrix3d MatrixOf(const Lens& lens) {
  Eigen::Matrix3d matrix;
  matrix << lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1;
  return matrix;
}

Result<void> SetDistortion(const std::vector<double>& list, const std::string& where, Lens& lens) {
  const std::size_t size = list.size();
  if (size != 0 && size != 4 && size != 5 && size != 8 && size != 12 && size != 14)
    return Fail(
        fmt::format("{}: {} distortion coefficients; there are 4, 5 or 8 (k1 k2 p1 p2 k3 "
                    "k4 k5 k6)",
                    where, size));
  for (std::size_t i = 0; i < size; ++i) {
    if (!std::isfinite(list[i]))
      return Fail(fmt::format("{}: distortion coefficient {} is not finite", where, i + 1));
    if (i < lens.distortion.size())
      lens.distortion[i] = list[i];
    else if (list[i] != 0)
      return Fail(
          fmt::format("{}: distortion coefficient {} is {}: thin prism and tilt (s1 to s4, tau) "
                      "are not supported; calibrate without them",
                      where, i + 1, list[i]));
  }
  return {};
}

std::vector<double> DistortionList(const Lens& lens) {
  const auto& k = lens.distortion;
  const bool is_rational = k[Lens::kK4] != 0 || k[Lens::kK5] != 0 || k[Lens::kK6] != 0;
  return {k.begin(), k.begin() + (is_rational ? Lens::kNumDistortion : Lens::kK3 + 1)};
}

Result<Eigen::Quaterniond> RotationFromVector(const Eigen::Vector3d& vector_rad,
                                              const std::string& where) {
  // Bundle adjustment may leave a vector of more than one turn; two turns it does not.
  constexpr double kLongest = 4 * std::numbers::pi;
  if (!vector_rad.allFinite() || !(vector_rad.norm() <= kLongest))
    return Fail(fmt::format("{}: ({}, {}, {}) is no rotation vector in rad; is it in degrees?",
                            where, vector_rad.x(), vector_rad.y(), vector_rad.z()));
  return Rotation(vector_rad);
}

Result<Eigen::Quaterniond> RotationFromMatrix(const Eigen::Matrix3d& matrix,
                                              const std::string& where) {
  constexpr double kOrthonormal = 1e-3;  // four digits were written
  if (!matrix.allFinite() ||
      !((matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).norm() <= kOrthonormal))
    return Fail(
        fmt::format("{}: the rotation matrix is no rotation: its rows are not orthonormal", where));
  if (!(matrix.determinant() > 0))
    return Fail(fmt::format("{}: the rotation matrix is a reflection (its determinant is negative)",
                            where));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  return Eigen::Quaterniond(nearest).normalized();
}

Eigen::Vector3d SettledRotationVector(const Eigen::Quaterniond& rotation) {
  Eigen::Vector3d vector = RoundedVector(RotationVector(rotation));
  // The second round differs where the first ended at an angle of pi, on the other side of it.
  for (int round = 0; round < 4; ++round) {
    const Eigen::Vector3d again = RoundedVector(RotationVector(Rotation(vector)));
    if (again == vector) return vector;
    vector = again;
  }
  ARTICAP_CHECK(false);
  return vector;
}

Result<Eigen::Vector2i> ParsePictureSize(const std::string& text) {
  Eigen::Vector2i size(0, 0);
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.x());
  const bool has_cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height = std::from_chars(has_cross ? width.ptr + 1 : end, end, size.y());
  if (!has_cross || height.ec != std::errc() || height.ptr != end ||
      size.minCoeff() < kLeastSide_px || size.maxCoeff() > kMostSide_px)
    return Fail(
        fmt::format("'{}' is no size of a picture; write width x height, as 640x480", text));
  return size;
}

Result<void> SetSize(double width, double height, const CameraReadOptions& options,
                     const std::string& where, Camera& camera) {
  if (!options.size.empty()) {
    const auto wanted = ParsePictureSize(options.size);
    if (!wanted) return tl::unexpected(wanted.error());
    if (width == 0 && height == 0) {
      width = wanted->x();
      height = wanted->y();
    } else if (width != wanted->x() || height != wanted->y()) {
      return Fail(fmt::format(
          "{}: is calibrated for pictures of {}x{} px, not {}; a lens holds for its size alone",
          where, width, height, options.size));
    }
  }
  if (width == 0 && height == 0)
    return Fail(
        fmt::format("{}: the file does not say how large the pictures are; give --size, "
                    "as 640x480",
                    where));
  const auto is_side = [](double side) {
    return side >= kLeastSide_px && side <= kMostSide_px && side == std::floor(side);
  };
  if (!is_side(width) || !is_side(height))
    return Fail(fmt::format("{}: {} x {} px is no size of a picture", where, width, height));
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
  return {};
}

}  // namespace articap
