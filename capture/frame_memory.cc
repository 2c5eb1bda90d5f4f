// SPDX-License-Identifier: MIT
#include "capture/frame_memory.h"

#include <optional>
#include <utility>

namespace articap {
namespace {

class StoredSource : public FrameSource {
 public:
  explicit StoredSource(std::shared_ptr<const StoredVideo> video) : video_(std::move(video)) {}

  const FrameSourceInfo& info() const override { return video_->info; }
  Result<std::optional<Frame>> Next() override {
    if (next_ == video_->frames.size()) return std::nullopt;
    return video_->frames[next_++].frame();
  }
  Result<void> Rewind() override {
    next_ = 0;
    return {};
  }

 private:
  std::shared_ptr<const StoredVideo> video_;
  std::size_t next_ = 0;
};

}  // namespace

void StoredFrame::Store(const Frame& frame) {
  frame_ = frame;
  const ImageView& image = frame.image;
  pixels_.format = image.format;
  pixels_.width = image.width;
  pixels_.height = image.height;
  const std::ptrdiff_t row_bytes =
      static_cast<std::ptrdiff_t>(image.width) * BytesPerPixel(image.format);
  pixels_.bytes.clear();
  pixels_.bytes.reserve(static_cast<std::size_t>(row_bytes) * image.height);
  for (int y = 0; y < image.height; ++y)
    pixels_.bytes.insert(pixels_.bytes.end(), image.row(y), image.row(y) + row_bytes);
  frame_.image = pixels_.view();
}

std::unique_ptr<FrameSource> OpenStored(std::shared_ptr<const StoredVideo> video) {
  return std::make_unique<StoredSource>(std::move(video));
}

}  // namespace articap
