// SPDX-License-Identifier: MIT
#include "fitting/landmark_assignment.h"

#include <algorithm>
#include <optional>

#include "core/landmarks.h"
#include "fitting/identity_fit.h"

namespace articap {
namespace {

// How far landmarks reach in each round, mm.
constexpr double kReaches_mm[] = {25, 20, 16, 12};

std::vector<Eigen::Vector3d> Moved(const Sim3d& transform,
                                   std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> moved;
  for (const Eigen::Vector3d& point : points) moved.push_back(transform * point);
  return moved;
}

// Where a smooth face lets the cloud slip up or down by a lip's height, one of these starts is
// right, mm.
constexpr double kLifts_mm[] = {0, -10, 10, -20, 20};

constexpr std::ptrdiff_t kLeastOnSpectacles = 3;

bool IsOfSpectacles(const std::string& landmark) { return landmark.starts_with("spectacles"); }

std::vector<AssignedLandmark> AssignNearestFirst(const FaceSurface& surface,
                                                 std::span<const Eigen::Vector3d> points_in_rig,
                                                 double reach_mm, bool with_spectacles) {
  struct Pair {
    double distance_mm;
    std::size_t point, place;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < points_in_rig.size(); ++i)
    for (std::size_t k = 0; k < surface.places().size(); ++k) {
      const FaceSurface::NamedPlace& place = surface.places()[k];
      if (!with_spectacles && IsOfSpectacles(place.landmark)) continue;
      const double distance_mm = (points_in_rig[i] - place.point_in_rig).norm();
      if (distance_mm <= reach_mm && FindLandmark(place.landmark))
        pairs.push_back({distance_mm, i, k});
    }
  std::ranges::stable_sort(pairs, {}, &Pair::distance_mm);
  std::vector<AssignedLandmark> assigned(points_in_rig.size());
  std::vector<bool> taken(surface.places().size(), false);
  for (const Pair& pair : pairs) {
    if (taken[pair.place] || !assigned[pair.point].landmark.empty()) continue;
    taken[pair.place] = true;
    assigned[pair.point] = {surface.places()[pair.place].landmark, pair.distance_mm};
  }
  return assigned;
}

Result<AdaptedRig> AdaptFrom(const FaceRig& rig, std::span<const Eigen::Vector3d> cloud_mm,
                             const Sim3d& rig_from_cloud, const CloudModel& model) {
  auto surface = FaceSurface::Create(rig);
  if (!surface) return tl::unexpected(surface.error());
  AdaptedRig adapted{rig, *std::move(surface), {rig_from_cloud, 0}};
  const Eigen::VectorXd neutral_pose = Eigen::VectorXd::Zero(rig.num_parameters());
  const std::vector<std::optional<double>> all_free(rig.definition().identity_sliders.size());
  for (const double reach_mm : kReaches_mm) {
    const auto assigned =
        AssignLandmarks(adapted.surface, Moved(adapted.fit.rig_from_cloud, cloud_mm), reach_mm);
    std::vector<LandmarkPoint> pairs;
    for (std::size_t i = 0; i < cloud_mm.size(); ++i)
      if (const auto vertex = rig.FindLandmark(assigned[i].landmark))
        pairs.push_back({*vertex, cloud_mm[i], 0});
    if (pairs.size() >= 3 && !all_free.empty()) {
      adapted.rig = rig.WithIdentity(
          FitIdentity(rig, neutral_pose, pairs, adapted.fit.rig_from_cloud, all_free));
      surface = FaceSurface::Create(adapted.rig);
      if (!surface) return tl::unexpected(surface.error());
      adapted.surface = *std::move(surface);
    }
    CloudModel wide = model;
    wide.landmark_sd_mm = std::max(model.landmark_sd_mm, reach_mm / 2);
    adapted.fit = RefineCloudAlignment(adapted.surface, cloud_mm, adapted.fit.rig_from_cloud, wide,
                                       /*at_landmarks=*/true);
  }
  adapted.fit = RefineCloudAlignment(adapted.surface, cloud_mm, adapted.fit.rig_from_cloud, model,
                                     /*at_landmarks=*/true);
  return adapted;
}

}  // namespace

std::vector<AssignedLandmark> AssignLandmarks(const FaceSurface& surface,
                                              std::span<const Eigen::Vector3d> points_in_rig,
                                              double reach_mm) {
  auto assigned = AssignNearestFirst(surface, points_in_rig, reach_mm, /*with_spectacles=*/true);
  const auto on_spectacles = std::ranges::count_if(
      assigned, [](const AssignedLandmark& place) { return IsOfSpectacles(place.landmark); });
  if (on_spectacles >= kLeastOnSpectacles) return assigned;
  return AssignNearestFirst(surface, points_in_rig, reach_mm, /*with_spectacles=*/false);
}

Result<AdaptedRig> AdaptIdentity(const FaceRig& rig, std::span<const Eigen::Vector3d> cloud_mm,
                                 const Sim3d& rig_from_cloud, const CloudModel& model) {
  std::optional<AdaptedRig> best;
  for (const double lift_mm : kLifts_mm) {
    Sim3d start = rig_from_cloud;
    start.translation_mm.y() += lift_mm;
    auto adapted = AdaptFrom(rig, cloud_mm, start, model);
    if (!adapted) return tl::unexpected(adapted.error());
    if (!best || adapted->fit.cost < best->fit.cost) best = *std::move(adapted);
  }
  return *std::move(best);
}

}  // namespace articap
