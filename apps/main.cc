// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <glog/logging.h>

#include <exception>
#include <new>
#include <string>
#include <vector>

#include "apps/verbs.h"
#include "core/check.h"
#include "core/version.h"

namespace {

// In the order of the data.
const std::vector<articap::VerbEntry>& Verbs() {
  static const std::vector<articap::VerbEntry> verbs = {
      {"session", "the recordings of a speaker on disk: new, import, split, info",
       articap::SessionCommand},
      {"calibrate", "cameras, their lenses, mirrors: lens, rig, mirror, wand, print, convert",
       articap::CalibrateCommand},
      {"info", "what is in a marker file: markers, rate, frames, gaps, units; in a calibration",
       articap::InfoCommand},
      {"convert", "between marker formats", articap::ConvertCommand},
      {"label", "name the markers of a recording by where they sit", articap::LabelCommand},
      {"track", "follow the dots in videos, in 3D and by name", articap::TrackCommand},
      {"stabilize", "factor the movement of the head out", articap::StabilizeCommand},
      {"map", "propose where each marker sits, from the cloud alone", articap::MapCommand},
      {"bind", "tie a speaker's reference pose to a rig, once", articap::BindCommand},
      {"fit", "markers in, articulatory parameters out", articap::FitCommand},
      {"synthesize", "a recording of somebody who never lived, with the truth",
       articap::SynthesizeCommand},
      {"rig", "talking heads: info, render, export, import", articap::RigCommand},
  };
  return verbs;
}

articap::ExitCode Run(const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments[0] == "--version") {
    fmt::print("articap {}\n", articap::kVersion);
    return articap::ExitCode::kUsable;
  }
  return articap::RunVerb("articap",
                          "articap: facial motion capture in, articulatory parameters out", Verbs(),
                          arguments);
}

}  // namespace

int main(int argc, char** argv) {
  using articap::ExitCode;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  // What Ceres has to say of single steps is no concern of the user's: how a solution came out is
  // in the reports.
  FLAGS_minloglevel = google::GLOG_FATAL;
  ExitCode code = ExitCode::kNotUsable;
  try {
    code = Run(arguments);
  } catch (const std::bad_alloc&) {
    code = articap::FailWith(ExitCode::kNotUsable, "there is not enough memory for this input");
  } catch (const std::exception& error) {
    code = articap::FailWith(
        ExitCode::kNotUsable,
        fmt::format("a mistake in articap itself, please report it: {}", error.what()));
  }
  return static_cast<int>(code);
}
