// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/camera_io.h"
#include "core/result.h"

// What the formats of camera files share: the pieces of a camera, checked as they are read. `where`
// begins each message: the file and the camera.
namespace articap {

// Of a 3x3 camera matrix; refused: skew, no upper triangle, focal lengths that are not positive.
Result<Lens> LensFromMatrix(const Eigen::Matrix3d& matrix, const std::string& where);
Eigen::Matrix3d MatrixOf(const Lens& lens);

// OpenCV's list of 0, 4, 5, 8, 12 or 14; those behind the eighth must be 0.
Result<void> SetDistortion(const std::vector<double>& list, const std::string& where, Lens& lens);
// The same list, five long where k4, k5 and k6 are 0 (what every reader takes), else eight.
std::vector<double> DistortionList(const Lens& lens);

// Rotation vectors (Rodrigues): along the axis, as long as the angle is in rad.
Result<Eigen::Quaterniond> RotationFromVector(const Eigen::Vector3d& vector_rad,
                                              const std::string& where);
// The nearest rotation to a matrix whose rows are orthonormal but for the digits they were written
// with.
Result<Eigen::Quaterniond> RotationFromMatrix(const Eigen::Matrix3d& matrix,
                                              const std::string& where);
// The rotation vector for a file, rounded to 1e-13 rad such that RotationFromVector() of it gives
// the same vector here again. Not longer than pi (but for the rounding).
Eigen::Vector3d SettledRotationVector(const Eigen::Quaterniond& rotation);

// "640x480".
Result<Eigen::Vector2i> ParsePictureSize(const std::string& text);
// Gives the camera a size: the file's (0 where it has none), or that of the options.
Result<void> SetSize(double width, double height, const CameraReadOptions& options,
                     const std::string& where, Camera& camera);

// Brings translations from the unit of the file to mm. `named_unit` is what the file says or its
// format defines ("mm", "m"), or empty: then it is that of the options, else mm, and where the
// cameras could then not stand around a face, the file is refused.
Result<void> ConvertToMm(const std::string& named_unit, const CameraReadOptions& options,
                         const std::string& source_name, CameraReading& reading);

// All that must hold of an array of cameras, whatever it came from.
Result<void> CheckCameras(const CameraArray& array, const std::string& source_name);

}  // namespace articap
