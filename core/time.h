// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace articap {

// The clock of a session: int64 nanoseconds since the start of the take. Never a double of seconds
// in storage or arithmetic; seconds appear only where people or files read them.
struct SessionClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<SessionClock>;
  static constexpr bool is_steady = true;
};

using SessionTime = SessionClock::time_point;

inline SessionTime SessionTimeFromSeconds(double time_s) {
  return SessionTime(std::chrono::nanoseconds(std::llround(time_s * 1e9)));
}

inline double SecondsOf(SessionTime time) {
  return static_cast<double>(time.time_since_epoch().count()) * 1e-9;
}

// Time of a frame at a constant rate, rounded to the nearest nanosecond, so that errors never add
// up.
inline SessionTime TimeOfFrame(std::int64_t frame, double rate_hz, SessionTime start = {}) {
  return start +
         std::chrono::nanoseconds(std::llround(static_cast<double>(frame) * (1e9 / rate_hz)));
}

}  // namespace articap
