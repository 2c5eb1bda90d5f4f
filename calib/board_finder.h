// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "calib/board_detector.h"
#include "calib/board_sighting.h"
#include "core/board.h"
#include "core/frame_source.h"
#include "core/result.h"

namespace articap {

// A picture that is not used, and why.
struct SetAside {
  std::string source;  // as BoardSighting has it; empty where the reason itself names the file
  std::string reason;  // "no board found"

  bool operator==(const SetAside&) const = default;
};

struct FoundBoard {
  BoardSighting sighting;
  std::vector<double> sigmas_px;  // of its points
  BoardQuality quality;
};

// What the pictures of one camera show of a board.
struct Sightings {
  std::string camera;  // the source's name
  int width = 0;       // of the pictures, px
  int height = 0;
  bool is_video = false;            // neighbouring frames follow upon one another
  std::int64_t pictures = 0;        // looked at
  std::vector<FoundBoard> found;    // in the order of the frames; directly before in a mirror
  std::vector<SetAside> set_aside;  // every other picture, in the same order
};

// Looks for a board in every picture of a source, on all processors; the result does not depend on
// their number. Set aside are pictures without a board, of another size than most, damaged
// ones, and those that hold to the last bit what an earlier one does. `progress`, where given, is
// called with the part done, 0 to 1, where the source knows how many pictures it has. Fails for a
// board that there is not, and for a source without any picture.
Result<Sightings> FindBoards(FrameSource& source, const BoardSpec& board,
                             const DetectorOptions& options = {},
                             const std::function<void(double part)>& progress = {});

}  // namespace articap
