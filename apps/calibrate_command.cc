// SPDX-License-Identifier: MIT
#include "apps/verbs.h"

namespace articap {

ExitCode CalibrateCommand(const std::vector<std::string>& arguments) {
  static const std::vector<VerbEntry> verbs = {
      {"print", "a board to print, as a PDF in its true size", CalibratePrintCommand},
  };
  return RunVerb("articap calibrate", "Calibration: what the cameras are and where they stand",
                 verbs, arguments);
}

}  // namespace articap
