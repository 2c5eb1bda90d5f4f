// SPDX-License-Identifier: MIT
#include "apps/verbs.h"

namespace articap {

ExitCode CalibrateCommand(const std::vector<std::string>& arguments) {
  static const std::vector<VerbEntry> verbs = {
      {"print", "a board to print, as a PDF in its true size", CalibratePrintCommand},
      {"lens", "one camera's lens, from a board", CalibrateLensCommand},
      {"rig", "where several cameras stand, from a board that they see together",
       CalibrateRigCommand},
      {"mirror", "a camera and the mirrors in its picture, from a board", CalibrateMirrorCommand},
      {"mirror-dots", "a mirror without a board, from dots of the face",
       CalibrateMirrorDotsCommand},
      {"wand", "where several cameras stand, from a waved wand", CalibrateWandCommand},
      {"convert", "between files of calibrated cameras", CalibrateConvertCommand},
  };
  return RunVerb("articap calibrate", "Cameras: where they stand and what their lenses do", verbs,
                 arguments);
}

}  // namespace articap
