// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/verb_line.h"
#include "calib/board_detector.h"
#include "calib/calibration.h"
#include "calib/view_choice.h"
#include "core/board.h"
#include "core/camera_io.h"
#include "core/frame_source.h"
#include "core/result.h"

namespace articap {

// What the verbs that calibrate from a board have in common.
struct BoardInput {
  std::string board;  // as typed
  std::vector<std::string> paths;
  std::vector<std::string> lenses;  // calibrations with lenses that are known already
  DetectorOptions detect;
  ViewChoiceOptions choose;
  CameraReadOptions read;
};
void AddBoardInput(VerbLine& line, BoardInput& input);

// A camera whose pictures were looked through.
struct SeenCamera {
  CameraSightings sightings;
  bool is_video = false;
  std::vector<std::string> set_aside;  // pictures that show no board, with the reason; sentences
  // What was found out about its video, and what became of the frames; sentences.
  std::vector<std::string> notes;
};

// All paths are one camera's.
Result<SeenCamera> SeeOneCamera(const BoardSpec& board, const BoardInput& input);
// Each path is a camera's, or a take's, of which all cameras are meant. `choose_views`: of videos,
// the instants that any camera would choose; else every frame that shows the board.
Result<std::vector<SeenCamera>> SeeCameras(const BoardSpec& board, const BoardInput& input,
                                           bool choose_views);

// A camera's pictures.
struct NamedSource {
  std::string name;
  std::unique_ptr<FrameSource> source;
};
// Each path is a camera's, or a take's, of which all cameras are meant. Refused where two have one
// name.
Result<std::vector<NamedSource>> OpenCameras(const std::vector<std::string>& paths);

// The cameras of several calibrations, whose lenses alone count.
struct KnownLenses {
  std::vector<Camera> cameras;
  std::string files;  // for messages

  // The lens of the camera of that name; of the only one for an `only_camera`, whatever its name.
  // Refused where it was calibrated for pictures of another size.
  Result<Lens> LensFor(const std::string& camera, bool only_camera, int width, int height) const;
};
Result<KnownLenses> ReadLenses(const std::vector<std::string>& files,
                               const CameraReadOptions& options);

// All files that are read, which no output may replace: those in folders and takes among them.
std::vector<std::filesystem::path> InputFiles(const std::vector<std::string>& paths,
                                              const std::vector<std::string>& lenses);

}  // namespace articap
