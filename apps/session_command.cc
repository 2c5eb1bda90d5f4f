// SPDX-License-Identifier: MIT
#include "apps/verbs.h"

namespace articap {

ExitCode SessionCommand(const std::vector<std::string>& arguments) {
  static const std::vector<VerbEntry> verbs = {
      {"new", "begin the session of a speaker", SessionNewCommand},
      {"import", "make a take of markers, videos, audio and labels", SessionImportCommand},
      {"split", "cut a long take into parts", SessionSplitCommand},
      {"info", "the takes, and whether their files are as they were", SessionInfoCommand},
  };
  return RunVerb("articap session", "Sessions: the raw recordings of a speaker, safe on disk",
                 verbs, arguments);
}

}  // namespace articap
