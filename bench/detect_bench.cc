// SPDX-License-Identifier: MIT
// Dots in pictures of a face, 1920x1080 in grey, one thread, beside OpenCV's SimpleBlobDetector at
// equal recall. Frames are cycled through more than 256 MB, as those of a video are.
#include <benchmark/benchmark.h>

#include <cstring>
#include <opencv2/features2d.hpp>

#include "tests/support/face_dots.h"
#include "tracking/dot_detector.h"

namespace articap {
namespace {

// Of a face that is known: the dots are about 13 px wide, seen at no more than 60 degrees.
constexpr double kMinDiameter_px = 6;
constexpr double kMaxDiameter_px = 22;
constexpr int kPoses = 16;
constexpr int kCopies = 9;  // of each, 299 MB in all

const std::vector<FaceDotPicture>& Poses() {
  static const std::vector<FaceDotPicture> poses = RenderFaceDots({.pictures = kPoses});
  return poses;
}

const std::vector<Image>& Frames() {
  static const std::vector<Image> frames = [] {
    std::vector<Image> all;
    for (int copy = 0; copy < kCopies; ++copy)
      for (const FaceDotPicture& pose : Poses()) all.push_back(pose.image);
    return all;
  }();
  return frames;
}

void Score(benchmark::State& state,
           const std::function<std::vector<Eigen::Vector2d>(const Image&)>& detect) {
  DotScore score;
  for (const FaceDotPicture& pose : Poses()) score.Add(pose, detect(pose.image));
  state.counters["recall"] = score.recall();
  state.counters["precision"] = score.precision();
  state.counters["frames_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

DotDetectorOptions FaceOptions() {
  DotDetectorOptions options;
  options.min_diameter_px = kMinDiameter_px;
  options.max_diameter_px = kMaxDiameter_px;
  options.min_contrast = 0.2;
  options.max_blur_px = 1;
  return options;
}

void BM_Dots(benchmark::State& state) {
  DotDetector detector(FaceOptions());
  detector.set_simd_level(static_cast<SimdLevel>(state.range(0)));
  Frames();  // rendered before the clock runs
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(detector.Detect(Frames()[next].view(), {}));
    next = (next + 1) % Frames().size();
  }
  Score(state, [&](const Image& image) { return CentersOf(detector.Detect(image.view(), {})); });
  state.SetLabel(NameOf(detector.simd_level()));
}
BENCHMARK(BM_Dots)
    ->DenseRange(static_cast<int>(SimdLevel::kNone), static_cast<int>(BestSimdLevel()))
    ->Unit(benchmark::kMillisecond);

// One blob by one, as often as its thresholds are; tuned for speed as long as its recall and
// precision are at least 0.99.
cv::SimpleBlobDetector::Params BlobParameters() {
  cv::SimpleBlobDetector::Params parameters;
  parameters.blobColor = 255;
  parameters.minThreshold = 100;
  parameters.maxThreshold = 250;
  parameters.thresholdStep = 25;
  parameters.minRepeatability = 2;
  parameters.minDistBetweenBlobs = 5;
  parameters.minArea = 20;
  parameters.maxArea = 400;
  parameters.filterByCircularity = true;
  parameters.minCircularity = 0.6f;
  parameters.filterByInertia = true;
  parameters.minInertiaRatio = 0.15f;
  parameters.filterByConvexity = true;
  parameters.minConvexity = 0.8f;
  return parameters;
}

void BM_DotsBySimpleBlobDetector(benchmark::State& state) {
  cv::setNumThreads(1);
  const auto detector = cv::SimpleBlobDetector::create(BlobParameters());
  const auto detect = [&](const Image& image) {
    const cv::Mat picture(image.height, image.width, CV_8UC1,
                          const_cast<std::uint8_t*>(image.bytes.data()));
    std::vector<cv::KeyPoint> points;
    detector->detect(picture, points);
    std::vector<Eigen::Vector2d> centers;
    for (const cv::KeyPoint& point : points) centers.emplace_back(point.pt.x, point.pt.y);
    return centers;
  };
  Frames();  // rendered before the clock runs
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(detect(Frames()[next]));
    next = (next + 1) % Frames().size();
  }
  Score(state, detect);
}
BENCHMARK(BM_DotsBySimpleBlobDetector)->Unit(benchmark::kMillisecond);

// What memory alone allows: every byte of the same frames, once.
void BM_ReadingFrames(benchmark::State& state) {
  Frames();  // rendered before the clock runs
  std::size_t next = 0;
  for (auto _ : state) {
    const Image& frame = Frames()[next];
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i + sizeof(sum) <= frame.bytes.size(); i += sizeof(sum)) {
      std::uint64_t word;
      std::memcpy(&word, frame.bytes.data() + i, sizeof(word));
      sum += word;
    }
    benchmark::DoNotOptimize(sum);
    next = (next + 1) % Frames().size();
  }
  state.counters["frames_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(BM_ReadingFrames)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace articap
