// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "apps/display_units.h"
#include "apps/rig_input.h"
#include "apps/verbs.h"

namespace articap {
namespace {

ReportTable ParameterTable(const RigDefinition& definition) {
  ReportTable table = {"parameter", {"min", "max"}, {}};
  for (const RigParameter& parameter : definition.parameters) {
    const std::string unit = DisplayUnitOf(parameter.unit);
    table.rows.push_back({parameter.name + (unit.empty() ? "" : "_" + unit),
                          {DisplayValueOf(parameter.min, parameter.unit),
                           DisplayValueOf(parameter.max, parameter.unit)}});
  }
  return table;
}

ReportTable IdentityTable(const RigDefinition& definition) {
  ReportTable table = {"identity", {"min", "max"}, {}};
  for (const IdentitySlider& slider : definition.identity_sliders)
    table.rows.push_back({slider.name, {slider.min, slider.max}});
  return table;
}

ReportTable CountTable(const std::string& name, const std::vector<std::string>& labels,
                       const std::vector<std::uint8_t>& label_of_triangle) {
  ReportTable table = {name, {"triangles"}, {}};
  for (std::size_t i = 0; i < labels.size(); ++i)
    table.rows.push_back(
        {labels[i],
         {static_cast<double>(std::count(label_of_triangle.begin(), label_of_triangle.end(), i))}});
  return table;
}

ReportTable LandmarkTable(const FaceRig& rig) {
  ReportTable table = {"landmark", {"x_mm", "y_mm", "z_mm"}, {}};
  for (const Landmark& landmark : rig.definition().landmarks) {
    const Eigen::Vector3d& place = rig.neutral_mesh().vertices[landmark.vertex];
    table.rows.push_back({landmark.name, {place.x(), place.y(), place.z()}});
  }
  return table;
}

StageReport DescribeRig(const FaceRig& rig) {
  const RigDefinition& definition = rig.definition();
  StageReport report;
  report.stage = "rig";
  report.verdict = fmt::format("{}: {} parameters, {} identity sliders, {}", definition.name,
                               rig.num_parameters(), definition.identity_sliders.size(),
                               definition.jaw ? "a jaw that turns" : "linear morphs alone");
  report.figures = {{"vertices", static_cast<double>(rig.num_vertices())},
                    {"triangles", static_cast<double>(definition.mesh.triangles.size())}};
  Eigen::Vector3d lowest = Eigen::Vector3d::Constant(INFINITY), highest = -lowest;
  for (const Eigen::Vector3d& vertex : rig.neutral_mesh().vertices) {
    lowest = lowest.cwiseMin(vertex);
    highest = highest.cwiseMax(vertex);
  }
  const Eigen::Vector3d size_mm = highest - lowest;
  report.figures.emplace_back("width_mm", size_mm.x());
  report.figures.emplace_back("height_mm", size_mm.y());
  report.figures.emplace_back("depth_mm", size_mm.z());
  report.tables = {ParameterTable(definition), IdentityTable(definition),
                   CountTable("region", definition.region_names, definition.triangle_region),
                   CountTable("part", definition.part_names, definition.triangle_part),
                   LandmarkTable(rig)};
  return report;
}

}  // namespace

ExitCode RigInfoCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap rig info", "Parameters, identity sliders, regions and landmarks of a rig.",
                "articap rig info --rig my_rig");
  std::string folder;
  line.Flag("--rig", folder, "DIR", "folder of a rig; else the default head");
  if (const auto exit = line.Parse(arguments)) return *exit;
  const Result<FaceRig> rig = ChooseRig(folder);
  if (!rig) return FailWith(rig.error());
  return line.Finish({DescribeRig(*rig)});
}

}  // namespace articap
