// SPDX-License-Identifier: MIT
#include "rig/io/morph_rig.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "rig/head_size.h"
#include "rig/io/jaw_weights.h"
#include "rig/io/region_rules.h"

namespace articap {
namespace {

const Eigen::Vector3f kDefaultColor(0.62f, 0.40f, 0.31f);

double SmoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The rotation and scale from the file's axes and unit to the rig's.
Result<Eigen::Matrix3d> RigAxesFromFile(const ImportRecipe& recipe, double mm_per_unit) {
  const auto parse = [](const std::string& axis) -> Eigen::Vector3d {
    const bool negative = !axis.empty() && axis[0] == '-';
    const std::string letter = negative ? axis.substr(1) : axis;
    const Eigen::Vector3d unit(letter == "x", letter == "y", letter == "z");
    return negative ? Eigen::Vector3d(-unit) : unit;
  };
  const Eigen::Vector3d left = parse(recipe.axes[0]);
  const Eigen::Vector3d up = parse(recipe.axes[1]);
  Eigen::Matrix3d rig_from_file;
  rig_from_file << left.transpose(), up.transpose(), left.cross(up).transpose();
  if (rig_from_file.determinant() != 1)
    return Fail(
        fmt::format("the axes '{}' and '{}' are not two different ones of x, y, z, -x, -y, -z",
                    recipe.axes[0], recipe.axes[1]));
  return Eigen::Matrix3d(mm_per_unit * rig_from_file);
}

// Builds one rig; the steps are called in the order of Build().
class MorphRigBuilder {
 public:
  MorphRigBuilder(const MorphSource& source, const ImportRecipe& recipe,
                  const ImportOptions& options)
      : source_(source), recipe_(recipe), options_(options) {}

  Result<StageResult<FaceRig>> Build() {
    rig_.name = recipe_.name.empty() ? source_.name : recipe_.name;
    if (auto step = PlaceInRigFrame(); !step) return tl::unexpected(step.error());
    if (auto step = ChooseParts(); !step) return tl::unexpected(step.error());
    if (auto step = MeasureWays(); !step) return tl::unexpected(step.error());
    if (auto step = AssignRegions(recipe_.regions, vertex_of_source_, ways_mm_, rig_); !step)
      return tl::unexpected(step.error());
    if (auto step = PlaceLandmarks(); !step) return tl::unexpected(step.error());
    if (auto step = AddJaw(); !step) return tl::unexpected(step.error());
    if (auto step = AddParameters(); !step) return tl::unexpected(step.error());
    auto rig = FaceRig::Create(std::move(rig_));
    if (!rig) return tl::unexpected(rig.error());
    if (auto size = CheckHeadSize(*rig); !size) return tl::unexpected(size.error());
    StageReport report = Report(*rig);
    return StageResult<FaceRig>{std::move(*rig), std::move(report)};
  }

 private:
  bool IsSourceVertex(int vertex) const {
    return vertex >= 0 && vertex < static_cast<int>(source_.vertices.size());
  }

  Result<void> PlaceInRigFrame() {
    const std::string& unit = options_.unit.empty() ? recipe_.unit : options_.unit;
    double mm_per_unit = source_.mm_per_unit > 0 ? source_.mm_per_unit : 1;
    if (!unit.empty()) {
      const auto named = MillimetresPer(unit);
      if (!named)
        return Fail(fmt::format("'{}' is no unit of length; choose mm, cm, dm, m or in", unit));
      mm_per_unit = *named;
    }
    const auto axes = RigAxesFromFile(recipe_, mm_per_unit);
    if (!axes) return tl::unexpected(axes.error());
    rig_from_file_ = *axes;
    Eigen::Vector3d origin_mm = Eigen::Vector3d::Zero();
    for (const std::string& name : recipe_.origin_between) {
      if (name.empty()) continue;
      const auto landmark =
          std::find_if(recipe_.landmarks.begin(), recipe_.landmarks.end(),
                       [&](const Landmark& candidate) { return candidate.name == name; });
      if (landmark == recipe_.landmarks.end() || !IsSourceVertex(landmark->vertex))
        return Fail(
            fmt::format("origin_between names '{}', which is not a landmark at one of the "
                        "file's {} vertices",
                        name, source_.vertices.size()));
      origin_mm += 0.5 * (rig_from_file_ * source_.vertices[landmark->vertex]);
    }
    positions_mm_.reserve(source_.vertices.size());
    for (const Eigen::Vector3d& vertex : source_.vertices)
      positions_mm_.emplace_back(rig_from_file_ * vertex - origin_mm);
    return {};
  }

  std::vector<ImportRecipe::Part> PartRules() const {
    if (!recipe_.parts.empty()) return recipe_.parts;
    std::vector<ImportRecipe::Part> rules;
    for (const std::string& group : source_.group_names) {
      ImportRecipe::Part part;
      part.name = group.empty() ? "skin" : group;
      std::replace_if(
          part.name.begin(), part.name.end(),
          [](char letter) { return letter == ' ' || letter == ',' || letter == '\t'; }, '_');
      part.groups = {group};
      rules.push_back(std::move(part));
    }
    return rules;
  }

  bool Takes(const ImportRecipe::Part& rule, std::size_t triangle) const {
    if (!rule.groups.empty() &&
        !Contains(rule.groups, source_.group_names[source_.triangle_group[triangle]]))
      return false;
    if (!rule.plane_point_mm) return true;
    return std::all_of(
        source_.triangles[triangle].begin(), source_.triangles[triangle].end(), [&](int vertex) {
          return rule.plane_normal.dot(positions_mm_[vertex] - *rule.plane_point_mm) >= 0;
        });
  }

  // Each part has vertices of its own, so that colours and normals end where it ends.
  Result<void> ChooseParts() {
    const std::vector<ImportRecipe::Part> rules = PartRules();
    if (rules.size() > 256)
      return Fail(fmt::format("{} parts; a rig has at most 256", rules.size()));
    vertex_of_source_.assign(source_.vertices.size(), -1);
    std::vector<char> taken(source_.triangles.size(), 0);
    for (const ImportRecipe::Part& rule : rules) {
      const auto named = std::find(rig_.part_names.begin(), rig_.part_names.end(), rule.name);
      const auto part = static_cast<std::uint8_t>(named - rig_.part_names.begin());
      if (named == rig_.part_names.end()) rig_.part_names.push_back(rule.name);
      std::vector<int> vertex_in_part(source_.vertices.size(), -1);
      for (std::size_t i = 0; i < source_.triangles.size(); ++i) {
        if (taken[i] || !Takes(rule, i)) continue;
        taken[i] = 1;
        Eigen::Vector3i triangle = source_.triangles[i];
        for (int& corner : triangle)
          corner = AddVertex(corner, source_.triangle_group[i], rule, vertex_in_part);
        rig_.mesh.triangles.push_back(triangle);
        rig_.triangle_part.push_back(part);
      }
    }
    if (rig_.mesh.triangles.empty())
      return Fail(
          fmt::format("no triangle of '{}' belongs to the recipe's parts; its groups are {}",
                      source_.name, fmt::join(source_.group_names, ", ")));
    return {};
  }

  int AddVertex(int source_vertex, int group, const ImportRecipe::Part& rule,
                std::vector<int>& vertex_in_part) {
    int& vertex = vertex_in_part[source_vertex];
    if (vertex >= 0) return vertex;
    vertex = static_cast<int>(rig_.mesh.vertices.size());
    rig_.mesh.vertices.push_back(positions_mm_[source_vertex]);
    rig_.colors.push_back(rule.color               ? *rule.color
                          : source_.colors.empty() ? kDefaultColor
                                                   : source_.colors[source_vertex]);
    source_of_vertex_.push_back(source_vertex);
    group_of_vertex_.push_back(group);
    if (vertex_of_source_[source_vertex] < 0) vertex_of_source_[source_vertex] = vertex;
    return vertex;
  }

  Result<void> PlaceLandmarks() {
    for (const Landmark& landmark : recipe_.landmarks) {
      if (!IsSourceVertex(landmark.vertex) || vertex_of_source_[landmark.vertex] < 0)
        return Fail(
            fmt::format("the landmark '{}' is at vertex {}, which is not one of the parts "
                        "that the rig keeps",
                        landmark.name, landmark.vertex));
      rig_.landmarks.push_back({landmark.name, vertex_of_source_[landmark.vertex]});
    }
    return {};
  }

  // A target's displacement of every rig vertex, mm, rig axes.
  Result<std::vector<Eigen::Vector3d>> DenseTarget(const std::string& name) {
    const auto target =
        std::find_if(source_.targets.begin(), source_.targets.end(),
                     [&](const MorphSource::Target& candidate) { return candidate.name == name; });
    if (target == source_.targets.end())
      return Fail(fmt::format("the recipe uses the target '{}', which '{}' does not have", name,
                              source_.name));
    used_targets_.insert(name);
    std::vector<Eigen::Vector3d> of_source(source_.vertices.size(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < target->field.vertices.size(); ++i)
      of_source[target->field.vertices[i]] = rig_from_file_ * target->field.displacements_mm[i];
    std::vector<Eigen::Vector3d> dense;
    dense.reserve(source_of_vertex_.size());
    for (const int vertex : source_of_vertex_) dense.push_back(of_source[vertex]);
    return dense;
  }

  // How far the targets move each vertex that the recipe tells vertices apart by.
  Result<void> MeasureWays() {
    std::set<std::string> names;
    for (const ImportRecipe::Region& region : recipe_.regions)
      if (region.moved_by) names.insert(region.moved_by->target);
    for (const ImportRecipe::Parameter& parameter : recipe_.parameters)
      for (const ImportRecipe::TargetUse& use : parameter.targets)
        if (use.moved_by) names.insert(use.moved_by->target);
    for (const std::string& name : names) {
      const auto dense = DenseTarget(name);
      if (!dense) return tl::unexpected(dense.error());
      for (const Eigen::Vector3d& displacement_mm : *dense)
        ways_mm_[name].push_back(displacement_mm.norm());
    }
    return {};
  }

  Result<void> AddJaw() {
    if (!recipe_.jaw || !options_.use_jaw_joint) return {};
    const ImportRecipe::Jaw& jaw = *recipe_.jaw;
    const auto opening = DenseTarget(jaw.target);
    if (!opening) return tl::unexpected(opening.error());
    std::vector<JawBond> bonds;
    for (const int group : group_of_vertex_) {
      const std::string& name = source_.group_names[group];
      bonds.push_back(Contains(jaw.rigid_groups, name)   ? JawBond::kRigid
                      : Contains(jaw.fixed_groups, name) ? JawBond::kFixed
                                                         : JawBond::kFree);
    }
    WeightMap map{"jaw", JawWeights(jaw, rig_.mesh, *opening, bonds)};
    map.weights.push_back(0);  // of the pivot
    JawJoint joint;
    joint.weight_map = 0;
    joint.pivot_vertex = static_cast<int>(rig_.mesh.vertices.size());
    rig_.landmarks.push_back({"jaw_pivot", joint.pivot_vertex});
    rig_.mesh.vertices.push_back(jaw.pivot_mm);
    rig_.colors.push_back(kDefaultColor);
    rig_.weight_maps.push_back(std::move(map));
    rig_.jaw = joint;
    return {};
  }

  Result<void> AddParameters() {
    if (recipe_.parameters.empty()) return AddEveryTarget();
    for (const ImportRecipe::Parameter& rule : recipe_.parameters) {
      const int index = static_cast<int>(rig_.parameters.size());
      if (rig_.jaw && !rule.joint.empty()) {
        rig_.parameters.push_back(rule.parameter);
        (rule.joint == "rotation" ? rig_.jaw->rotation_parameter
         : rule.joint == "thrust" ? rig_.jaw->thrust_parameter
                                  : rig_.jaw->shift_parameter) = index;
        continue;
      }
      if (rule.targets.empty()) continue;
      RigParameter parameter = rule.parameter;
      if (!rule.joint.empty()) {  // a joint's parameter as a morph
        parameter.unit = ParameterUnit::kWeight;
        parameter.min = 0;
        parameter.max = 1;
      }
      rig_.parameters.push_back(parameter);
      auto field = CombineTargets(rule.targets);
      if (!field) return tl::unexpected(field.error());
      rig_.morph_targets.push_back({index, std::move(*field)});
    }
    return {};
  }

  Result<void> AddEveryTarget() {
    for (const MorphSource::Target& target : source_.targets) {
      ImportRecipe::TargetUse use;
      use.target = target.name;
      auto field = CombineTargets({use});
      if (!field) return tl::unexpected(field.error());
      rig_.morph_targets.push_back({static_cast<int>(rig_.parameters.size()), std::move(*field)});
      rig_.parameters.push_back(
          {target.name, ParameterUnit::kWeight, 0, 1,
           fmt::format("the morph target '{}' of {}", target.name, source_.name),
           "the range of a morph target"});
    }
    return {};
  }

  double Mask(const ImportRecipe::TargetUse& use, std::size_t vertex) const {
    const Eigen::Vector3d& position_mm = rig_.mesh.vertices[vertex];
    double mask = 1;
    if (use.moved_by) {
      const double way_mm = ways_mm_.at(use.moved_by->target)[vertex];
      if (way_mm < use.moved_by->range_mm[0] || way_mm >= use.moved_by->range_mm[1]) return 0;
    }
    if (use.side != 0)
      mask *= SmoothStep(0.5 + 0.5 * use.side * position_mm.x() / use.side_blend_mm);
    if (use.below_mm && position_mm.y() >= *use.below_mm) return 0;
    if (use.lateral_mm)
      mask *= 1 - SmoothStep((std::abs(position_mm.x()) - (*use.lateral_mm)[0]) /
                             ((*use.lateral_mm)[1] - (*use.lateral_mm)[0]));
    return mask;
  }

  Result<DisplacementField> CombineTargets(const std::vector<ImportRecipe::TargetUse>& uses) {
    std::vector<Eigen::Vector3d> sum(source_of_vertex_.size(), Eigen::Vector3d::Zero());
    for (const ImportRecipe::TargetUse& use : uses) {
      const auto dense = DenseTarget(use.target);
      if (!dense) return tl::unexpected(dense.error());
      for (std::size_t i = 0; i < sum.size(); ++i)
        if (!(*dense)[i].isZero(0)) sum[i] += use.gain * Mask(use, i) * (*dense)[i];
    }
    DisplacementField field;
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (!sum[i].isZero(1e-9)) {
        field.vertices.push_back(static_cast<int>(i));
        field.displacements_mm.push_back(sum[i]);
      }
    return field;
  }

  StageReport Report(const FaceRig& rig) const {
    StageReport report;
    report.stage = "import";
    const HeadSize size = MeasureHead(rig);
    report.figures = {{"vertices", rig.num_vertices()},
                      {"triangles", static_cast<double>(rig.neutral_mesh().triangles.size())},
                      {"parameters", rig.num_parameters()},
                      {"landmarks", static_cast<double>(rig.definition().landmarks.size())},
                      {"head_height_mm", size.height_mm}};
    report.texts.emplace_back("head_height_measured", size.measured_between);
    std::vector<std::string> missing;
    for (const std::string_view name : kArticulatoryParameters)
      if (!rig.FindParameter(name)) missing.emplace_back(name);
    std::vector<std::string> unused;
    for (const MorphSource::Target& target : source_.targets)
      if (!used_targets_.contains(target.name)) unused.push_back(target.name);
    report.texts.emplace_back("missing_parameters", fmt::format("{}", fmt::join(missing, ", ")));
    report.texts.emplace_back("unused_targets", fmt::format("{}", fmt::join(unused, ", ")));
    if (!missing.empty())
      report.warnings.push_back(
          fmt::format("the rig lacks the articulatory parameters {}: motion that "
                      "they would explain stays in the residual",
                      fmt::join(missing, ", ")));
    report.verdict = fmt::format("'{}' imported: {} vertices, {} of {} articulatory parameters",
                                 rig.definition().name, rig.num_vertices(),
                                 kArticulatoryParameters.size() - missing.size(),
                                 kArticulatoryParameters.size());
    report.options = {{"unit", options_.unit},
                      {"use_jaw_joint", options_.use_jaw_joint ? "true" : "false"}};
    return report;
  }

  const MorphSource& source_;
  const ImportRecipe& recipe_;
  const ImportOptions& options_;
  Eigen::Matrix3d rig_from_file_ = Eigen::Matrix3d::Identity();
  std::vector<Eigen::Vector3d> positions_mm_;  // of the file's vertices, in the rig frame
  std::vector<int> vertex_of_source_;
  std::vector<int> source_of_vertex_;
  std::vector<int> group_of_vertex_;
  std::set<std::string> used_targets_;
  std::map<std::string, std::vector<double>> ways_mm_;
  RigDefinition rig_;
};

}  // namespace

Result<StageResult<FaceRig>> BuildMorphRig(const MorphSource& source, const ImportRecipe& recipe,
                                           const ImportOptions& options) {
  return MorphRigBuilder(source, recipe, options).Build();
}

}  // namespace articap
