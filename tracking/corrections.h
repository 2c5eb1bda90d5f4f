// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace articap {

enum class CorrectionKind : std::uint8_t {
  kRelabel,    // what is called `marker` is `other`
  kSwap,       // `marker` and `other` carry each other's names
  kDelete,     // what is called `marker` is not it
  kDeleteDot,  // what looks like a dot at `place_px` of a view is none
  kSplit,      // nothing is carried over from the frame before `first`: of `marker`, or of all
  kMove,       // `marker` is at `place_px` of a view
};

// One thing that a person put right.
struct Correction {
  CorrectionKind kind = CorrectionKind::kRelabel;
  int line = 0;  // of the file
  std::string marker;
  std::string other;
  int first = 0;  // frames as the recording counts them, both included
  int last = 0;
  std::string view;  // CameraArray::NameOf
  Eigen::Vector2d place_px = Eigen::Vector2d::Zero();

  // "corrections.toml, line 12".
  std::string WhereIn(const std::string& source) const;
};

// What a person put right in a take, in a file that is applied again whenever the take is tracked,
// in its order. TOML with comments:
//   [[relabel]]               # what is called chin in these frames is the lower lip
//   marker = "chin"
//   is = "lower_lip"
//   frames = [120, 164]       # both included; frame = 120 for one
//   [[swap]]                  # they carry each other's names
//   markers = ["left_corner", "right_corner"]
//   frames = [200, 230]
//   [[delete]]                # it is not the chin; a gap, which is filled if it is short
//   marker = "chin"
//   frames = [310, 312]
//   [[delete]]                # a reflection, no dot
//   view = "front"            # or "front/left", by the mirror of that name
//   frames = [310, 330]
//   at_px = [412.0, 300.5]
//   [[split]]                 # looked for anew from here on, nothing is carried over
//   frame = 400
//   marker = "chin"           # optional: of it alone, no gap is filled across
//   [[move]]                  # the chin is there; the dot there is moved, or one is added
//   marker = "chin"
//   view = "front"
//   frame = 120
//   to_px = [350.2, 411.7]
struct Corrections {
  std::string source;  // of the file, for messages
  std::vector<Correction> list;
};

// Refused, naming file and line: unknown keys, what is missing, frames that run backwards.
Result<Corrections> ParseCorrections(const std::string& toml_text, const std::string& source_name);
Result<Corrections> ReadCorrections(const std::filesystem::path& path);

}  // namespace articap
