// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/c3d_parameters.h"
#include "core/marker_io.h"

namespace articap {

// Where the samples of a C3D file lie and how many there are, after header and parameters, which
// say it twice or thrice, have been reconciled with each other and with the file's size.
struct C3dLayout {
  int num_points = 0;
  int analog_per_frame = 0;  // numbers a frame: channels x samples_per_frame
  int samples_per_frame = 0;
  int num_frames = 0;
  int first_frame = 1;
  double rate_hz = 0;
  bool is_float = true;
  double scale =
      1;  // |POINT:SCALE|: units of length per step of residuals, and of integer positions
  std::size_t data_offset = 0;
  std::size_t word_bytes = 4;

  int num_channels() const { return samples_per_frame ? analog_per_frame / samples_per_frame : 0; }
  std::size_t frame_words() const {
    return 4 * static_cast<std::size_t>(num_points) + static_cast<std::size_t>(analog_per_frame);
  }
  std::size_t frame_bytes() const { return frame_words() * word_bytes; }
};

Result<C3dLayout> FindC3dLayout(const C3dParameters& parameters, const std::string& source_name,
                                const MarkerReadOptions& options,
                                std::vector<std::string>& warnings);

// The decimal number that a 32-bit float was meant to be: 59.94, not 59.939998626708984.
double DecimalOf(float value);

}  // namespace articap
