// SPDX-License-Identifier: MIT
#pragma once

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
  std::string lenses;  // a calibration with lenses that are known already; may be empty
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
};

// Where one camera's pictures are: picture files, one folder, one video or its parts.
struct CameraPaths {
  std::string name;
  std::vector<std::string> paths;
};

// All paths are one camera's.
Result<SeenCamera> SeeOneCamera(const BoardSpec& board, const BoardInput& input);
// Each path is a camera's, or a take's, of which all cameras are meant. `choose_views`: of videos,
// the instants that any camera would choose; else every frame that shows the board.
Result<std::vector<SeenCamera>> SeeCameras(const BoardSpec& board, const BoardInput& input,
                                           bool choose_views);

// The sources of one path: one camera, or those of a take.
struct NamedSource {
  std::string name;
  std::unique_ptr<FrameSource> source;
};
Result<std::vector<NamedSource>> OpenCameras(const std::string& path);

// The lens of a camera of that name, or of the only one; refused where it was calibrated for
// pictures of another size.
Result<Lens> LensFor(const CameraArray& lenses, const std::string& file, const std::string& camera,
                     int width, int height);

}  // namespace articap
