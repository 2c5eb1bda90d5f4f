// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/marker_io.h"

namespace articap {

// Between one frame in a hundred seconds and a million a second.
bool IsUsableRate(double rate_hz);

// Finite, and within thirty years: what formats can hold to the microsecond.
bool IsUsableEventTime(double time_s);
// The events whose times are usable; the only ones that are read or written.
std::vector<MarkerEvent> UsableEvents(const std::vector<MarkerEvent>& events);

// The time of the first frame of a file that keeps no times but frame numbers from 1.
SessionTime NominalStart(int first_frame, double rate_hz);

// What a text file says of time: any of it may be absent.
struct TimingClues {
  std::vector<double> frame_numbers;  // of each row, or empty
  std::vector<double> times_s;        // of each row, or empty
  int time_decimals = 6;              // that the times are written with, in seconds
  std::optional<double> rate_hz;      // of the header
};

// When each row was recorded: at a constant rate, with frames left out here and there.
struct Timing {
  double rate_hz = 1;
  int first_frame = 1;
  SessionTime start;
  int num_frames = 0;
  std::vector<int> frame_of_row;  // strictly increasing, from 0; -1 for rows to be left out
};

// Fails where there is no rate, or where the numbers make no sense. `num_rows` may be 0.
Result<Timing> ResolveTiming(const TimingClues& clues, std::size_t num_rows,
                             std::size_t num_markers, const MarkerReadOptions& options,
                             const std::string& source_name, std::vector<std::string>& warnings);

// Text formats print times in microseconds. A start closer than that to (first frame - 1) / rate
// means exactly that; others are rounded. Readers and writers share it, so that files written again
// do not change.
SessionTime SnapStart(SessionTime start, int first_frame, double rate_hz);

}  // namespace articap
