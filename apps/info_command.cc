// SPDX-License-Identifier: MIT
#include "apps/marker_input.h"
#include "apps/progress.h"
#include "apps/verbs.h"
#include "core/io/marker_info.h"

namespace articap {

ExitCode InfoCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap info", "What is in a marker file: markers, rate, frames, gaps, units.",
                "articap info take01.c3d");
  std::string path;
  MarkerReadOptions read_options;
  line.Argument("FILE", path, "marker file: C3D, TRC, Qualisys TSV, CSV (Nexus, Motive, plain)");
  line.Stage("read", read_options);
  if (const auto exit = line.Parse(arguments)) return *exit;

  const Result<MarkerRecording> recording =
      WithProgress("reading " + path, [&] { return ReadMarkers(path, read_options); });
  if (!recording) return FailWith(recording.error());
  return line.Finish({DescribeRecording(*recording, path)});
}

}  // namespace articap
