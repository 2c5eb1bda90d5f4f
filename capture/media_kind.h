// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>

namespace articap {

enum class MediaKind : std::uint8_t {
  kNone,     // nothing that FFmpeg reads, or no file at all
  kPicture,  // one picture
  kVideo,    // moving pictures, with or without sound
  kAudio,    // sound alone; a picture of the cover does not count
};

// What a file holds, by its content; its name says nothing.
MediaKind MediaKindOf(const std::filesystem::path& path);

}  // namespace articap
