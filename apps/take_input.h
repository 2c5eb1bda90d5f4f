// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "apps/take.h"
#include "core/result.h"

namespace articap {

// What a fit reads, as names for the command line.
struct TakeInput {
  std::string markers;
  std::string labels;  // empty where there are none
  // What is added to the labels' times to have the markers': a take's audio may begin elsewhere.
  double labels_shift_s = 0;
  // Of a part of a take: from when to when it goes, on the markers' own clock.
  std::optional<TimeSpan> span;
  std::string map;         // what the session says; empty: nothing
  std::string rig_folder;  // the same
};

// Where `markers` is the folder of a session's take: its files, which must be as they were when
// they were recorded, and what session.toml says. Labels that are given go before those of the
// take, and are not shifted.
Result<TakeInput> FindTakeInput(const std::string& markers, const std::string& labels);

}  // namespace articap
