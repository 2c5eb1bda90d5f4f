// SPDX-License-Identifier: MIT
#include "synthetic/attachment.h"

#include <fmt/format.h>

#include "rig/attachment.h"

namespace articap {
namespace {

Result<VirtualMarker> AttachRole(const FaceRig& rig, const Attacher& attacher,
                                 const MarkerRole& role, const Eigen::Vector3d& misplacement_mm) {
  const std::string& rig_name = rig.definition().name;
  const auto vertex = rig.FindLandmark(role.landmark);
  if (!vertex)
    return Fail(
        fmt::format("marker '{}' sits at landmark '{}', which the rig '{}' does not have; "
                    "docs/landmarks.md lists the landmarks",
                    role.name, role.landmark, rig_name));
  const auto region =
      role.region.empty() ? RegionOfVertex(rig, *vertex) : rig.FindRegion(role.region);
  if (!region)
    return Fail(fmt::format("marker '{}' lies in region '{}', which the rig '{}' does not have",
                            role.name, role.region, rig_name));
  auto attached = attacher.AttachInRegion(role.name, *region,
                                          rig.neutral_mesh().vertices[*vertex] + misplacement_mm);
  if (!attached)
    return Fail(fmt::format("landmark '{}' of marker '{}' is not on a surface of the rig '{}'",
                            role.landmark, role.name, rig_name));
  attached->u_mm = role.offset_mm;
  return *attached;
}

}  // namespace

Result<std::vector<VirtualMarker>> AttachMarkers(const FaceRig& rig, const MarkerSet& set,
                                                 double misplacement_mm, RandomGenerator& random) {
  const Attacher attacher(rig, Eigen::VectorXd::Zero(rig.num_parameters()));
  std::vector<VirtualMarker> attachments;
  for (const MarkerRole& role : set.markers) {
    const Eigen::Vector3d beside_mm = misplacement_mm * random.Uniform() * random.Direction();
    auto attached = AttachRole(rig, attacher, role, beside_mm);
    if (!attached) return tl::unexpected(attached.error());
    attachments.push_back(*std::move(attached));
  }
  return attachments;
}

}  // namespace articap
