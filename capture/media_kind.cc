// SPDX-License-Identifier: MIT
#include "capture/media_kind.h"

#include "capture/libav.h"

namespace articap {

MediaKind MediaKindOf(const std::filesystem::path& path) {
  const auto input = libav::Input::Open({path});
  if (!input) return MediaKind::kNone;
  if ((*input)->is_picture()) return MediaKind::kPicture;
  if ((*input)->video_stream() != nullptr) return MediaKind::kVideo;
  if ((*input)->audio_stream() != nullptr) return MediaKind::kAudio;
  return MediaKind::kNone;
}

}  // namespace articap
