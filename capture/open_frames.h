// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "capture/video.h"
#include "core/frame_source.h"
#include "core/result.h"
#include "core/session.h"

namespace articap {

// What people name as pictures, decided by what is in it: picture files; a folder of pictures, in
// the order of their numbers; a video, or the parts of one; the folder of a take with one camera.
Result<std::unique_ptr<FrameSource>> OpenFrames(const std::vector<std::filesystem::path>& paths,
                                                const VideoOptions& options = {});

// The video of one camera of a take, on the take's session clock (options.start is not regarded).
// Of a part of a take only the frames that lie in it. The file must be as it was.
Result<std::unique_ptr<FrameSource>> OpenCamera(const StoredTake& take, std::string_view camera,
                                                VideoOptions options = {});

}  // namespace articap
