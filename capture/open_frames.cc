// SPDX-License-Identifier: MIT
#include "capture/open_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "capture/media_kind.h"
#include "capture/pictures.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

// The frames of another source from one time to before another.
class PartSource : public FrameSource {
 public:
  PartSource(std::unique_ptr<FrameSource> whole, const TakePart& part)
      : whole_(std::move(whole)), start_(part.start), end_(part.end) {}

  const FrameSourceInfo& info() const override {
    info_ = whole_->info();
    info_.frames = -1;
    return info_;
  }

  Result<std::optional<Frame>> Next() override {
    while (true) {
      Result<std::optional<Frame>> frame = whole_->Next();
      if (!frame || !*frame) return frame;
      if ((*frame)->time >= end_) return std::nullopt;
      if ((*frame)->time < start_) continue;
      (*frame)->index = num_frames_++;
      return frame;
    }
  }

  Result<void> Rewind() override {
    num_frames_ = 0;
    return whole_->Rewind();
  }

 private:
  std::unique_ptr<FrameSource> whole_;
  SessionTime start_, end_;
  std::int64_t num_frames_ = 0;
  mutable FrameSourceInfo info_;  // the whole's, which changes as it is read
};

Result<std::unique_ptr<FrameSource>> OpenTakeFolder(const fs::path& folder,
                                                    const VideoOptions& options) {
  const Result<StoredTake> take = OpenTake(folder);
  if (!take) return tl::unexpected(take.error());
  const std::vector<std::string> cameras = take->cameras();
  if (cameras.empty()) return Fail(fmt::format("{}: the take has no camera", folder.string()));
  if (cameras.size() > 1)
    return Fail(fmt::format("{}: the take has {} cameras ({}); name the video's file",
                            folder.string(), cameras.size(), fmt::join(cameras, ", ")));
  return OpenCamera(*take, cameras[0], options);
}

}  // namespace

Result<std::unique_ptr<FrameSource>> OpenFrames(const std::vector<fs::path>& paths,
                                                const VideoOptions& options) {
  if (paths.empty()) return Fail("no pictures and no video are named");
  std::error_code error;
  if (paths.size() == 1 && fs::is_directory(paths[0], error)) {
    if (IsTakeFolder(paths[0])) return OpenTakeFolder(paths[0], options);
    auto pictures = PicturesIn(paths[0]);
    if (!pictures) return tl::unexpected(pictures.error());
    return OpenPictures(*std::move(pictures), options.color);
  }
  const auto is = [](MediaKind kind) {
    return [kind](const fs::path& path) { return MediaKindOf(path) == kind; };
  };
  const auto video = std::find_if(paths.begin(), paths.end(), is(MediaKind::kVideo));
  const auto picture = std::find_if(paths.begin(), paths.end(), is(MediaKind::kPicture));
  if (video != paths.end() && picture != paths.end())
    return Fail(fmt::format("{} is a picture and {} a video; name one kind at a time",
                            picture->string(), video->string()));
  // Among pictures one may be broken: that is for Next() to say.
  if (picture != paths.end()) return OpenPictures(paths, options.color);
  return OpenVideo(paths, options);
}

Result<std::unique_ptr<FrameSource>> OpenCamera(const StoredTake& take, std::string_view camera,
                                                VideoOptions options) {
  const std::vector<TakeFile> files = take.VideoOf(camera);
  if (files.empty())
    return Fail(fmt::format("{}: the take has no camera {}; it has {}", take.folder.string(),
                            camera, fmt::join(take.cameras(), ", ")));
  std::vector<fs::path> paths;
  for (const TakeFile& file : files) {
    if (const auto fault = FaultOf(take, file)) return Fail(*fault + "; put it back from a copy");
    paths.push_back(take.PathOf(file));
  }
  options.start = SessionTime(files[0].offset);
  auto source = OpenVideo(paths, options);
  if (!source || !take.info.part) return source;
  return std::make_unique<PartSource>(*std::move(source), *take.info.part);
}

}  // namespace articap
