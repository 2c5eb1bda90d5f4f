// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "apps/marker_input.h"
#include "apps/output_names.h"
#include "apps/output_set.h"
#include "apps/resources.h"
#include "apps/take.h"
#include "apps/verbs.h"

namespace articap {
namespace {

struct StabilizeArguments {
  std::string input, output, shape, map, config;
  bool mirror = false;
  MarkerReadOptions read;
  StabilizeOptions stabilize;
};

// The map's roles, or nobody's where only --head names the references.
Result<MarkerSet> SetOf(const StabilizeArguments& arguments) {
  if (!arguments.map.empty()) return ReadMap(arguments.map);
  const bool needs_references = arguments.stabilize.mode != ModeChoice::kNone;
  if (needs_references && arguments.stabilize.head.empty())
    return Fail(
        "which markers move with the skull? Name them with --head A,B,C, or give a marker "
        "map with --map; 'articap info' lists the markers");
  return MarkerSet{};
}

Result<std::vector<StageReport>> RunStabilize(const StabilizeArguments& arguments) {
  const Result<MarkerSet> set = SetOf(arguments);
  if (!set) return tl::unexpected(set.error());
  const Result<MarkerFormat> format = MarkerFormatOf(arguments.output);
  if (!format) return tl::unexpected(format.error());
  std::optional<HeadShape> given_shape;
  if (!arguments.shape.empty()) {
    Result<HeadShape> shape = ReadHeadShapeCsv(arguments.shape);
    if (!shape) return tl::unexpected(shape.error());
    given_shape = std::move(*shape);
  }
  Result<Take> take = ReadTake(arguments.input, arguments.read, arguments.mirror);
  if (!take) return tl::unexpected(take.error());
  auto stabilized = StabilizeTake(*take, *set, given_shape, arguments.stabilize);
  if (!stabilized) return tl::unexpected(stabilized.error());

  const Stabilized& result = stabilized->output;
  const MarkerRecording local = HeadLocalRecording(result.tracks, take->recording);
  if (const auto limit = LimitExceeded(local, *format))
    return Fail(fmt::format("{} has {}; write another format", arguments.input, *limit));
  OutputSet outputs;
  outputs.Add(arguments.output, FormatMarkers(local, *format));
  outputs.Add(Beside(arguments.output, ".pose.csv"), WriteHeadPoseCsv(result.head_pose));
  if (!result.head_shape.points.empty())
    outputs.Add(Beside(arguments.output, ".shape.csv"), WriteHeadShapeCsv(result.head_shape));
  outputs.Add(Beside(arguments.output, ".report.json"),
              ReportsToJson({take->report, stabilized->report}));
  if (const auto allowed = outputs.RefuseToOverwrite(
          {arguments.input, arguments.shape, MapInput(arguments.map), arguments.config});
      !allowed)
    return tl::unexpected(allowed.error());
  if (const auto written = outputs.Commit(); !written) return tl::unexpected(written.error());
  for (const std::string& loss : LossesOf(local, *format)) take->report.warnings.push_back(loss);
  return std::vector<StageReport>{take->report, stabilized->report};
}

}  // namespace

ExitCode StabilizeCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap stabilize",
                "Factors the movement of the head out. Head-local tracks go to OUT; the pose of\n"
                "the head, the shape of its references and the report to OUT's stem + .pose.csv,\n"
                ".shape.csv, .report.json.",
                "articap stabilize take01.c3d take01.head.c3d --map spectacles30");
  StabilizeArguments values;
  line.Argument("IN", values.input, "marker file");
  line.Argument("OUT", values.output, "marker file to write; its ending says the format");
  line.Flag("--map", values.map, "NAME|FILE", "marker map: the roles of the markers");
  line.Flag("--shape", values.shape, "FILE",
            "shape of the references, CSV name,x_mm,y_mm,z_mm; its frame is the head frame");
  line.Flag("--mirror", values.mirror, "the recording is mirrored; mirror it back");
  line.Stage("read", values.read);
  line.Stage("stabilize", values.stabilize);
  if (const auto exit = line.Parse(arguments)) return *exit;
  values.config = line.config_path();
  const auto reports = RunStabilize(values);
  return reports ? line.Finish(*reports) : FailWith(reports.error());
}

}  // namespace articap
