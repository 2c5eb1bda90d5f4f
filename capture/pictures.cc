// SPDX-License-Identifier: MIT
#include "capture/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "capture/frame_pixels.h"
#include "capture/media_kind.h"
#include "capture/stream_decoder.h"
#include "core/natural_order.h"

extern "C" {
#include <libavutil/frame.h>
}

namespace articap {
namespace {

namespace fs = std::filesystem;
using libav::StreamDecoder;

class PictureSource : public FrameSource {
 public:
  PictureSource(std::vector<fs::path> paths, PixelColor color)
      : paths_(std::move(paths)), pixels_(color, 0) {
    info_.name =
        paths_.size() == 1 ? paths_[0].string() : fmt::format("{} pictures", paths_.size());
    info_.constant_rate = false;
    info_.frames = static_cast<std::int64_t>(paths_.size());
  }

  // The size is that of the picture read last: they may differ.
  const FrameSourceInfo& info() const override { return info_; }

  Result<std::optional<Frame>> Next() override {
    if (next_ == paths_.size()) return std::nullopt;
    const fs::path& path = paths_[next_++];
    auto decoder = StreamDecoder::Open({path}, libav::StreamKind::kVideo, /*strict=*/true);
    if (!decoder) return tl::unexpected(decoder.error());
    decoder_ = *std::move(decoder);
    const Result<bool> decoded = decoder_->Next();
    if (!decoded || !*decoded || decoder_->is_corrupt())
      return Fail(fmt::format("{}: the picture is damaged{}; take it out", path.string(),
                              decoded ? "" : " (" + decoded.error().message + ")"));
    const Result<ImageView> image = pixels_.Convert(decoder_->frame(), libav::Rows::kAll);
    if (!image) return Fail(fmt::format("{}: {}", path.string(), image.error().message));
    std::tie(info_.width, info_.height) = std::pair(image->width, image->height);
    Frame frame;
    frame.index = num_frames_++;
    frame.name = path.filename().string();
    frame.image = *image;
    return frame;
  }

  Result<void> Rewind() override {
    next_ = 0;
    num_frames_ = 0;
    return {};
  }

 private:
  std::vector<fs::path> paths_;
  libav::FramePixels pixels_;
  FrameSourceInfo info_;
  std::unique_ptr<StreamDecoder> decoder_;  // holds the pixels of the frame shown last
  std::size_t next_ = 0;
  std::int64_t num_frames_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> OpenPictures(std::vector<fs::path> paths, PixelColor color) {
  return std::make_unique<PictureSource>(std::move(paths), color);
}

Result<std::vector<fs::path>> PicturesIn(const fs::path& folder) {
  std::vector<fs::path> pictures, others;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_regular_file(ignored)) continue;
    const MediaKind kind = MediaKindOf(entry->path());
    if (kind == MediaKind::kPicture) pictures.push_back(entry->path());
    if (kind == MediaKind::kNone) others.push_back(entry->path());
  }
  if (error)
    return Fail(fmt::format("{}: cannot be read ({}); check the path and the folder's rights",
                            folder.string(), error.message()));
  if (pictures.empty())
    return Fail(fmt::format("{}: the folder holds no pictures", folder.string()));
  std::set<fs::path> endings;
  for (const fs::path& picture : pictures) endings.insert(picture.extension());
  std::copy_if(others.begin(), others.end(), std::back_inserter(pictures),
               [&](const fs::path& other) { return endings.contains(other.extension()); });
  std::sort(pictures.begin(), pictures.end(), [](const fs::path& first, const fs::path& second) {
    return NaturallyBefore(first.filename().string(), second.filename().string());
  });
  return pictures;
}

}  // namespace articap
