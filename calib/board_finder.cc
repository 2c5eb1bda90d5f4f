// SPDX-License-Identifier: MIT
#include "calib/board_finder.h"

#include <fmt/format.h>

#include <cstring>
#include <map>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "calib/board_pattern.h"
#include "calib/gray_picture.h"
#include "core/file_io.h"

namespace articap {
namespace {

// A picture that waits to be looked at, with pixels of its own.
struct Picture {
  BoardSighting sighting;  // without corners yet
  Image image;
  PictureFromImage picture_from_image;
};

// Enough to keep the processors busy, few enough to be held in memory.
constexpr std::size_t kPicturesAtATime = 16;

Image CopyOf(const ImageView& view) {
  Image image(view.format, view.width, view.height);
  const std::size_t row_bytes = static_cast<std::size_t>(view.width) * BytesPerPixel(view.format);
  for (int y = 0; y < view.height; ++y) std::memcpy(image.row(y), view.row(y), row_bytes);
  return image;
}

class Finder {
 public:
  Finder(FrameSource& source, const BoardSpec& board, const DetectorOptions& options,
         const std::function<void(double)>& progress)
      : source_(source), board_(board), options_(options), progress_(progress) {
    out_.camera = source.info().name;
    out_.is_video = source.info().rate_hz > 0;
  }

  Result<Sightings> Find() {
    bool more = true;
    while (more) {
      more = ReadNext();
      if (!more || waiting_.size() == kPicturesAtATime) LookAtWaiting();
    }
    if (out_.pictures > 0) return std::move(out_);
    if (!last_failure_.empty()) return Fail(last_failure_);
    return Fail(fmt::format("{}: holds no picture; give pictures or a video of the board",
                            source_.info().name));
  }

 private:
  // False at the end.
  bool ReadNext() {
    const Result<std::optional<Frame>> frame = source_.Next();
    if (!frame) {
      // A source that says the same again does not get on.
      if (frame.error().message == last_failure_) return false;
      last_failure_ = frame.error().message;
      LookAtWaiting();
      out_.set_aside.push_back({out_.camera, last_failure_});
      return true;
    }
    if (!frame->has_value()) return false;
    ++out_.pictures;
    Take(**frame);
    if (progress_ && source_.info().frames > 0)
      progress_(static_cast<double>(out_.pictures) / static_cast<double>(source_.info().frames));
    return true;
  }

  void Take(const Frame& frame) {
    Picture picture;
    picture.sighting.source =
        frame.name.empty() ? fmt::format("{}, frame {}", out_.camera, frame.index) : frame.name;
    picture.sighting.frame = frame.index;
    picture.sighting.time = frame.time;
    if (const auto reason = ReasonAgainst(frame)) {
      LookAtWaiting();
      out_.set_aside.push_back({picture.sighting.source, *reason});
      return;
    }
    picture.image = CopyOf(frame.image);
    picture.picture_from_image = frame.picture_from_image;
    const auto& bytes = picture.image.bytes;
    const std::string hash =
        HashOf(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    const auto [earlier, is_new] = source_of_hash_.emplace(hash, picture.sighting.source);
    if (is_new) {
      waiting_.push_back(std::move(picture));
      return;
    }
    LookAtWaiting();
    out_.set_aside.push_back(
        {picture.sighting.source, fmt::format("the same picture as {}", earlier->second)});
  }

  std::optional<std::string> ReasonAgainst(const Frame& frame) {
    if (frame.status == FrameStatus::kCorrupt) return "damaged: not all of it could be decoded";
    if (frame.image.empty()) return "empty";
    const Eigen::Vector2i size = PictureSize(frame.image, frame.picture_from_image);
    if (out_.width == 0) {
      out_.width = size.x();
      out_.height = size.y();
    }
    if (size == Eigen::Vector2i(out_.width, out_.height)) return std::nullopt;
    return fmt::format("{} x {} px, and the first picture {} x {}; one camera has one size",
                       size.x(), size.y(), out_.width, out_.height);
  }

  void LookAtWaiting() {
    const int count = static_cast<int>(waiting_.size());
    std::vector<DetectionResult> results(waiting_.size());
    const auto look = [&](const cv::Range& range) {
      for (int i = range.start; i < range.end; ++i)
        results[i] =
            DetectBoard(waiting_[i].image.view(), waiting_[i].picture_from_image, board_, options_);
    };
    cv::parallel_for_(cv::Range(0, count), look, count);
    for (int i = 0; i < count; ++i) Keep(waiting_[i].sighting, results[i]);
    waiting_.clear();
  }

  void Keep(const BoardSighting& picture, DetectionResult& result) {
    if (result.boards.empty()) out_.set_aside.push_back({picture.source, result.reason});
    for (DetectedBoard& board : result.boards) {
      FoundBoard found{picture, std::move(board.sigmas_px), board.quality};
      found.sighting.mirrored = board.mirrored;
      found.sighting.corners = std::move(board.corners);
      found.sighting.points_px = std::move(board.points_px);
      out_.found.push_back(std::move(found));
    }
  }

  FrameSource& source_;
  const BoardSpec& board_;
  const DetectorOptions& options_;
  const std::function<void(double)>& progress_;
  Sightings out_;
  std::vector<Picture> waiting_;
  std::map<std::string, std::string> source_of_hash_;
  std::string last_failure_;
};

}  // namespace

Result<Sightings> FindBoards(FrameSource& source, const BoardSpec& board,
                             const DetectorOptions& options,
                             const std::function<void(double)>& progress) {
  if (const auto good = CheckOptions(options); !good) return tl::unexpected(good.error());
  if (const auto pattern = PatternOf(board); !pattern) return tl::unexpected(pattern.error());
  return Finder(source, board, options, progress).Find();
}

}  // namespace articap
