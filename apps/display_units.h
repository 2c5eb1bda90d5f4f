// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

#include "rig/face_rig.h"

namespace articap {

// What people read of a parameter's value: degrees for rotations.
inline const char* DisplayUnitOf(ParameterUnit unit) {
  switch (unit) {
    case ParameterUnit::kRadian:
      return "deg";
    case ParameterUnit::kMillimetre:
      return "mm";
    case ParameterUnit::kWeight:
      break;
  }
  return "";
}

inline double DisplayValueOf(double value, ParameterUnit unit) {
  return unit == ParameterUnit::kRadian ? value * (180 / std::numbers::pi) : value;
}

}  // namespace articap
