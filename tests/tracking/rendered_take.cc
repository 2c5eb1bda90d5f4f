// SPDX-License-Identifier: MIT
#include "tests/tracking/rendered_take.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "calib/board_detector.h"
#include "calib/mirror_calibration.h"
#include "core/marker_set.h"
#include "core/parallel.h"
#include "rig/default_head/default_head.h"
#include "synthetic/board_scene.h"
#include "synthetic/board_session.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"
#include "tracking/dot_detector.h"
#include "tracking/learn_template.h"
#include "tracking/reconstruct.h"

namespace articap {
namespace {

MarkerSet MapOf(const std::string& name) {
  return ReadMarkerSet(SourceFolder() / "maps" / (name + ".toml")).value();
}

SyntheticTake SpeakerOf(const RenderedTakeOptions& options, const FaceRig& head) {
  SyntheticTakeOptions take;
  take.seed = options.seed;
  take.speaker_ahead = true;
  take.speech.rate_hz = options.rate_hz;
  take.speech.rest_s = options.rest_s;
  if (options.turn_deg) take.head.max_rotation_deg = *options.turn_deg;
  take.speech.num_sentences =
      1 + static_cast<int>(static_cast<double>(options.num_frames) / options.rate_hz / 3);
  return SynthesizeTake(head, WithDots(MapOf(options.map), options.film.look), take).value();
}

}  // namespace

RenderedTake::Owner RenderedTake::OwnerOf(int frame, int camera, const Dot& dot,
                                          int expected) const {
  Owner owner;
  double least_px = dot.diameter_px() / 2;
  for (std::size_t view = 0; view < views.size(); ++view) {
    if (views[view].camera != camera) continue;
    for (int marker = 0; marker < static_cast<int>(names.size()); ++marker) {
      const DotTruth& truth = in_views[frame][view][marker];
      const double apart_px = (truth.center_px - dot.center_px).norm();
      if (!(truth.visible > 0 && apart_px < least_px)) continue;
      owner = {marker, truth.visible};
      least_px = apart_px;
      // Another may hide beside it.
      if (marker == expected && apart_px < dot.diameter_px() / 4) return owner;
    }
  }
  return owner;
}

int RenderedTake::CountViews(int frame, int marker, double least_visible) const {
  return static_cast<int>(
      std::count_if(in_views[frame].begin(), in_views[frame].end(),
                    [&](const auto& view) { return view[marker].visible >= least_visible; }));
}

RenderedTake RenderTake(const RenderedTakeOptions& options) {
  const FaceRig head = MakeDefaultHead().value();
  const FilmedSpeaker speaker(head, SpeakerOf(options, head), options.film.look);
  const Film film(speaker, Studio(options.cameras), options.film, MachineVision(),
                  static_cast<std::uint64_t>(options.seed));
  const StageTracks& tracks = speaker.take().markers.tracks;
  const int num_frames = std::min(options.num_frames, film.num_frames());
  RenderedTake take;
  take.names = tracks.names();
  take.views = options.cameras.array.views();
  take.rate_hz = options.rate_hz;
  take.rest_frames = static_cast<int>(options.rest_s * options.rate_hz);
  take.positions_mm.resize(num_frames);
  take.in_views.resize(num_frames);
  take.dots.assign(num_frames, std::vector<std::vector<Dot>>(options.cameras.array.cameras.size()));
  ParallelFor(num_frames, 0, [&](int frame) {
    const auto positions = tracks.positions_mm(frame);
    take.positions_mm[frame].assign(positions.begin(), positions.end());
    take.in_views[frame] = TruthOfDots(film.studio(), speaker.At(frame, film.studio()));
    for (int camera = 0; camera < film.studio().num_cameras(); ++camera)
      take.dots[frame][camera] = DotDetector({}).Detect(film.Picture(frame, camera).view(), {});
  });
  return take;
}

TrackedTake TrackTake(const RenderedTake& take, const CameraArray& array, const std::string& map) {
  TrackedTake tracked;
  tracked.clouds.rate_hz = take.rate_hz;
  tracked.clouds.frames = Reconstruct(array, take.dots, {});
  std::vector<int> frames(static_cast<std::size_t>(take.num_frames()));
  std::iota(frames.begin(), frames.end(), 0);
  auto learnt = LearnTemplate(tracked.clouds, LayoutOf(MapOf(map)).value(), frames,
                              LikelyAttitudes(array), {});
  if (!learnt) throw std::runtime_error(learnt.error().message);
  tracked.marker_template = std::move(*learnt);
  tracked.labelling = LabelClouds(tracked.clouds, tracked.marker_template, {});
  return tracked;
}

CameraArray CalibrateFromBoards(const SyntheticCameras& cameras, int num_pictures) {
  const Studio studio(cameras);
  const BoardSession session = BoardSessionFor(cameras);
  const std::vector<Rigid3d> poses = BoardPosesOf(studio, session, num_pictures, 1).value();
  const Camera& camera = cameras.array.cameras.front();
  std::vector<std::vector<DetectedBoard>> found(poses.size());
  ParallelFor(num_pictures, 0, [&](int picture) {
    DetectorOptions detect;
    detect.look_in_mirror = true;
    const Image image =
        studio.Photograph(BoardScene(studio, SquaresOf(session.board), poses[picture]), 0,
                          MachineVision(), PictureSeed(1, 0, picture));
    found[picture] = DetectBoard(image.view(), {}, session.board, detect).boards;
  });
  CameraSightings seen = {camera.name, camera.width, camera.height, {}, {}};
  for (int picture = 0; picture < num_pictures; ++picture)
    for (const DetectedBoard& board : found[picture])
      seen.sightings.push_back(
          {std::to_string(picture), picture, {}, board.mirrored, board.corners, board.points_px});
  MirrorOptions options;
  options.mirrors = static_cast<int>(cameras.array.mirrors.size());
  options.glass_mm = cameras.array.mirrors.front().glass_mm;
  const auto calibration = CalibrateMirror(session.board, seen, {}, options);
  if (!calibration) throw std::runtime_error(calibration.error().message);
  if (!calibration->report.IsUsable()) throw std::runtime_error(calibration->report.verdict);
  return calibration->output.array;
}

}  // namespace articap
