// SPDX-License-Identifier: MIT
#pragma once

#include "core/calibration_toml.h"
#include "core/camera_io.h"
#include "fuzz/fuzz_input.h"

namespace articap {

// Cameras, whatever they were read from, go through every format that is written.
inline void RequireCamerasToRoundTrip(const std::string& text, const std::string& source_name) {
  const auto read = [&](const std::string& input) -> Result<CameraArray> {
    auto reading = ParseCameras(input, source_name);
    if (!reading) return tl::unexpected(reading.error());
    return std::move(reading->array);
  };
  const auto array = read(text);
  if (!array) return;
  RequireRoundTrip(WriteCalibration(*array), read, WriteCalibration);
  RequireRoundTrip(WriteCaliscope(*array), read, WriteCaliscope);
  for (const Camera& camera : array->cameras)
    RequireRoundTrip(WriteOpenCvYaml(camera), read,
                     [](const CameraArray& one) { return WriteOpenCvYaml(one.cameras.at(0)); });
  Require(read(WriteCalibration(*array)).has_value());
  Require(DescribeCameras(*array, source_name).usable);
}

}  // namespace articap
