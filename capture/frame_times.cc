// SPDX-License-Identifier: MIT
#include "capture/frame_times.h"

#include <fmt/format.h>

#include <cmath>

namespace articap {

using std::chrono::nanoseconds;

FrameTimes::FrameTimes(double rate_hz, nanoseconds tick, SessionTime start)
    : period_(std::llround(1e9 / rate_hz)),
      // Two rounded times differ by a tick more or less; rates in headers are good to 1 in 1000.
      tolerance_(tick + period_ / 1000),
      last_(start) {}

SessionTime FrameTimes::Next(std::optional<nanoseconds> own, bool begins_part) {
  const std::int64_t frame = num_frames_++;
  if (frame == 0) {
    if (!own) ++num_missing_;
    session_from_own_ = last_.time_since_epoch() - own.value_or(nanoseconds(0));
    return last_;
  }
  if (!own) {
    ++num_missing_;
    return last_ += period_;
  }
  const SessionTime told = SessionTime(*own + session_from_own_);
  const nanoseconds step = told - last_;
  // Longer than any gap that a camera leaves where it begins the next file.
  constexpr nanoseconds kLongestPause = std::chrono::seconds(1);
  const bool goes_on = step > period_ / 2 && step < kLongestPause;
  if ((begins_part && !goes_on) || step < -period_) {
    Join(*own);
    return last_;
  }
  Judge(step);
  return last_ = told;
}

void FrameTimes::Join(nanoseconds own) {
  last_ += period_;
  session_from_own_ = last_.time_since_epoch() - own;
  constexpr std::size_t kMostNotes = 8;
  if (joints_.size() < kMostNotes)
    joints_.push_back(
        fmt::format("frame {}: the file's clock begins anew; it follows the frame before after one "
                    "frame's time",
                    num_frames_ - 1));
}

void FrameTimes::Judge(nanoseconds step) {
  const std::int64_t frame = num_frames_ - 1;
  if (step <= nanoseconds(0)) {
    if (num_repeated_++ == 0) first_repeated_ = frame;
    ++num_irregular_;
  } else if (2 * step > 3 * period_ + 2 * tolerance_) {
    if (num_gaps_++ == 0) first_gap_ = frame;
  } else if (step > period_ + tolerance_ || step < period_ - tolerance_) {
    ++num_irregular_;
  }
}

std::vector<std::string> FrameTimes::notes() const {
  std::vector<std::string> notes = joints_;
  if (num_missing_ > 0)
    notes.push_back(
        fmt::format("{} of {} frames have no time in the file; they follow the frame "
                    "before at the nominal rate",
                    num_missing_, num_frames_));
  if (num_repeated_ > 0)
    notes.push_back(
        fmt::format("{} frames, the first of them frame {}, are not later than the one "
                    "before; their times are the file's",
                    num_repeated_, first_repeated_));
  if (num_gaps_ > 0)
    notes.push_back(
        fmt::format("{} gaps of half a frame or more between frames, the first before "
                    "frame {}: frames may be lost; the times are the file's",
                    num_gaps_, first_gap_));
  if (num_irregular_ > num_repeated_)
    notes.push_back(
        fmt::format("{} of {} frames do not come at a constant rate; their times are "
                    "the file's",
                    num_irregular_ - num_repeated_, num_frames_));
  return notes;
}

}  // namespace articap
