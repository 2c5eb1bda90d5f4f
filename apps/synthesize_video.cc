// SPDX-License-Identifier: MIT
#include "apps/synthesize_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/progress.h"
#include "core/calibration_toml.h"
#include "core/file_io.h"
#include "render/picture.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

// Frames that are worked on at a time; what comes of them does not depend on it.
constexpr int kAtOnce = 2;

// Calls use(make(0)), use(make(1)), ... in their order; make in several threads.
template <class Make, class Use>
Result<void> ForEachInOrder(const std::string& what, int count, const Make& make, const Use& use) {
  return WithProgress(what, [&](Progress& progress) -> Result<void> {
    for (int first = 0; first < count; first += kAtOnce) {
      std::vector<std::future<decltype(make(0))>> made;
      for (int i = first; i < std::min(first + kAtOnce, count); ++i)
        made.push_back(std::async(std::launch::async, [&make, i] { return make(i); }));
      for (auto& future : made)
        if (Result<void> used = use(future.get()); !used) return used;
      progress.SetPart(static_cast<double>(first) / count);
    }
    return {};
  });
}

Result<void> WriteVideo(const Film& film, int camera, const VideoFormat& format,
                        const fs::path& path) {
  auto writer = VideoWriter::Create(path, format);
  if (!writer) return tl::unexpected(writer.error());
  const std::string& name = film.studio().cameras().array.cameras[camera].name;
  const auto written = ForEachInOrder(
      fmt::format("filming {} frames by {}", film.num_frames(), name), film.num_frames(),
      [&](int frame) { return film.Picture(frame, camera); },
      [&](const Image& image) { return (*writer)->Write(image.view()); });
  return written ? (*writer)->Finish() : written;
}

Result<void> WriteDots(const Film& film, const fs::path& path) {
  std::string text = Film::DotsHeader();
  const auto made = ForEachInOrder(
      "seeing which dots are seen", film.num_frames(),
      [&](int frame) { return film.DotsOf(frame); },
      [&](const std::string& lines) {
        text += lines;
        return Result<void>();
      });
  return made ? WriteFile(path, text) : made;
}

// What the pictures of a board are made of.
struct BoardPictures {
  BoardSession session;
  std::vector<Rigid3d> stage_from_board;
  SensorOptions sensor;
  std::uint64_t seed = 0;
};

Result<void> AddBoards(const std::shared_ptr<const Film>& film, BoardPictures pictures,
                       const fs::path& folder, OutputSet& outputs) {
  outputs.Add(folder / "board.txt", NameOf(pictures.session.board) + "\n");
  const auto shared = std::make_shared<const BoardPictures>(std::move(pictures));
  const Studio& studio = film->studio();
  for (int camera = 0; camera < studio.num_cameras(); ++camera)
    for (std::size_t i = 0; i < shared->stage_from_board.size(); ++i)
      outputs.AddWriter(
          folder / studio.cameras().array.cameras[camera].name / fmt::format("{:04}.png", i + 1),
          [film, shared, camera, i](const fs::path& path) {
            const Scene scene = BoardScene(film->studio(), SquaresOf(shared->session.board),
                                           shared->stage_from_board[i]);
            const std::uint64_t seed = PictureSeed(shared->seed, camera, static_cast<int>(i));
            return WritePng(film->studio().Photograph(scene, camera, shared->sensor, seed).view(),
                            path);
          });
  return {};
}

}  // namespace

void VisitOptions(SynthesizeVideoOptions& options, OptionVisitor& visit) {
  visit("video", options.cameras,
        "film the speaker: mirror, two-mirrors, or ring4 for a ring of four cameras (1 to 16)");
  visit.Enumeration("codec", options.codec, {"ffv1", "h264"}, "lossless, or as camcorders have it");
  visit("crf", options.crf, "quality of H.264: 0 best to 51 worst");
  visit("boards", options.boards, "pictures of a board by the same cameras, to calibrate from");
  VisitOptions(options.film, visit);
}

Result<void> CheckOptions(const SynthesizeVideoOptions& options, const SensorOptions& sensor,
                          double rate_hz) {
  if (options.boards < 0)
    return Fail(fmt::format("boards is {}; it must be 0 or more", options.boards));
  if (options.boards > 0 && options.cameras.empty())
    return Fail("boards are photographed by the cameras of --video; name these too");
  if (sensor.format == PixelFormat::kRgb8)
    return Fail("sensor_format is rgb8; videos are written in grey: gray8 or gray16");
  if (auto valid = CheckOptions(sensor); !valid) return valid;
  return CheckOptions(options.film, rate_hz);
}

Result<void> AddVideo(const FilmedSpeaker& speaker, const SynthesizeVideoOptions& options,
                      const SensorOptions& sensor, int seed, const fs::path& folder,
                      OutputSet& outputs) {
  const auto take_seed = static_cast<std::uint64_t>(seed);
  auto cameras =
      CamerasByName(options.cameras, options.film.glass_mm, take_seed, CameraModelOf(options.film));
  if (!cameras) return tl::unexpected(cameras.error());
  const auto film = std::make_shared<const Film>(speaker, Studio(*std::move(cameras)), options.film,
                                                 sensor, take_seed);
  const CameraArray& array = film->studio().cameras().array;
  VideoFormat format;
  format.codec = options.codec;
  format.crf = options.crf;
  if (options.codec == VideoCodec::kH264) format.container = VideoContainer::kMp4;
  format.width = options.film.width;
  format.height = options.film.height;
  format.pixels = sensor.format;
  format.rate = ClosestRate(speaker.take().truth.rate_hz);
  const char* const ending = options.codec == VideoCodec::kH264 ? ".mp4" : ".mkv";
  for (std::size_t camera = 0; camera < array.cameras.size(); ++camera)
    outputs.AddWriter(folder / (array.cameras[camera].name + ending),
                      [film, camera, format](const fs::path& path) {
                        return WriteVideo(*film, static_cast<int>(camera), format, path);
                      });
  outputs.Add(folder / "truth.calibration.toml", WriteCalibration(array));
  outputs.AddWriter(folder / "truth.dots.csv",
                    [film](const fs::path& path) { return WriteDots(*film, path); });
  if (options.boards == 0) return {};
  BoardPictures boards{BoardSessionFor(film->studio().cameras()), {}, sensor, take_seed};
  auto poses = BoardPosesOf(film->studio(), boards.session, options.boards, take_seed);
  if (!poses) return tl::unexpected(poses.error());
  boards.stage_from_board = *std::move(poses);
  return AddBoards(film, std::move(boards), folder / "boards", outputs);
}

}  // namespace articap
