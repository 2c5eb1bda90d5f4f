// SPDX-License-Identifier: MIT
#include "apps/verbs.h"

namespace articap {

ExitCode CalibrateCommand(const std::vector<std::string>& arguments) {
  static const std::vector<VerbEntry> verbs = {
      {"print", "a board to print, as a PDF in its true size", CalibratePrintCommand},
      {"convert", "between files of calibrated cameras", CalibrateConvertCommand},
  };
  return RunVerb("articap calibrate", "Cameras: where they stand and what their lenses do", verbs,
                 arguments);
}

}  // namespace articap
