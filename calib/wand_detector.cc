// SPDX-License-Identifier: MIT
#include "calib/wand_detector.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "calib/gray_picture.h"
#include "calib/opencv_picture.h"
#include "core/natural_order.h"

namespace articap {
namespace {

// Of a picture that is mostly dark the background, and its brightest.
struct Levels {
  float background = 0;
  float brightest = 0;
};

Levels LevelsOf(const cv::Mat& gray) {
  std::vector<float> values;
  constexpr int kStride = 7;  // enough of them, in no step with any pattern of the rows
  const int count = gray.rows * gray.cols;
  values.reserve(gray.total() / kStride + 1);
  for (int i = 0; i < count; i += kStride)
    values.push_back(gray.at<float>(i / gray.cols, i % gray.cols));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  double brightest = 0;
  cv::minMaxLoc(gray, nullptr, &brightest);
  return {*middle, static_cast<float>(brightest)};
}

// The weighted centre of a spot, and whether it is round.
std::optional<Eigen::Vector2d> CentreOf(const cv::Mat& gray, const cv::Rect& box, float background,
                                        const SpotOptions& options) {
  // Its light reaches a little beyond the threshold.
  const int margin = 2 + std::max(box.width, box.height) / 4;
  const cv::Rect window =
      cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) &
      cv::Rect(0, 0, gray.cols, gray.rows);
  double sum = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (int y = window.y; y < window.y + window.height; ++y)
    for (int x = window.x; x < window.x + window.width; ++x) {
      const double light = gray.at<float>(y, x) - background;
      if (light <= 0) continue;
      const double weight = light * std::sqrt(light);
      const Eigen::Vector2d at(x, y);
      sum += weight;
      first += weight * at;
      second += weight * at * at.transpose();
    }
  if (!(sum > 0)) return std::nullopt;
  const Eigen::Vector2d centre = first / sum;
  const Eigen::Matrix2d spread = second / sum - centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> widths(spread);
  const double roundness =
      std::sqrt(std::max(0.0, widths.eigenvalues()(0)) / widths.eigenvalues()(1));
  if (!(roundness >= options.min_roundness)) return std::nullopt;
  return centre;
}

// Larger ones are times of day and the like, and no session is so long.
SessionTime NumberAsTime(const Frame& frame) {
  constexpr std::int64_t kMost = 1'000'000'000;
  const std::int64_t number = LastNumberIn(frame.name).value_or(kMost);
  return SessionTime(std::chrono::seconds(number < kMost ? number : frame.index));
}

}  // namespace

void VisitOptions(SpotOptions& options, OptionVisitor& visit) {
  visit("threshold", options.threshold,
        "what belongs to a marker: this part of the way from background to brightest, 0 to 1");
  visit("min_diameter_px", options.min_diameter_px, "smaller spots are no markers; px");
  visit("max_diameter_px", options.max_diameter_px, "larger spots are no markers; px");
  visit("min_roundness", options.min_roundness,
        "the smaller width of a marker over the larger, 0 to 1");
}

Result<void> CheckOptions(const SpotOptions& options) {
  if (!(options.threshold > 0 && options.threshold < 1))
    return Fail(fmt::format("threshold {}: give a part between 0 and 1", options.threshold));
  return RequirePositive(
      {{"min_diameter_px", options.min_diameter_px}, {"max_diameter_px", options.max_diameter_px}});
}

std::vector<Eigen::Vector2d> FindSpots(const ImageView& image,
                                       const PictureFromImage& picture_from_image,
                                       const SpotOptions& options) {
  GrayPicture picture = GrayPictureOf(image, picture_from_image);
  const cv::Mat gray = MatOf(picture);
  const Levels levels = LevelsOf(gray);
  // A picture without any marker has noise for its brightest.
  constexpr float kLeastContrast = 0.05f;
  if (levels.brightest - levels.background < kLeastContrast) return {};
  const double threshold =
      levels.background + options.threshold * (levels.brightest - levels.background);
  cv::Mat labels, boxes, centres;
  const int count = cv::connectedComponentsWithStats(gray > threshold, labels, boxes, centres);
  std::vector<Eigen::Vector2d> spots;
  for (int label = 1; label < count; ++label) {  // 0 is the background
    const cv::Rect box(
        boxes.at<int>(label, cv::CC_STAT_LEFT), boxes.at<int>(label, cv::CC_STAT_TOP),
        boxes.at<int>(label, cv::CC_STAT_WIDTH), boxes.at<int>(label, cv::CC_STAT_HEIGHT));
    const double diameter_px =
        std::sqrt(boxes.at<int>(label, cv::CC_STAT_AREA) * 4 / std::numbers::pi);
    if (diameter_px < options.min_diameter_px || diameter_px > options.max_diameter_px) continue;
    if (const auto centre = CentreOf(gray, box, levels.background, options))
      spots.push_back(*centre);
  }
  return spots;
}

Result<WandVideo> FindWand(FrameSource& source, const SpotOptions& options,
                           const std::function<void(double part)>& progress) {
  if (const auto checked = CheckOptions(options); !checked) return tl::unexpected(checked.error());
  WandVideo video;
  video.camera = source.info().name;
  video.has_times = source.info().rate_hz > 0;
  for (;;) {
    const Result<std::optional<Frame>> frame = source.Next();
    if (!frame) return tl::unexpected(frame.error());
    if (!*frame) return video;
    const std::string& name = (*frame)->name;
    const Eigen::Vector2i size = PictureSize((*frame)->image, (*frame)->picture_from_image);
    if (video.pictures.empty()) std::tie(video.width, video.height) = std::pair(size.x(), size.y());
    if (size != Eigen::Vector2i(video.width, video.height))
      return Fail(fmt::format(
          "{}: {} has {}x{} px, the first picture {}x{}; one camera has one size", video.camera,
          name.empty() ? "a frame" : name, size.x(), size.y(), video.width, video.height));
    video.pictures.push_back({video.has_times ? (*frame)->time : NumberAsTime(**frame),
                              FindSpots((*frame)->image, (*frame)->picture_from_image, options)});
    if (progress && source.info().frames > 0)
      progress(static_cast<double>(video.pictures.size()) /
               static_cast<double>(source.info().frames));
  }
}

}  // namespace articap
