// SPDX-License-Identifier: MIT
#include "apps/verbs.h"

namespace articap {

ExitCode RigCommand(const std::vector<std::string>& arguments) {
  static const std::vector<VerbEntry> verbs = {
      {"info", "parameters, identity sliders, regions and landmarks", RigInfoCommand},
      {"export", "to glTF, OBJ or a folder", RigExportCommand},
      {"import", "from OBJ folders, glTF and MakeHuman", RigImportCommand},
      {"render", "a picture of any pose and identity", RigRenderCommand},
  };
  return RunVerb("articap rig", "Talking heads: look at them, bring them in, hand them out", verbs,
                 arguments);
}

}  // namespace articap
