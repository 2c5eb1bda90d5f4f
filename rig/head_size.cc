// SPDX-License-Identifier: MIT
#include "rig/head_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace articap {
namespace {

struct Unit {
  const char* name;
  const char* plural;
  double mm;
};
constexpr Unit kUnits[] = {{"cm", "centimetres", 10},
                           {"m", "metres", 1000},
                           {"dm", "decimetres", 100},
                           {"in", "inches", 25.4}};

bool IsHead(double height_mm, double max_height_mm) {
  return height_mm >= kMinHeadHeight_mm && height_mm <= max_height_mm;
}

}  // namespace

HeadSize MeasureHead(const FaceRig& rig) {
  const auto& vertices = rig.neutral_mesh().vertices;
  const auto crown = rig.FindLandmark("crown");
  const auto menton = rig.FindLandmark("menton");
  if (crown && menton)
    return {vertices[*crown].y() - vertices[*menton].y(), "from menton to crown",
            kMaxHeadHeight_mm};
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Eigen::Vector3i& triangle : rig.neutral_mesh().triangles)
    for (const int corner : {triangle[0], triangle[1], triangle[2]}) {
      low = std::min(low, vertices[corner].y());
      high = std::max(high, vertices[corner].y());
    }
  return {std::max(0.0, high - low), "over the whole mesh", kMaxHeadAndNeckHeight_mm};
}

Result<void> CheckHeadSize(const FaceRig& rig) {
  const HeadSize size = MeasureHead(rig);
  if (IsHead(size.height_mm, size.max_height_mm)) return {};
  std::string message = fmt::format("the head of '{}' is {:.4g} mm high ({})",
                                    rig.definition().name, size.height_mm, size.measured_between);
  const auto unit = std::find_if(std::begin(kUnits), std::end(kUnits), [&](const Unit& candidate) {
    return IsHead(size.height_mm * candidate.mm, size.max_height_mm);
  });
  if (unit != std::end(kUnits))
    message += fmt::format(": it looks like {}; pass --unit {}", unit->plural, unit->name);
  else
    message += fmt::format(
        ", and heads are {} to {} mm high; import the head alone, y up, in a unit "
        "that --unit names",
        kMinHeadHeight_mm, size.max_height_mm);
  return Fail(std::move(message));
}

}  // namespace articap
