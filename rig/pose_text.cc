// SPDX-License-Identifier: MIT
#include "rig/pose_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace articap {
namespace {

struct Assignment {
  std::string name;
  double value = 0;
  std::string unit;
};

Result<Assignment> ParseAssignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return Fail(
        fmt::format("'{}' is not of the form name=value, such as jaw_rotation=10deg", text));
  Assignment assignment;
  assignment.name = text.substr(0, equals);
  const char* const first = text.data() + equals + 1;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, assignment.value);
  if (error != std::errc()) return Fail(fmt::format("'{}': the value is not a number", text));
  assignment.unit.assign(end, last);
  return assignment;
}

template <class Items>
std::string ListNames(const Items& items) {
  std::string names;
  for (const auto& item : items) names += (names.empty() ? "" : ", ") + item.name;
  return names;
}

// Factor from the unit typed to the parameter's own; nothing where they do not go together. A
// rotation names its unit: degrees are what people see, and rad what is inside.
std::optional<double> UnitFactor(const std::string& typed, ParameterUnit unit) {
  if (typed.empty() && unit != ParameterUnit::kRadian) return 1;
  if (unit == ParameterUnit::kRadian && typed == "deg") return std::numbers::pi / 180;
  if (unit == ParameterUnit::kRadian && typed == "rad") return 1;
  if (unit == ParameterUnit::kMillimetre && typed == "mm") return 1;
  return std::nullopt;
}

}  // namespace

Result<Eigen::VectorXd> ParsePose(const FaceRig& rig, const std::vector<std::string>& assignments) {
  const auto& parameters = rig.definition().parameters;
  Eigen::VectorXd pose =
      Eigen::VectorXd::Constant(rig.num_parameters(), std::numeric_limits<double>::quiet_NaN());
  for (const std::string& text : assignments) {
    const auto assignment = ParseAssignment(text);
    if (!assignment) return Fail(assignment.error().message);
    const auto index = rig.FindParameter(assignment->name);
    if (!index)
      return Fail(fmt::format("the rig '{}' has no parameter '{}'; it has {}",
                              rig.definition().name, assignment->name, ListNames(parameters)));
    const RigParameter& parameter = parameters[*index];
    const auto factor = UnitFactor(assignment->unit, parameter.unit);
    if (!factor)
      return Fail(fmt::format(
          "'{}': {}; rotations take deg or rad, translations mm, such as "
          "jaw_rotation=10deg",
          text,
          assignment->unit.empty()
              ? "a rotation without a unit"
              : fmt::format("the unit '{}' does not fit the parameter", assignment->unit)));
    if (!std::isnan(pose[*index]))
      return Fail(fmt::format("'{}': {} is set twice", text, assignment->name));
    pose[*index] = *factor * assignment->value;
    if (!(pose[*index] >= parameter.min && pose[*index] <= parameter.max))
      return Fail(fmt::format("'{}' is outside the range of the rig, {:.4g} to {:.4g} {}", text,
                              parameter.min / *factor, parameter.max / *factor, assignment->unit));
  }
  return pose.unaryExpr([](double value) { return std::isnan(value) ? 0.0 : value; });
}

Result<std::vector<std::optional<double>>> ParseIdentity(
    const FaceRig& rig, const std::vector<std::string>& assignments) {
  const auto& sliders = rig.definition().identity_sliders;
  std::vector<std::optional<double>> identity(sliders.size());
  for (const std::string& text : assignments) {
    const auto assignment = ParseAssignment(text);
    if (!assignment) return Fail(assignment.error().message);
    std::size_t index = 0;
    while (index < sliders.size() && sliders[index].name != assignment->name) ++index;
    if (index == sliders.size())
      return Fail(fmt::format("the rig '{}' has no identity slider '{}'; it has {}",
                              rig.definition().name, assignment->name, ListNames(sliders)));
    if (!assignment->unit.empty())
      return Fail(fmt::format("'{}': identity sliders take plain numbers", text));
    if (!(assignment->value >= sliders[index].min && assignment->value <= sliders[index].max))
      return Fail(fmt::format("'{}' is outside the range of the slider, {:.4g} to {:.4g}", text,
                              sliders[index].min, sliders[index].max));
    identity[index] = assignment->value;
  }
  return identity;
}

}  // namespace articap
