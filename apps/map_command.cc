// SPDX-License-Identifier: MIT
#include <filesystem>

#include "apps/marker_input.h"
#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/rig_input.h"
#include "apps/take.h"
#include "apps/verbs.h"
#include "fitting/propose_map.h"

namespace articap {
namespace {

struct MapArguments {
  std::string reference, rig_folder, output, config;
  bool mirror = false;
  MarkerReadOptions read;
  ProposeMapOptions map;
};

Result<std::vector<StageReport>> RunMap(const MapArguments& arguments) {
  const Result<FaceRig> rig = ChooseRig(arguments.rig_folder);
  if (!rig) return tl::unexpected(rig.error());
  const Result<Take> take = ReadTake(arguments.reference, arguments.read, arguments.mirror);
  if (!take) return tl::unexpected(take.error());
  const std::string name = std::filesystem::path(arguments.output).stem().string();
  const auto proposal = WithProgress("laying the markers on the rig's face", [&] {
    return ProposeMap(take->recording.tracks, name, *rig, arguments.map);
  });
  if (!proposal) return Fail(arguments.reference + ": " + proposal.error().message);

  OutputSet outputs;
  outputs.Add(arguments.output, WriteMapProposal(*proposal));
  if (const auto allowed = outputs.RefuseToOverwrite({arguments.reference, arguments.config});
      !allowed)
    return tl::unexpected(allowed.error());
  if (const auto written = outputs.Commit(); !written) return tl::unexpected(written.error());
  return std::vector<StageReport>{take->report, proposal->report};
}

}  // namespace

ExitCode MapCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap map",
      "Proposes a marker map for a recording whose marker names say nothing: lays the cloud\n"
      "of markers on the rig's face and names the landmark or region that each lies at.\n"
      "Check the map before use; a mirrored recording cannot be told from the cloud.",
      "articap map reference.c3d --up +z -o anna.map.toml");
  MapArguments values;
  line.Argument("REFERENCE", values.reference, "marker file of one face");
  line.Flag("--rig", values.rig_folder, "DIR", "folder of a rig; else the default head");
  line.Flag("-o,--output", values.output, "FILE", "marker map to write, TOML")->required();
  line.Flag("--mirror", values.mirror, "the recording is mirrored; mirror it back");
  line.Stage("map", values.map);
  line.Stage("read", values.read);
  if (const auto exit = line.Parse(arguments)) return *exit;
  values.config = line.config_path();
  const auto reports = RunMap(values);
  return reports ? line.Finish(*reports) : FailWith(reports.error());
}

}  // namespace articap
