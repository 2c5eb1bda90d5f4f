// SPDX-License-Identifier: MIT
// Writes pictures to calibrate from, and the truth behind them:
//   articap_calibration_pictures FOLDER --kind lens|rig|mirror|wand [--seed N] [--pictures N]
//                                [--width PX]
// FOLDER/<camera>/<number>.png are 8-bit grey, 16:9; board.txt names the board (or wand.txt the
// wand's length in mm); cameras.csv, mirrors.csv and points.csv are the truth.
#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "core/file_io.h"
#include "synthetic/board_session.h"
#include "synthetic/camera_rigs.h"
#include "synthetic/random.h"
#include "synthetic/random_streams.h"
#include "synthetic/wand_scene.h"

namespace articap {
namespace {

struct Request {
  std::filesystem::path folder;
  std::string kind;
  std::uint64_t seed = 1;
  int pictures = 20;
  int width = 1280;  // px; small pictures are soon made

  CameraModel Model() const {
    const CameraModel full;
    return {width, width * 9 / 16, full.focal_px * width / full.width};
  }
};

std::string CamerasCsv(const CameraArray& array) {
  std::string text =
      "camera,width_px,height_px,fx_px,fy_px,cx_px,cy_px,k1,k2,p1,p2,k3,k4,k5,k6,"
      "cam_from_stage_qw,qx,qy,qz,tx_mm,ty_mm,tz_mm,time_offset_s\n";
  for (const Camera& camera : array.cameras) {
    const Lens& lens = camera.lens;
    const Rigid3d& pose = camera.cam_from_stage;
    text +=
        fmt::format("{},{},{},{},{},{},{},{}", camera.name, camera.width, camera.height, lens.fx_px,
                    lens.fy_px, lens.cx_px, lens.cy_px, fmt::join(lens.distortion, ","));
    text += fmt::format(",{},{},{},{},{},{},{},{}\n", pose.rotation.w(), pose.rotation.x(),
                        pose.rotation.y(), pose.rotation.z(), pose.translation_mm.x(),
                        pose.translation_mm.y(), pose.translation_mm.z(), camera.time_offset_s);
  }
  return text;
}

std::string MirrorsCsv(const CameraArray& array) {
  std::string text = "mirror,camera,normal_x,normal_y,normal_z,distance_mm,glass_mm,glass_index\n";
  for (const Mirror& mirror : array.mirrors)
    text += fmt::format("{},{},{},{},{},{},{},{}\n", mirror.name, array.cameras[mirror.camera].name,
                        mirror.normal_in_stage.x(), mirror.normal_in_stage.y(),
                        mirror.normal_in_stage.z(), mirror.distance_mm, mirror.glass_mm,
                        mirror.glass_index);
  return text;
}

// Collects what the pictures show; one row a point.
class PointsCsv {
 public:
  void Add(const CameraArray& array, int picture, const ViewTruth& truth) {
    for (std::size_t point = 0; point < truth.points_px.size(); ++point)
      text_ += fmt::format("{},{},{},{:.5f},{:.5f},{}\n", picture, array.NameOf(truth.view), point,
                           truth.points_px[point].x(), truth.points_px[point].y(),
                           truth.visible[point] ? 1 : 0);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_ = "picture,view,point,x_px,y_px,visible\n";
};

Result<void> WritePicture(const Request& request, const Studio& studio, const Scene& scene,
                          int camera, int picture) {
  const auto path = request.folder / studio.cameras().array.cameras[camera].name /
                    fmt::format("{:04}.png", picture);
  const std::uint64_t picture_seed = PictureSeed(request.seed, camera, picture);
  return WritePng(studio.Photograph(scene, camera, MachineVision(), picture_seed).view(), path);
}

Result<void> WriteTruth(const Request& request, const CameraArray& array, const PointsCsv& points) {
  if (auto done = WriteFile(request.folder / "cameras.csv", CamerasCsv(array)); !done) return done;
  if (auto done = WriteFile(request.folder / "mirrors.csv", MirrorsCsv(array)); !done) return done;
  return WriteFile(request.folder / "points.csv", points.text());
}

SyntheticCameras CamerasOf(const Request& request) {
  if (request.kind == "lens") return RingOfCameras(1, request.seed, request.Model());
  if (request.kind == "rig") return RingOfCameras(4, request.seed, request.Model());
  return MirrorSetUp(4, request.seed, request.Model());
}

BoardSession SessionOf(const Request& request, const SyntheticCameras& cameras) {
  BoardSession session = BoardSessionFor(cameras);
  if (request.kind == "lens") session.ways[0].reach_mm = {180, 80, 180};
  return session;
}

Result<void> WriteBoardPictures(const Request& request) {
  const Studio studio(CamerasOf(request));
  const BoardSession session = SessionOf(request, studio.cameras());
  const CameraArray& array = studio.cameras().array;
  const BoardPattern pattern = SquaresOf(session.board);
  const auto poses = BoardPosesOf(studio, session, request.pictures, request.seed);
  if (!poses) return tl::unexpected(poses.error());
  PointsCsv points;
  for (int picture = 0; picture < request.pictures; ++picture) {
    const Rigid3d& stage_from_board = (*poses)[picture];
    for (const BoardTruth& truth : TruthOfBoard(studio, session.board, pattern, stage_from_board))
      points.Add(array, picture, truth.corners);
    const Scene scene = BoardScene(studio, pattern, stage_from_board);
    for (int camera = 0; camera < studio.num_cameras(); ++camera)
      if (auto done = WritePicture(request, studio, scene, camera, picture); !done) return done;
  }
  const std::string name = NameOf(session.board) + "\n";
  if (auto done = WriteFile(request.folder / "board.txt", name); !done) return done;
  return WriteTruth(request, array, points);
}

// Cameras that run freely: each looks at times of its own.
Result<void> WriteWandPictures(const Request& request) {
  constexpr double kRate_hz = 50;
  SyntheticCameras cameras = RingOfCameras(4, request.seed, request.Model());
  RandomGenerator random(request.seed, random_streams::kClocks);
  for (std::size_t i = 1; i < cameras.array.cameras.size(); ++i)
    cameras.array.cameras[i].time_offset_s = random.Uniform(-0.5, 0.5) / kRate_hz;
  const Studio studio(cameras);
  const CameraArray& array = studio.cameras().array;
  const Wand wand;
  const WandPath path(request.seed);
  PointsCsv points;
  for (int picture = 0; picture < request.pictures; ++picture)
    for (int camera = 0; camera < studio.num_cameras(); ++camera) {
      const double time_s = picture / kRate_hz + array.cameras[camera].time_offset_s;
      const Rigid3d stage_from_wand = path.StageFromWandAt(time_s);
      points.Add(array, picture, TruthOfWand(studio, wand, stage_from_wand)[camera]);
      const Scene scene = WandScene(studio, wand, stage_from_wand);
      if (auto done = WritePicture(request, studio, scene, camera, picture); !done) return done;
    }
  const std::string length = fmt::format("{}\n", wand.length_mm);
  if (auto done = WriteFile(request.folder / "wand.txt", length); !done) return done;
  return WriteTruth(request, array, points);
}

template <class Number>
bool ReadNumber(const char* text, Number& number) {
  const char* end = text + std::strlen(text);
  const auto [rest, error] = std::from_chars(text, end, number);
  return error == std::errc() && rest == end;
}

std::optional<Request> RequestOf(int argc, char** argv) {
  if (argc < 4 || argc % 2 != 0) return std::nullopt;
  Request request;
  request.folder = argv[1];
  for (int i = 2; i < argc; i += 2) {
    const std::string option = argv[i];
    const bool is_known = option == "--kind" ||
                          (option == "--seed" && ReadNumber(argv[i + 1], request.seed)) ||
                          (option == "--pictures" && ReadNumber(argv[i + 1], request.pictures)) ||
                          (option == "--width" && ReadNumber(argv[i + 1], request.width));
    if (!is_known) return std::nullopt;
    if (option == "--kind") request.kind = argv[i + 1];
  }
  for (const char* kind : {"lens", "rig", "mirror", "wand"})
    if (request.kind == kind && request.pictures > 0 && request.width > 0) return request;
  return std::nullopt;
}

}  // namespace
}  // namespace articap

int main(int argc, char** argv) {
  const auto request = articap::RequestOf(argc, argv);
  if (!request) {
    std::cerr << "usage: articap_calibration_pictures FOLDER --kind lens|rig|mirror|wand "
                 "[--seed N] [--pictures N] [--width PX]\n";
    return 2;
  }
  const auto written = request->kind == "wand" ? articap::WriteWandPictures(*request)
                                               : articap::WriteBoardPictures(*request);
  if (written) return 0;
  std::cerr << written.error().message << "\n";
  return 1;
}
