// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/rig_input.h"
#include "apps/verbs.h"
#include "rig/io/gltf_export.h"
#include "rig/io/rig_folder.h"
#include "rig/pose_text.h"

namespace articap {
namespace {

struct ExportArguments {
  std::string output, rig_folder;
  std::vector<std::string> pose, identity;
};

Result<StageReport> ExportAsGlb(const FaceRig& rig, const std::string& output) {
  StageReport report;
  OutputSet outputs;
  outputs.AddWriter(output, [&](const std::filesystem::path& path) -> Result<void> {
    const Result<ExportReport> exported = ExportGlb(rig, std::nullopt, path);
    if (!exported) return tl::unexpected(exported.error());
    report.verdict = fmt::format("{} morph targets and the jaw as a joint written to {}",
                                 exported->target_names.size(), output);
    report.figures = {{"largest_deviation_mm", exported->largest_deviation_mm},
                      {"poses_compared", static_cast<double>(exported->poses_compared)}};
    return {};
  });
  if (const auto written = outputs.Commit(); !written) return tl::unexpected(written.error());
  return report;
}

Result<StageReport> ExportAsObj(const FaceRig& rig, const ExportArguments& arguments) {
  const Result<Eigen::VectorXd> pose = ParsePose(rig, arguments.pose);
  if (!pose) return tl::unexpected(pose.error());
  OutputSet outputs;
  outputs.AddWriter(arguments.output,
                    [&](const std::filesystem::path& path) { return ExportObj(rig, *pose, path); });
  if (const auto written = outputs.Commit(); !written) return tl::unexpected(written.error());
  StageReport report;
  report.verdict = fmt::format("one pose, mm, written to {}", arguments.output);
  return report;
}

Result<StageReport> RunExport(const ExportArguments& arguments) {
  const Result<FaceRig> average = ChooseRig(arguments.rig_folder);
  if (!average) return tl::unexpected(average.error());
  const Result<FaceRig> rig = WithIdentityText(*average, arguments.identity);
  if (!rig) return tl::unexpected(rig.error());
  const std::string ending = std::filesystem::path(arguments.output).extension().string();
  if (ending == ".obj") return ExportAsObj(*rig, arguments);
  if (ending == ".glb" && arguments.pose.empty())
    return WithProgress("exporting", [&] { return ExportAsGlb(*rig, arguments.output); });
  if (ending == ".glb")
    return Fail("--pose: a GLB file holds all poses; leave --pose out, or export an .obj");
  if (!ending.empty())
    return Fail(
        fmt::format("{}: rigs are exported as .glb, as .obj, or as a folder (a name "
                    "without an ending)",
                    arguments.output));
  if (const auto saved = SaveRig(*rig, arguments.output); !saved)
    return tl::unexpected(saved.error());
  StageReport report;
  report.verdict = fmt::format("rig folder written to {}", arguments.output);
  return report;
}

}  // namespace

ExitCode RigExportCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap rig export",
                "Hands a rig out: OUT.glb (jaw as a skinned joint, the rest as morph targets),\n"
                "OUT.obj (one pose), or the folder OUT that --rig reads.",
                "articap rig export head.glb --identity face_width=0.08");
  ExportArguments values;
  line.Argument("OUT", values.output, "file or folder to write");
  line.Flag("--rig", values.rig_folder, "DIR", "folder of a rig; else the default head");
  line.Flag("--pose", values.pose, "NAME=VALUE,...", "of an OBJ file");
  line.Flag("--identity", values.identity, "NAME=VALUE,...", "identity sliders");
  if (const auto exit = line.Parse(arguments)) return *exit;
  Result<StageReport> report = RunExport(values);
  if (!report) return FailWith(report.error());
  report->stage = "export";
  return line.Finish({*report});
}

}  // namespace articap
