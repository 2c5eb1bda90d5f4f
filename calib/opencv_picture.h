// SPDX-License-Identifier: MIT
#pragma once

// For calib's own sources: OpenCV stays out of what others include.
#include <opencv2/core/mat.hpp>

#include "calib/gray_picture.h"

namespace articap {

// The same memory.
cv::Mat MatOf(GrayPicture& picture);

// 8 bits, the darkest and the brightest that the picture has stretched to black and white.
cv::Mat EightBitsOf(const GrayPicture& picture);

}  // namespace articap
