// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/result.h"
#include "core/time.h"

namespace articap {

enum class FrameStatus : std::uint8_t {
  kGood,
  kCorrupt,  // it came, and what could be decoded is shown, but not all of it can be trusted
};

// Where a pixel of an image lies in the camera's picture, whose pixels are square and whose rows
// are all there: p_in_picture = scale * p_in_image + offset_px, each axis for itself. The identity
// for progressive video with square pixels. A field of interlaced video has every second row (scale
// (1, 2), offset (0, 0) for the top field and (0, 1) for the bottom one); pixels with another
// aspect have another scale along x. Calibration and tracking give what they measure in the
// picture.
struct PictureFromImage {
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();
  Eigen::Vector2d offset_px = Eigen::Vector2d::Zero();

  Eigen::Vector2d operator*(const Eigen::Vector2d& point_in_image) const {
    return scale.cwiseProduct(point_in_image) + offset_px;
  }
  bool is_identity() const { return scale == Eigen::Vector2d::Ones() && offset_px.isZero(0); }
};

// A picture with its times. Of the three clocks a source fills in what it has; `time` it always
// has.
struct Frame {
  std::int64_t index = 0;                 // in the source, from 0, without gaps
  std::string name;                       // of the picture's file; empty in a video
  SessionTime time;                       // on the session clock: middle of the exposure, if known
  std::optional<std::int64_t> device_ns;  // the camera's own clock
  std::optional<std::int64_t> host_ns;    // the computer's clock when the frame arrived
  FrameStatus status = FrameStatus::kGood;
  ImageView image;  // valid until the source is asked for the next frame
  PictureFromImage picture_from_image;
};

struct FrameSourceInfo {
  std::string name;  // of the camera or file, for messages
  int width = 0;     // of the picture, px: after rotation, with square pixels and both fields
  int height = 0;
  double rate_hz = 0;         // frames (or fields) a second; 0 for separate pictures
  bool constant_rate = true;  // false: only the frames' own times are right
  bool interlaced = false;    // every frame is one field
  std::int64_t frames = -1;   // as far as known before reading to the end; -1: not known
  std::vector<std::string>
      notes;  // what was found out and done: fields, rotation, aspect; sentences
};

// Pictures in order, from a take, a video file, picture files or a camera: what calibration and
// tracking read. They never open a video themselves.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  virtual const FrameSourceInfo& info() const = 0;
  // Nothing at the end. A failure says which frame of which file, and why; what came before stays
  // good, and asking again goes on behind the fault where that is possible.
  virtual Result<std::optional<Frame>> Next() = 0;
  // Back to the first frame. Fails for what cannot go back, such as a camera.
  virtual Result<void> Rewind() = 0;
};

}  // namespace articap
