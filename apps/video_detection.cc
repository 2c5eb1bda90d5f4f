// SPDX-License-Identifier: MIT
#include "apps/video_detection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <future>
#include <iterator>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "core/parallel.h"

namespace articap {
namespace {

// Whether most of a picture is as bright as the file can say, by a hundredth of its pixels.
bool IsOverexposed(const ImageView& image) {
  constexpr int kStep = 10;
  constexpr int kBrightest = 235;  // white, of video of limited range
  const int bytes = BytesPerPixel(image.format);
  int looked_at = 0, bright = 0;
  for (int y = 0; y < image.height; y += kStep)
    for (int x = 0; x < image.width; x += kStep) {
      const std::uint8_t* const pixel = image.row(y) + static_cast<std::ptrdiff_t>(x) * bytes;
      std::uint16_t wide = 0;
      if (image.format == PixelFormat::kGray16) std::memcpy(&wide, pixel, sizeof wide);
      const int level = image.format == PixelFormat::kGray16 ? wide >> 8
                        : image.format == PixelFormat::kRgb8
                            ? std::min({pixel[0], pixel[1], pixel[2]})
                            : pixel[0];
      ++looked_at;
      if (level >= kBrightest) ++bright;
    }
  return bright > looked_at / 2;
}

// What one frame shows.
struct FrameFindings {
  std::vector<Dot> dots;
  double perspective2_px2 = 0;
  bool too_many = false;
  bool is_overexposed = false;
};

FrameFindings FindingsIn(const Frame& frame, const Lens& lens,
                         const PerspectiveOptions& perspective, DotDetector& detector) {
  FrameFindings found;
  found.dots = detector.Detect(frame.image, frame.picture_from_image);
  for (Dot& dot : found.dots) {
    const double moved_px = CorrectPerspective(lens, perspective, dot);
    found.perspective2_px2 += moved_px * moved_px;
  }
  found.too_many = detector.report().too_many;
  found.is_overexposed = IsOverexposed(frame.image);
  return found;
}

void Add(const Frame& frame, FrameFindings found, DetectedVideo& result) {
  result.video.pictures.push_back({frame.index, frame.time, std::move(found.dots)});
  result.perspective2_px2 += found.perspective2_px2;
  if (found.too_many) ++result.crowded;
  if (found.is_overexposed) ++result.overexposed;
  if (frame.status == FrameStatus::kCorrupt) ++result.damaged;
}

// Detectors that share a video's frames.
class ParallelDetector {
 public:
  ParallelDetector(const Lens& lens, const DetectionOptions& options)
      : lens_(lens), perspective_(options.perspective) {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    for (int i = 0; i < threads; ++i) detectors_.emplace_back(options.dots);
  }

  // How many frames are worth sharing out.
  std::size_t batch_size() const { return 8 * detectors_.size(); }

  void Detect(std::span<const StoredFrame> frames, DetectedVideo& result) {
    std::vector<FrameFindings> found(frames.size());
    const auto step = static_cast<int>(detectors_.size());
    ParallelFor(step, step, [&](int worker) {
      for (std::size_t i = worker; i < frames.size(); i += detectors_.size())
        found[i] = FindingsIn(frames[i].frame(), lens_, perspective_, detectors_[worker]);
    });
    for (std::size_t i = 0; i < frames.size(); ++i)
      Add(frames[i].frame(), std::move(found[i]), result);
  }

 private:
  const Lens& lens_;
  PerspectiveOptions perspective_;
  std::vector<DotDetector> detectors_;
};

// Keeps pictures as long as there is room for all of them.
class PictureKeeper {
 public:
  explicit PictureKeeper(std::size_t& room_bytes)
      : room_bytes_(room_bytes),
        video_(room_bytes > 0 ? std::make_shared<StoredVideo>() : nullptr) {}

  // Leaves the frames to be overwritten where they are not kept.
  void Offer(std::vector<StoredFrame>& frames) {
    if (!video_) return;
    for (const StoredFrame& frame : frames) bytes_ += frame.num_bytes();
    if (bytes_ > room_bytes_) {
      video_.reset();
      return;
    }
    std::move(frames.begin(), frames.end(), std::back_inserter(video_->frames));
    frames.clear();
  }

  std::shared_ptr<const StoredVideo> Finish(const FrameSourceInfo& info) {
    if (!video_) return nullptr;
    room_bytes_ -= bytes_;
    video_->info = info;
    return std::move(video_);
  }

 private:
  std::size_t& room_bytes_;
  std::size_t bytes_ = 0;
  std::shared_ptr<StoredVideo> video_;
};

// Fills `frames` anew, with fewer than so many only at the end or where there is a fault.
Result<void> ReadBatch(FrameSource& source, std::size_t most, std::vector<StoredFrame>& frames) {
  for (std::size_t i = 0; i < most; ++i) {
    const Result<std::optional<Frame>> frame = source.Next();
    if (!frame || !*frame) {
      frames.resize(i);
      if (!frame) return tl::unexpected(frame.error());
      return {};
    }
    if (i == frames.size()) frames.emplace_back();
    frames[i].Store(**frame);
  }
  return {};
}

DetectedVideo Begin(const NamedSource& named) {
  const FrameSourceInfo& info = named.source->info();
  DetectedVideo result;
  result.video = {.camera = named.name,
                  .width = info.width,
                  .height = info.height,
                  .rate_hz = info.rate_hz,
                  .constant_rate = info.constant_rate};
  result.notes = info.notes;
  result.frames_promised = info.frames;
  return result;
}

}  // namespace

Result<DetectedVideo> DetectVideo(NamedSource& named, const Lens& lens,
                                  const DetectionOptions& options, std::size_t& room_bytes,
                                  Progress& progress) {
  DetectedVideo result = Begin(named);
  ParallelDetector detector(lens, options);
  PictureKeeper keeper(room_bytes);
  const std::size_t batch = detector.batch_size();
  std::vector<StoredFrame> coming, looked_at;
  std::future<void> detection;
  const auto finish = [&] {
    if (detection.valid()) detection.get();
    keeper.Offer(looked_at);
  };
  Result<void> read;
  for (std::size_t frames = 0; read; frames += batch) {
    // While the dots of the last ones are found, the next are decoded.
    read = ReadBatch(*named.source, batch, coming);
    finish();
    coming.swap(looked_at);
    detection = std::async(std::launch::async, [&] { detector.Detect(looked_at, result); });
    if (looked_at.size() < batch) break;
    if (result.frames_promised > 0)
      progress.SetPart(static_cast<double>(frames) / static_cast<double>(result.frames_promised));
  }
  finish();
  // What came before a fault stays good: half a recording is better than none.
  if (!read && result.video.pictures.empty()) return tl::unexpected(read.error());
  if (!read) {
    result.notes.push_back(fmt::format("{}; tracked up to there", read.error().message));
    result.frames_promised = -1;
  }
  result.pictures = keeper.Finish(named.source->info());
  return result;
}

}  // namespace articap
