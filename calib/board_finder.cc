// SPDX-License-Identifier: MIT
#include "calib/board_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <map>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "calib/board_pattern.h"
#include "calib/gray_picture.h"
#include "core/file_io.h"

namespace articap {
namespace {

// What became of a picture.
struct Outcome {
  std::string source;
  Eigen::Vector2i size = Eigen::Vector2i::Zero();  // px; zero where none could be read
  std::string reason;                              // why it shows no board
  std::vector<FoundBoard> found;
};

// A picture that waits to be looked at, with pixels of its own.
struct Picture {
  std::size_t outcome = 0;  // index
  BoardSighting sighting;   // without corners yet
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

// The commonest; of several the one that came first.
Eigen::Vector2i UsualSize(const std::vector<Outcome>& outcomes) {
  Eigen::Vector2i usual = Eigen::Vector2i::Zero();
  std::ptrdiff_t most = 0;
  for (const Outcome& outcome : outcomes) {
    if (outcome.size.isZero() || outcome.size == usual) continue;
    const auto count = std::count_if(outcomes.begin(), outcomes.end(), [&](const Outcome& other) {
      return other.size == outcome.size;
    });
    if (count > most) std::tie(usual, most) = std::pair(outcome.size, count);
  }
  return usual;
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
    if (out_.pictures > 0) return Summarize();
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
      outcomes_.push_back({.reason = last_failure_});
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
    picture.outcome = outcomes_.size();
    picture.sighting.source =
        frame.name.empty()
            ? fmt::format("{}, frame {}", std::filesystem::path(out_.camera).filename().string(),
                          frame.index)
            : frame.name;
    picture.sighting.frame = frame.index;
    picture.sighting.time = frame.time;
    Outcome& outcome = outcomes_.emplace_back();
    outcome.source = picture.sighting.source;
    if (frame.status == FrameStatus::kCorrupt) {
      outcome.reason = "damaged: not all of it could be decoded";
      return;
    }
    if (frame.image.empty()) {
      outcome.reason = "empty";
      return;
    }
    outcome.size = PictureSize(frame.image, frame.picture_from_image);
    picture.image = CopyOf(frame.image);
    picture.picture_from_image = frame.picture_from_image;
    const auto& bytes = picture.image.bytes;
    const std::string hash =
        HashOf(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    const auto [earlier, is_new] = source_of_hash_.emplace(hash, outcome.source);
    if (is_new)
      waiting_.push_back(std::move(picture));
    else
      outcome.reason = fmt::format("the same picture as {}", earlier->second);
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
    for (int i = 0; i < count; ++i) Keep(waiting_[i], results[i]);
    waiting_.clear();
  }

  void Keep(const Picture& picture, DetectionResult& result) {
    Outcome& outcome = outcomes_[picture.outcome];
    outcome.reason = std::move(result.reason);
    for (DetectedBoard& board : result.boards) {
      FoundBoard found{picture.sighting, std::move(board.sigmas_px), board.quality};
      found.sighting.mirrored = board.mirrored;
      found.sighting.corners = std::move(board.corners);
      found.sighting.points_px = std::move(board.points_px);
      outcome.found.push_back(std::move(found));
    }
  }

  Sightings Summarize() {
    const Eigen::Vector2i usual = UsualSize(outcomes_);
    std::tie(out_.width, out_.height) = std::pair(usual.x(), usual.y());
    for (Outcome& outcome : outcomes_) {
      if (!outcome.size.isZero() && outcome.size != usual)
        out_.set_aside.push_back(
            {outcome.source,
             fmt::format("{} x {} px, the others {} x {}; one camera has one size",
                         outcome.size.x(), outcome.size.y(), usual.x(), usual.y())});
      else if (outcome.found.empty())
        out_.set_aside.push_back({outcome.source, outcome.reason});
      else
        std::move(outcome.found.begin(), outcome.found.end(), std::back_inserter(out_.found));
    }
    return std::move(out_);
  }

  FrameSource& source_;
  const BoardSpec& board_;
  const DetectorOptions& options_;
  const std::function<void(double)>& progress_;
  Sightings out_;
  std::vector<Outcome> outcomes_;  // in the order of the pictures
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
