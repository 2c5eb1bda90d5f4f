// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/verb_line.h"

namespace articap {

// One function a verb; `arguments` is what follows the verb on the command line.
using Verb = ExitCode (*)(const std::vector<std::string>& arguments);

ExitCode InfoCommand(const std::vector<std::string>& arguments);
ExitCode ConvertCommand(const std::vector<std::string>& arguments);
ExitCode CalibrateCommand(const std::vector<std::string>& arguments);
ExitCode CalibrateLensCommand(const std::vector<std::string>& arguments);
ExitCode CalibrateRigCommand(const std::vector<std::string>& arguments);
ExitCode CalibrateMirrorCommand(const std::vector<std::string>& arguments);
ExitCode CalibrateMirrorDotsCommand(const std::vector<std::string>& arguments);
ExitCode CalibrateWandCommand(const std::vector<std::string>& arguments);
ExitCode CalibrateConvertCommand(const std::vector<std::string>& arguments);
ExitCode LabelCommand(const std::vector<std::string>& arguments);
ExitCode TrackCommand(const std::vector<std::string>& arguments);
ExitCode StabilizeCommand(const std::vector<std::string>& arguments);
ExitCode MapCommand(const std::vector<std::string>& arguments);
ExitCode BindCommand(const std::vector<std::string>& arguments);
ExitCode FitCommand(const std::vector<std::string>& arguments);
ExitCode SessionCommand(const std::vector<std::string>& arguments);
ExitCode SessionNewCommand(const std::vector<std::string>& arguments);
ExitCode SessionImportCommand(const std::vector<std::string>& arguments);
ExitCode SessionInfoCommand(const std::vector<std::string>& arguments);
ExitCode CalibratePrintCommand(const std::vector<std::string>& arguments);
ExitCode SessionSplitCommand(const std::vector<std::string>& arguments);
ExitCode SynthesizeCommand(const std::vector<std::string>& arguments);
ExitCode RigCommand(const std::vector<std::string>& arguments);
ExitCode RigExportCommand(const std::vector<std::string>& arguments);
ExitCode RigImportCommand(const std::vector<std::string>& arguments);
ExitCode RigInfoCommand(const std::vector<std::string>& arguments);
ExitCode RigRenderCommand(const std::vector<std::string>& arguments);

struct VerbEntry {
  const char* name;
  const char* summary;
  Verb run;
};

// Finds the verb that the arguments begin with, in the order of the table, and runs it. `program`
// is what stands before the verb ("articap", "articap rig").
ExitCode RunVerb(const std::string& program, const std::string& summary,
                 const std::vector<VerbEntry>& verbs, const std::vector<std::string>& arguments);

}  // namespace articap
