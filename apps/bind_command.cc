// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "apps/fit_pipeline.h"
#include "apps/marker_input.h"
#include "apps/output_set.h"
#include "apps/resources.h"
#include "apps/rig_input.h"
#include "apps/verbs.h"
#include "core/ply.h"
#include "rig/virtual_marker_evaluator.h"

namespace articap {
namespace {

struct BindArguments {
  std::string reference, rig_folder, map, output, ply, config;
  PipelineOptions pipeline;
};

// Measured and virtual markers of the reference pose, as PLY.
Result<std::string> MarkersOfBinding(const Binding& binding, const FaceRig& rig) {
  const Result<FaceRig> bound_rig = RigOfBinding(binding, rig);
  if (!bound_rig) return tl::unexpected(bound_rig.error());
  const Result<Eigen::VectorXd> pose = ReferenceParameters(binding, *bound_rig);
  if (!pose) return tl::unexpected(pose.error());
  const VirtualMarkerEvaluator evaluator(*bound_rig, binding.virtual_markers);
  const Eigen::Matrix3Xd positions_mm =
      evaluator.Positions({pose->data(), static_cast<std::size_t>(pose->size())});
  std::vector<std::string> names;
  std::vector<Eigen::Vector3d> virtual_in_rig_mm;
  for (Eigen::Index i = 0; i < positions_mm.cols(); ++i) {
    names.push_back(binding.virtual_markers[i].name);
    virtual_in_rig_mm.push_back(positions_mm.col(i));
  }
  return MarkersToPly(binding.reference_pose, binding.rig_from_head, names, virtual_in_rig_mm);
}

Result<std::vector<StageReport>> RunBind(const BindArguments& arguments) {
  const Result<FaceRig> rig = ChooseRig(arguments.rig_folder);
  if (!rig) return tl::unexpected(rig.error());
  const Result<MarkerSet> set = ReadMap(arguments.map);
  if (!set) return tl::unexpected(set.error());
  const Result<Take> reference =
      ReadTake(arguments.reference, arguments.pipeline.read, arguments.pipeline.mirror);
  if (!reference) return tl::unexpected(reference.error());
  Result<BoundReference> bound = BindTake(*reference, *set, *rig, arguments.pipeline);
  if (!bound) return tl::unexpected(bound.error());
  const auto sources = SourcesOf(arguments.reference, arguments.map, *rig);
  if (!sources) return tl::unexpected(sources.error());
  bound->binding.sources = *sources;

  OutputSet outputs;
  outputs.Add(arguments.output, WriteBinding(bound->binding));
  if (!arguments.ply.empty()) {
    const Result<std::string> ply = MarkersOfBinding(bound->binding, *rig);
    if (!ply) return tl::unexpected(ply.error());
    outputs.Add(arguments.ply, *ply);
  }
  if (const auto allowed = outputs.RefuseToOverwrite(
          {arguments.reference, MapInput(arguments.map), arguments.config});
      !allowed)
    return tl::unexpected(allowed.error());
  if (const auto written = outputs.Commit(); !written) return tl::unexpected(written.error());
  return bound->reports;
}

}  // namespace

ExitCode BindCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap bind",
      "Ties a speaker's reference pose (face relaxed, jaw and lips closed) to a rig, once\n"
      "for all takes. The pose and identity in the binding can be edited by hand; look at\n"
      "them with 'articap rig render OUT.png --binding FILE'.",
      "articap bind reference.c3d --map spectacles30 -o anna.binding.toml");
  BindArguments values;
  line.Argument("REFERENCE", values.reference, "marker file with the reference pose");
  line.Flag("--map", values.map, "NAME|FILE", "marker map: where each marker sits")->required();
  line.Flag("--rig", values.rig_folder, "DIR", "folder of a rig; else the default head");
  line.Flag("-o,--output", values.output, "FILE", "binding to write, TOML")->required();
  line.Flag("--ply", values.ply, "FILE",
            "also write measured and virtual markers of the reference pose, PLY in the rig frame");
  line.Flag("--mirror", values.pipeline.mirror, "the recording is mirrored; mirror it back");
  line.Stage("bind", values.pipeline.bind);
  line.Stage("read", values.pipeline.read);
  line.Stage("stabilize", values.pipeline.stabilize, "stabilize");
  if (const auto exit = line.Parse(arguments)) return *exit;
  values.config = line.config_path();
  const auto reports = RunBind(values);
  return reports ? line.Finish(*reports) : FailWith(reports.error());
}

}  // namespace articap
