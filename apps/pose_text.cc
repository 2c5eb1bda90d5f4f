// SPDX-License-Identifier: MIT
#include "apps/pose_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

namespace articap {
namespace {

constexpr double kDegreesOfRadian = 180 / std::numbers::pi;

struct Assignment {
  std::string name;
  double number = 0;
  std::string unit;
};

Result<Assignment> ParseAssignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  Assignment assignment;
  assignment.name = text.substr(0, equals);
  const char* begin = equals == std::string::npos ? nullptr : text.data() + equals + 1;
  const char* end = text.data() + text.size();
  if (begin != nullptr && begin != end && *begin == '+') ++begin;
  const auto [rest, error] = begin == nullptr
                                 ? std::from_chars_result{end, std::errc::invalid_argument}
                                 : std::from_chars(begin, end, assignment.number);
  if (error != std::errc() || !std::isfinite(assignment.number))
    return Fail(fmt::format("'{}' is not NAME=NUMBER, e.g. jaw_rotation=10deg", text));
  assignment.unit.assign(rest, end);
  return assignment;
}

Result<std::vector<Assignment>> ParseAssignments(const std::string& text) {
  std::vector<Assignment> assignments;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    Result<Assignment> assignment = ParseAssignment(text.substr(begin, end - begin));
    if (!assignment) return tl::unexpected(assignment.error());
    assignments.push_back(std::move(*assignment));
    begin = end + 1;
  }
  return assignments;
}

// The value inside: rad, mm or 1.
Result<double> ConvertUnit(const Assignment& assignment, ParameterUnit unit) {
  const std::string& given = assignment.unit;
  if (unit == ParameterUnit::kRadian) {
    if (given == "deg") return assignment.number / kDegreesOfRadian;
    if (given == "rad") return assignment.number;
    return Fail(fmt::format("{}={}{}: a rotation needs its unit, deg or rad", assignment.name,
                            assignment.number, given));
  }
  if (given.empty() || given == DisplayUnitOf(unit)) return assignment.number;
  return Fail(fmt::format("{}={}{}: '{}' is not a unit of this parameter; {}", assignment.name,
                          assignment.number, given, given,
                          unit == ParameterUnit::kMillimetre ? "it is in mm" : "it has none"));
}

std::string UnknownName(const std::string& name, const char* what, const std::string& known) {
  return fmt::format("the rig has no {} '{}'; it has {}", what, name, known);
}

template <class Entries>
std::string NamesOf(const Entries& entries) {
  std::string names;
  for (const auto& entry : entries) names += (names.empty() ? "" : ", ") + entry.name;
  return names.empty() ? "none" : names;
}

// Ranges are often computed; a value typed at the end of one is inside.
bool IsWithin(double value, double min, double max) {
  const double slack = 1e-6 * (max - min);
  return value >= min - slack && value <= max + slack;
}

}  // namespace

const char* DisplayUnitOf(ParameterUnit unit) {
  switch (unit) {
    case ParameterUnit::kRadian:
      return "deg";
    case ParameterUnit::kMillimetre:
      return "mm";
    case ParameterUnit::kWeight:
      return "";
  }
  return "";
}

double DisplayValueOf(double value, ParameterUnit unit) {
  return unit == ParameterUnit::kRadian ? value * kDegreesOfRadian : value;
}

Result<Eigen::VectorXd> ParsePose(const std::string& text, const FaceRig& rig) {
  const auto assignments = ParseAssignments(text);
  if (!assignments) return tl::unexpected(assignments.error());
  Eigen::VectorXd pose = Eigen::VectorXd::Zero(rig.num_parameters());
  for (const Assignment& assignment : *assignments) {
    const auto index = rig.FindParameter(assignment.name);
    if (!index)
      return Fail(UnknownName(assignment.name, "parameter", NamesOf(rig.definition().parameters)));
    const RigParameter& parameter = rig.definition().parameters[*index];
    const Result<double> value = ConvertUnit(assignment, parameter.unit);
    if (!value) return tl::unexpected(value.error());
    if (!IsWithin(*value, parameter.min, parameter.max))
      return Fail(fmt::format(
          "{}={}{} is outside its range of {:.4g} to {:.4g} {}", assignment.name, assignment.number,
          assignment.unit, DisplayValueOf(parameter.min, parameter.unit),
          DisplayValueOf(parameter.max, parameter.unit), DisplayUnitOf(parameter.unit)));
    pose[*index] = *value;
  }
  return pose;
}

Result<Eigen::VectorXd> ParseIdentity(const std::string& text, const FaceRig& rig) {
  const auto assignments = ParseAssignments(text);
  if (!assignments) return tl::unexpected(assignments.error());
  const std::vector<IdentitySlider>& sliders = rig.definition().identity_sliders;
  Eigen::VectorXd identity = rig.identity();
  for (const Assignment& assignment : *assignments) {
    std::size_t index = 0;
    while (index < sliders.size() && sliders[index].name != assignment.name) ++index;
    if (index == sliders.size())
      return Fail(UnknownName(assignment.name, "identity slider", NamesOf(sliders)));
    if (!assignment.unit.empty())
      return Fail(fmt::format("{}={}{}: identity sliders have no unit", assignment.name,
                              assignment.number, assignment.unit));
    if (!IsWithin(assignment.number, sliders[index].min, sliders[index].max))
      return Fail(fmt::format("{}={} is outside its range of {:.4g} to {:.4g}", assignment.name,
                              assignment.number, sliders[index].min, sliders[index].max));
    identity[static_cast<Eigen::Index>(index)] = assignment.number;
  }
  return identity;
}

}  // namespace articap
