// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "capture/video.h"
#include "core/frame_source.h"
#include "core/result.h"

namespace articap {

// Files that hold a picture each (PNG, JPEG, TIFF, BMP, PGM, ...; grey of 8 or 16 bits, or colour),
// as frames in the order given, each with its file's name; their time is 0, since nobody knows. The
// pixels are as the file holds them: an orientation that a camera noted in it (EXIF) is not
// applied, since it is the lens that stands still. A file that cannot be read is an error of Next()
// that names it, and asking again goes on with the next one.
std::unique_ptr<FrameSource> OpenPictures(std::vector<std::filesystem::path> paths,
                                          PixelColor color = PixelColor::kLuma);

// The pictures in a folder, told by their content, in the order in which people number them; with
// them files that are no pictures, but end as one of these does: broken ones, which Next() names.
// An error where there is no picture.
Result<std::vector<std::filesystem::path>> PicturesIn(const std::filesystem::path& folder);

}  // namespace articap
