// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "core/io/calibration_keys.h"
#include "core/io/camera_parts.h"

namespace articap {
namespace {

// Rounded to 1e-12 m, so that metres of a file, read as mm, are written as the same metres again.
double Metres(double length_mm) {
  constexpr double kMmPerM = 1000, kPerMetre = 1e12;
  return std::round(length_mm / kMmPerM * kPerMetre) / kPerMetre + 0.0;
}

}  // namespace

std::string WriteCaliscope(const CameraArray& array) {
  std::string text;
  for (std::size_t i = 0; i < array.cameras.size(); ++i) {
    const Camera& camera = array.cameras[i];
    const Rigid3d& pose = camera.cam_from_stage;
    text += fmt::format(
        "{}[cameras.{}]\ncam_id = {}\nsize = [{}, {}]\nrotation_count = 0\nmatrix = {}\n"
        "distortions = {}\ntranslation = {}\nrotation = {}\nfisheye = false\n",
        i == 0 ? "" : "\n", i, i, camera.width, camera.height, TomlMatrix(MatrixOf(camera.lens)),
        TomlList(DistortionList(camera.lens)), TomlList(pose.translation_mm.unaryExpr(&Metres)),
        TomlList(SettledRotationVector(pose.rotation)));
  }
  return text;
}

}  // namespace articap
