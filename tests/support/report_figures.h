// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/report.h"

namespace articap {

// A figure of a report by its name; the test fails where there is none.
inline double FigureOf(const StageReport& report, const std::string& name) {
  for (const auto& [figure, value] : report.figures)
    if (figure == name) return value;
  ADD_FAILURE() << "no figure " << name;
  return 0;
}

}  // namespace articap
