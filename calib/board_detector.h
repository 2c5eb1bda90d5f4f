// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/board.h"
#include "core/frame_source.h"
#include "core/image.h"
#include "core/options.h"
#include "core/result.h"

namespace articap {

struct DetectorOptions {
  // Look for a second sighting of the board, reversed by a mirror.
  bool look_in_mirror = false;
  // Try harder where nothing is found at first: separate pictures deserve it, of a video's frames
  // there are others.
  bool thorough = true;
  // Half side of the window that a corner is fitted to, px; 0: what the squares leave room for.
  double window_px = 0;
  // Pictures whose edges take more than this from 10 % to 90 % are refused.
  double max_edge_px = 10;
  // Pictures with more than this part of the board's white squares at the top of the scale are
  // refused. White that is a little too bright does not shift corners; twice as bright doubles
  // their errors, and by how much it is too bright cannot be seen.
  double max_saturated = 0.5;
};
void VisitOptions(DetectorOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const DetectorOptions& options);

// How well a picture shows a board.
struct BoardQuality {
  double edge_px = 0;     // width of its edges, 10 % to 90 %; median
  double contrast = 0;    // white less black squares, of the whole scale
  double saturated = 0;   // part of the white squares at the top of the scale
  double spacing_px = 0;  // between neighbouring corners; mean
};

struct DetectedBoard {
  bool mirrored = false;                   // seen in a mirror
  std::vector<int> corners;                // numbers of the board's corners, ascending
  std::vector<Eigen::Vector2d> points_px;  // in the picture
  std::vector<double> sigmas_px;           // standard deviations, from the noise seen
  BoardQuality quality;
};

struct DetectionResult {
  std::vector<DetectedBoard> boards;  // at most one directly and one in a mirror, in this order
  std::string reason;                 // why there is none, in words; empty where there is one
};

// Finds a board in a picture and measures its corners. Those that are hidden, or too blurred or
// noisy to be told, are left out.
//
// A chessboard in a mirror looks like another one that is not: with look_in_mirror, of two the
// nearer one counts as seen directly, and a single one too. The markers of a ChArUco board tell.
DetectionResult DetectBoard(const ImageView& image, const PictureFromImage& picture_from_image,
                            const BoardSpec& board, const DetectorOptions& options = {});

}  // namespace articap
