// SPDX-License-Identifier: MIT
// Tracking as a whole: four cameras from memory, and a compressed 1080p video against decoding it
// alone.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "capture/open_frames.h"
#include "capture/video_writer.h"
#include "core/calibration_toml.h"
#include "core/file_io.h"
#include "core/marker_set.h"
#include "core/parallel.h"
#include "rig/default_head/default_head.h"
#include "synthetic/board_session.h"
#include "synthetic/film.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"
#include "tracking/dot_detector.h"
#include "tracking/label.h"
#include "tracking/learn_template.h"
#include "tracking/reconstruct.h"

namespace articap {
namespace {

MarkerSet MapOf(const std::string& name) {
  return ReadMarkerSet(SourceFolder() / "maps" / (name + ".toml")).value();
}

Film FilmOf(const SyntheticCameras& cameras, const std::string& map, double rate_hz,
            FilmOptions options) {
  options.look.retro_reflective = true;
  const FaceRig head = MakeDefaultHead().value();
  SyntheticTakeOptions take;
  take.speaker_ahead = true;
  take.speech.rate_hz = rate_hz;
  take.speech.rest_s = 0.2;
  take.speech.num_sentences = 1;
  const MarkerSet set = WithDots(MapOf(map), options.look);
  return Film(FilmedSpeaker(head, SynthesizeTake(head, set, take).value(), options.look),
              Studio(cameras), options, MachineVision(), 1);
}

// Pictures of four cameras; `copies` of each lie in memory, so that no cache holds them all.
struct FourCameras {
  static constexpr int kFrames = 24;
  static constexpr int kCopies = 10;

  FourCameras() {
    FilmOptions options;
    options.width = 640;
    options.height = 480;
    const SyntheticCameras cameras = RingOfCameras(4, 1, CameraModelOf(options));
    array = cameras.array;
    const Film film = FilmOf(cameras, "spectacles30", 60, options);
    std::vector<std::vector<Image>> filmed(kFrames, std::vector<Image>(array.cameras.size()));
    ParallelFor(kFrames * num_cameras(), 0, [&](int item) {
      const int frame = item / num_cameras(), camera = item % num_cameras();
      filmed[frame][camera] = film.Picture(frame, camera);
    });
    // There and back again, so that nothing jumps.
    for (int copy = 0; copy < kCopies; ++copy)
      for (int i = 0; i < kFrames; ++i)
        pictures.push_back(filmed[copy % 2 == 0 ? i : kFrames - 1 - i]);
  }

  int num_cameras() const { return static_cast<int>(array.cameras.size()); }
  int num_frames() const { return static_cast<int>(pictures.size()); }

  CameraArray array;
  std::vector<std::vector<Image>> pictures;  // by frame and camera
};

std::vector<InstantDots> DetectAll(const FourCameras& scene) {
  std::vector<InstantDots> dots(scene.pictures.size(), InstantDots(scene.array.cameras.size()));
  constexpr int kAtOnce = 10;  // frames, by one detector
  ParallelFor((scene.num_frames() + kAtOnce - 1) / kAtOnce, 0, [&](int part) {
    DotDetector detector({});
    for (int frame = part * kAtOnce; frame < std::min((part + 1) * kAtOnce, scene.num_frames());
         ++frame)
      for (int camera = 0; camera < scene.num_cameras(); ++camera)
        dots[frame][camera] = detector.Detect(scene.pictures[frame][camera].view(), {});
  });
  return dots;
}

MarkerTemplate TemplateFor(const std::vector<std::vector<CloudPoint>>& frames,
                           const CameraArray& array, const std::string& map, double rate_hz) {
  PointClouds clouds;
  clouds.rate_hz = rate_hz;
  clouds.frames = frames;
  return LearnTemplate(clouds, LayoutOf(MapOf(map)).value(), std::vector<int>{0},
                       LikelyAttitudes(array), {})
      .value();
}

int CountLabels(const Labelling& labelling) {
  int count = 0;
  for (const LabelledFrame& frame : labelling.frames) count += frame.num_labelled();
  return count;
}

const FourCameras& Scene() {
  static const FourCameras scene;
  return scene;
}

void SetRate(int frames, benchmark::State& state) {
  state.counters["frames_per_s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * frames, benchmark::Counter::kIsRate);
}

// From pictures to labels, the template known. On all processors; the time is the clock's.
void BM_FourCameras(benchmark::State& state) {
  const FourCameras& scene = Scene();
  const MarkerTemplate marker_template =
      TemplateFor(Reconstruct(scene.array, DetectAll(scene), {}), scene.array, "spectacles30", 60);
  int labels = 0;
  for (auto _ : state) {
    PointClouds clouds;
    clouds.rate_hz = 60;
    clouds.frames = Reconstruct(scene.array, DetectAll(scene), {});
    labels = CountLabels(LabelClouds(clouds, marker_template, {}));
  }
  SetRate(scene.num_frames(), state);
  state.counters["labelled"] = labels / 35.0 / scene.num_frames();
}
BENCHMARK(BM_FourCameras)->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(3);

void BM_FourCamerasDetection(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(DetectAll(Scene()));
  SetRate(Scene().num_frames(), state);
}
BENCHMARK(BM_FourCamerasDetection)->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(2);

void BM_FourCamerasReconstruction(benchmark::State& state) {
  const std::vector<InstantDots> dots = DetectAll(Scene());
  for (auto _ : state) benchmark::DoNotOptimize(Reconstruct(Scene().array, dots, {}));
  SetRate(Scene().num_frames(), state);
}
BENCHMARK(BM_FourCamerasReconstruction)->Unit(benchmark::kMillisecond)->UseRealTime();

// A face before a mirror as a camcorder of 1920x1080 compresses it; gone with the program.
class CamcorderVideo {
 public:
  CamcorderVideo() {
    FilmOptions options;
    options.width = 1920;
    options.height = 1080;
    const SyntheticCameras cameras = MirrorSetUp(0, 1, CameraModelOf(options));
    if (!WriteFile(calibration(), WriteCalibration(cameras.array))) std::abort();
    const Film film = FilmOf(cameras, "mirror6", 25, options);
    VideoFormat format;
    format.codec = VideoCodec::kH264;
    format.container = VideoContainer::kMp4;
    format.width = options.width;
    format.height = options.height;
    format.rate = ClosestRate(25);
    auto writer = VideoWriter::Create(path(), format).value();
    std::vector<Image> pictures(kFrames);
    ParallelFor(kFrames, 0, [&](int frame) { pictures[frame] = film.Picture(frame, 0); });
    for (int i = 0; i < kTimes * kFrames; ++i) {
      const int at = i % (2 * kFrames);
      if (!writer->Write(pictures[at < kFrames ? at : 2 * kFrames - 1 - at].view())) std::abort();
    }
    if (!writer->Finish()) std::abort();
  }
  ~CamcorderVideo() { std::filesystem::remove_all(folder_); }
  CamcorderVideo(const CamcorderVideo&) = delete;
  CamcorderVideo& operator=(const CamcorderVideo&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path path() const { return folder_ / "front.mp4"; }
  std::filesystem::path calibration() const { return folder_ / "calibration.toml"; }
  static int num_frames() { return kTimes * kFrames; }

  // Every frame goes through `use`.
  template <class Use>
  int Decode(const Use& use) const {
    const auto source = OpenFrames({path()}).value();
    int frames = 0;
    while (const auto frame = source->Next().value()) {
      use(*frame);
      ++frames;
    }
    return frames;
  }

 private:
  static constexpr int kFrames = 20, kTimes = 10;

  const std::filesystem::path folder_ = MakeTemporaryFolder("articap_track_bench");
};

const CamcorderVideo& Video() {
  static const CamcorderVideo video;
  return video;
}

void BM_DecodeAlone(benchmark::State& state) {
  const CamcorderVideo& video = Video();
  int frames = 0;
  for (auto _ : state)
    frames = video.Decode([](const Frame& frame) { benchmark::DoNotOptimize(frame); });
  SetRate(frames, state);
}
BENCHMARK(BM_DecodeAlone)->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(3);

// The command as a whole, with its reports and pictures of `doubtful` places.
void BM_TrackCommand(benchmark::State& state) {
  const CamcorderVideo& video = Video();
  const std::string command =
      fmt::format("{} track {} --cameras {} --map mirror6 --doubtful {} -o {} > /dev/null",
                  ARTICAP_PROGRAM, video.path().string(), video.calibration().string(),
                  state.range(0), (video.folder() / "out.c3d").string());
  for (auto _ : state)
    if (std::system(command.c_str()) != 0) state.SkipWithError("articap track fails");
  SetRate(video.num_frames(), state);
}
BENCHMARK(BM_TrackCommand)
    ->Arg(24)
    ->Arg(0)
    ->ArgName("doubtful")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MinTime(3);

}  // namespace
}  // namespace articap
