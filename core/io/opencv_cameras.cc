// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "core/io/camera_formats.h"
#include "core/io/camera_parts.h"
#include "core/io/opencv_yaml.h"
#include "core/toml_reader.h"

// The files of OpenCV's samples: calibration.cpp and camera_calibration.cpp for one camera,
// stereo_calib.cpp for a pair (intrinsics.yml and extrinsics.yml), and what ROS makes of the first.
namespace articap {
namespace {

constexpr int kMostCoefficients = 14;

class OpenCvReader {
 public:
  OpenCvReader(const OpenCvDocument& document, std::string source_name,
               const CameraReadOptions& options)
      : document_(document), source_name_(std::move(source_name)), options_(options) {
    reading_.format = CameraFormat::kOpenCvYaml;
  }

  Result<CameraReading> ReadOne() {
    if (auto refused = RefuseOtherModels(); !refused) return tl::unexpected(refused.error());
    Camera camera;
    camera.name = document_.Has("camera_name")
                      ? document_.Text("camera_name")
                      : std::filesystem::path(source_name_).stem().string();
    auto read = ReadLens(EitherKey("camera_matrix", "Camera_Matrix"),
                         EitherKey("distortion_coefficients", "Distortion_Coefficients"), camera);
    if (read) read = ReadSize(camera);
    if (read) read = ReadPose(camera);
    if (!read) return tl::unexpected(read.error());
    reading_.array.cameras.push_back(std::move(camera));
    return Finish();
  }

  // x_right = R x_left + T; the stage is the left camera's frame.
  Result<CameraReading> ReadPair(const OpenCvDocument& extrinsics) {
    Camera left, right;
    left.name = "left";
    right.name = "right";
    auto read = ReadLens("M1", "D1", left);
    if (read) read = ReadLens("M2", "D2", right);
    if (read) read = ReadSize(left);
    if (read) read = ReadSize(right);
    if (!read) return tl::unexpected(read.error());
    if (!extrinsics.Has("R"))
      return Fail(
          fmt::format("{}: two cameras, but not where they stand to one another; put the "
                      "extrinsics.yml of the pair (R and T) beside it",
                      source_name_));
    const auto rotation = extrinsics.Matrix("R", 9);
    if (!rotation) return tl::unexpected(rotation.error());
    const auto translation = VectorIn(extrinsics, "T");
    if (!translation) return tl::unexpected(translation.error());
    if (rotation->rows != 3 || rotation->columns != 3)
      return Fail(fmt::format("{}: R is not 3 x 3", source_name_));
    const auto turned = RotationFromMatrix(
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation->values.data()),
        source_name_ + ", R");
    if (!turned) return tl::unexpected(turned.error());
    right.cam_from_stage = {*turned, *translation};
    reading_.array.cameras = {std::move(left), std::move(right)};
    return Finish();
  }

 private:
  std::string EitherKey(const char* key, const char* older) const {
    return document_.Has(older) && !document_.Has(key) ? older : key;
  }

  Result<void> RefuseOtherModels() const {
    const std::string model = document_.Text("distortion_model");  // of ROS
    const bool is_known = model.empty() || model == "plumb_bob" || model == "rational_polynomial";
    const std::string fisheye = document_.Text("fisheye_model");  // of OpenCV
    if (is_known && (fisheye.empty() || fisheye == "0")) return {};
    return Fail(
        fmt::format("{}: is a fisheye camera or has another lens model ('{}'), which articap does "
                    "not support; calibrate it as a pinhole with a rational model",
                    source_name_, is_known ? "fisheye_model" : model));
  }

  Result<void> ReadLens(const std::string& matrix_key, const std::string& distortion_key,
                        Camera& camera) const {
    const auto matrix = document_.Matrix(matrix_key, 9);
    if (!matrix) return tl::unexpected(matrix.error());
    if (matrix->rows != 3 || matrix->columns != 3)
      return Fail(fmt::format("{}: {} is not 3 x 3", source_name_, matrix_key));
    const auto lens = LensFromMatrix(
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix->values.data()),
        fmt::format("{}, {}", source_name_, matrix_key));
    if (!lens) return tl::unexpected(lens.error());
    camera.lens = *lens;
    const auto distortion = document_.Matrix(distortion_key, kMostCoefficients);
    if (!distortion) return tl::unexpected(distortion.error());
    return SetDistortion(distortion->values, fmt::format("{}, {}", source_name_, distortion_key),
                         camera.lens);
  }

  Result<void> ReadSize(Camera& camera) const {
    const std::string width_key = EitherKey("image_width", "image_Width");
    const std::string height_key = EitherKey("image_height", "image_Height");
    if (!document_.Has(width_key) && !document_.Has(height_key))
      return SetSize(0, 0, options_, source_name_, camera);
    const auto width = document_.Number(width_key), height = document_.Number(height_key);
    if (!width) return tl::unexpected(width.error());
    if (!height) return tl::unexpected(height.error());
    return SetSize(*width, *height, options_, source_name_, camera);
  }

  // rvec and tvec are articap's addition; OpenCV's sample has the poses of its board instead.
  Result<void> ReadPose(Camera& camera) const {
    if (!document_.Has("rvec") && !document_.Has("tvec")) return {};
    const auto vector = VectorIn(document_, "rvec"), translation = VectorIn(document_, "tvec");
    if (!vector) return tl::unexpected(vector.error());
    if (!translation) return tl::unexpected(translation.error());
    const auto rotation = RotationFromVector(*vector, source_name_ + ", rvec");
    if (!rotation) return tl::unexpected(rotation.error());
    camera.cam_from_stage = {*rotation, *translation};
    return {};
  }

  static Result<Eigen::Vector3d> VectorIn(const OpenCvDocument& document, const std::string& key) {
    const auto vector = document.Matrix(key, 3);
    if (!vector) return tl::unexpected(vector.error());
    if (vector->values.size() != 3) return Fail(fmt::format("{} is not three numbers", key));
    return Eigen::Vector3d(vector->values[0], vector->values[1], vector->values[2]);
  }

  Result<CameraReading> Finish() {
    const std::string unit = document_.Text("length_unit");
    if (auto converted = ConvertToMm(unit, options_, source_name_, reading_); !converted)
      return tl::unexpected(converted.error());
    if (auto checked = CheckCameras(reading_.array, source_name_); !checked)
      return tl::unexpected(checked.error());
    return std::move(reading_);
  }

  const OpenCvDocument& document_;
  std::string source_name_;
  const CameraReadOptions& options_;
  CameraReading reading_;
};

std::string MatrixBlock(const char* key, int rows, int columns, const std::vector<double>& values) {
  std::string data;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) data += i % 3 == 0 ? ",\n       " : ", ";
    data += TomlFloat(values[i]);
  }
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n",
                     key, rows, columns, data);
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + "\"";
}

}  // namespace

std::string WriteOpenCvYaml(const Camera& camera) {
  const Lens& lens = camera.lens;
  const std::vector<double> distortion = DistortionList(lens);
  const Eigen::Vector3d rotation = SettledRotationVector(camera.cam_from_stage.rotation);
  const Eigen::Vector3d& translation = camera.cam_from_stage.translation_mm;
  return fmt::format("%YAML:1.0\n---\ncamera_name: {}\nimage_width: {}\nimage_height: {}\n",
                     Quoted(camera.name), camera.width, camera.height) +
         MatrixBlock("camera_matrix", 3, 3,
                     {lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1}) +
         MatrixBlock("distortion_coefficients", static_cast<int>(distortion.size()), 1,
                     distortion) +
         "length_unit: mm\n" +
         MatrixBlock("rvec", 3, 1, {rotation.x(), rotation.y(), rotation.z()}) +
         MatrixBlock("tvec", 3, 1, {translation.x(), translation.y(), translation.z()});
}

Result<CameraReading> ReadOpenCvCameras(const std::string& text, const std::string& extrinsics_text,
                                        const std::string& source_name,
                                        const CameraReadOptions& options) {
  const auto document = OpenCvDocument::Parse(text, source_name);
  if (!document) return tl::unexpected(document.error());
  OpenCvReader reader(*document, source_name, options);
  if (!document->Has("M1")) return reader.ReadOne();
  if (document->Has("R")) return reader.ReadPair(*document);
  const auto extrinsics =
      OpenCvDocument::Parse(extrinsics_text, source_name + ", its extrinsics.yml");
  if (!extrinsics) return tl::unexpected(extrinsics.error());
  return reader.ReadPair(*extrinsics);
}

}  // namespace articap
