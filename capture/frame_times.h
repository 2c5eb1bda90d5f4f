// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"

namespace articap {

// Makes session times of the times that a video file gives its frames, and keeps account of what is
// not as it should be. The first frame has the time `start`.
class FrameTimes {
 public:
  // The nominal rate, and how finely the file tells times apart.
  FrameTimes(double rate_hz, std::chrono::nanoseconds tick, SessionTime start);

  // The time of the next frame. `own`: what the file says. `begins_part`: it is the first frame of
  // a further file, whose clock may begin anew.
  SessionTime Next(std::optional<std::chrono::nanoseconds> own, bool begins_part = false);

  // Whether all frames so far followed one another at the nominal rate, to a tick.
  bool constant_rate() const { return num_irregular_ == 0 && num_gaps_ == 0; }
  // A sentence for each kind of fault so far.
  std::vector<std::string> notes() const;

 private:
  // Where the file's own time 0 lies, so that this frame follows the last one.
  void Join(std::chrono::nanoseconds own);
  void Judge(std::chrono::nanoseconds step);

  std::chrono::nanoseconds period_;
  std::chrono::nanoseconds tolerance_;
  std::int64_t num_frames_ = 0;
  SessionTime last_;
  std::chrono::nanoseconds session_from_own_{0};
  std::int64_t num_missing_ = 0, num_repeated_ = 0, num_gaps_ = 0, num_irregular_ = 0;
  std::int64_t first_gap_ = 0, first_repeated_ = 0;
  std::vector<std::string> joints_;
};

}  // namespace articap
