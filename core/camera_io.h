// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

enum class CameraFormat : std::uint8_t {
  kArticap,     // calibration.toml, aniposelib's layout with more in it (core/calibration_toml.h)
  kAniposelib,  // the same layout as aniposelib, FreeMoCap and Pose2Sim write it
  kCaliscope,   // camera_array.toml, and the config.toml that it was before
  kOpenCvYaml,  // what OpenCV's samples for one camera and for a stereo pair write
  kQualisys     // QCA, the text (XML) that Qualisys Track Manager exports
};
const char* NameOf(CameraFormat format);  // "articap", "aniposelib", "caliscope", ...

struct CameraReadOptions {
  // Unit of the translations, where the file names none: "mm" or "m"; empty is mm, refused where
  // that cannot be. A file that names its unit needs none, and one that names another is refused.
  std::string unit;
  // The picture's size, "640x480", px, where the file holds none. One that holds another is
  // refused: a lens is calibrated for one size.
  std::string size;
};

struct CameraReading {
  CameraArray array;
  CameraFormat format = CameraFormat::kArticap;
  std::vector<std::string> warnings;  // what was assumed, and what was not taken over; sentences
};

// Reads any of the formats, told apart by content. Refused: what is no finite pinhole camera of
// core/camera.h (fisheye, skew, thin prism, tilt), names that are there twice, cameras without a
// pose beside others. `extrinsics_text` is OpenCV's second file of a stereo pair, empty where there
// is none.
Result<CameraReading> ParseCameras(const std::string& text, const std::string& source_name,
                                   const CameraReadOptions& options = {},
                                   const std::string& extrinsics_text = "");
// Of a stereo pair of OpenCV, extrinsics.yml (or .yaml) is looked for beside the file.
Result<CameraReading> ReadCameraFile(const std::filesystem::path& path,
                                     const CameraReadOptions& options = {});
// The same for who needs the cameras alone.
Result<CameraArray> ReadCameras(const std::filesystem::path& path,
                                const CameraReadOptions& options = {});

// Whether a file of this name may hold cameras: .toml, .yml, .yaml, .xml, .qca, .qca.txt.
bool MayHoldCameras(const std::filesystem::path& path);

// camera_array.toml of Caliscope; metres.
std::string WriteCaliscope(const CameraArray& array);
// One camera as cv::FileStorage writes it: the keys of OpenCV's calibration sample, and the pose as
// rvec and tvec (mm), as cv::projectPoints takes it.
std::string WriteOpenCvYaml(const Camera& camera);

// What the format cannot carry of these cameras, each a sentence; empty where nothing is lost.
std::vector<std::string> LossesOf(const CameraArray& array, CameraFormat format);

// Sizes, lenses, places and baselines of the cameras, and the mirrors.
StageReport DescribeCameras(const CameraArray& array, const std::string& source_name);

}  // namespace articap
