// SPDX-License-Identifier: MIT
#include "tracking/stabilize_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tracking/pose_smoothing.h"

namespace articap {
namespace {

Result<void> CheckOptions(const StabilizeOptions& options, double rate_hz) {
  if (auto good = RequirePositive({{"max_rotation_sigma_deg", options.max_rotation_sigma_deg},
                                   {"max_residual_mm", options.max_residual_mm},
                                   {"outlier_sigmas", options.outlier_sigmas},
                                   {"shape_tolerance_mm", options.shape_tolerance_mm},
                                   {"max_reference_motion_mm", options.max_reference_motion_mm}});
      !good)
    return good;
  if (options.shape_frames < 2)
    return Fail(fmt::format("shape_frames is {}; it must be at least 2", options.shape_frames));
  const double lowest_hz = kLowestPoseCutoff * rate_hz, highest_hz = kHighestPoseCutoff * rate_hz;
  if (options.pose_cutoff_hz != 0 &&
      !(options.pose_cutoff_hz >= lowest_hz && options.pose_cutoff_hz <= highest_hz))
    return Fail(fmt::format(
        "pose_cutoff_hz is {}; at {} frames a second it must lie from {:.3g} to {:.3g}, or be 0",
        options.pose_cutoff_hz, rate_hz, lowest_hz, highest_hz));
  return {};
}

Result<std::optional<DeclaredAxes>> ResolveAxes(const MarkerSet& set,
                                                const StabilizeOptions& options) {
  const std::string* const texts[] = {&options.left, &options.up, &options.forward};
  const auto num_given = std::ranges::count_if(texts, [](auto* text) { return !text->empty(); });
  if (num_given == 0) return set.axes;
  if (num_given != 3)
    return Fail("of the axes left, up and forward only some are given; give all three");
  Eigen::Vector3d axes[3];
  for (int i = 0; i < 3; ++i) {
    const auto axis = ParseAxis(*texts[i]);
    if (!axis) return tl::unexpected(axis.error());
    axes[i] = *axis;
  }
  const auto declared = MakeDeclaredAxes(axes[0], axes[1], axes[2]);
  if (!declared) return tl::unexpected(declared.error());
  return *declared;
}

StabilizationMode ResolveMode(const MarkerSet& set, ModeChoice choice) {
  switch (choice) {
    case ModeChoice::kFromMap:
      return set.mode;
    case ModeChoice::kRigid:
      return StabilizationMode::kRigid;
    case ModeChoice::kTranslation:
      return StabilizationMode::kTranslation;
    case ModeChoice::kNone:
      return StabilizationMode::kNone;
  }
  return set.mode;
}

// By the options, else by the map, else all points of a given shape.
std::vector<std::string> ReferenceNames(const MarkerSet& set,
                                        const std::optional<HeadShape>& given_shape,
                                        const StabilizeOptions& options) {
  if (!options.head.empty()) return options.head;
  std::vector<std::string> names;
  for (const MarkerRole& marker : set.markers)
    if (marker.head_reference) names.push_back(marker.name);
  if (names.empty() && given_shape)
    for (const NamedPoint& point : given_shape->points) names.push_back(point.name);
  return names;
}

Result<void> FindReferences(const StageTracks& tracks, const std::vector<std::string>& names,
                            bool is_asked_for, StabilizeSetup& setup) {
  for (const std::string& name : names) {
    const auto column = tracks.Find(name);
    if (!column && is_asked_for)
      return Fail(fmt::format("there is no marker '{}' to take as a reference; the take has {}",
                              name, fmt::join(tracks.names(), ", ")));
    if (!column) {
      setup.warnings.push_back(
          fmt::format("the reference '{}' of the map is not in the take", name));
      continue;
    }
    if (std::ranges::find(setup.references, *column) != setup.references.end())
      return Fail(fmt::format("the reference '{}' is named twice", name));
    setup.references.push_back(*column);
  }
  return {};
}

Result<void> CheckCount(const StageTracks& tracks, const StabilizeSetup& setup) {
  const std::size_t count = setup.references.size();
  if (setup.mode == StabilizationMode::kRigid && count < 3)
    return Fail(fmt::format(
        "the mode rigid needs three references or more, and has {}; name them with --head "
        "(--stabilize-head in bind and fit), or with "
        "the role head in the marker map. The take has {}",
        count, fmt::join(tracks.names(), ", ")));
  if (setup.mode == StabilizationMode::kTranslation && count != 1)
    return Fail(fmt::format(
        "the mode translation takes exactly one reference, e.g. the nose, and has {}; name it with "
        "--head (--stabilize-head in bind and fit), or with the role head in the marker map. The "
        "take has {}",
        count, fmt::join(tracks.names(), ", ")));
  return {};
}

}  // namespace

Result<MarkerSet> ChosenSet(const MarkerSet& set, const StabilizeOptions& options) {
  const auto axes = ResolveAxes(set, options);
  if (!axes) return tl::unexpected(axes.error());
  MarkerSet chosen = set;
  chosen.axes = *axes;
  chosen.mode = ResolveMode(set, options.mode);
  if (options.head.empty()) return chosen;
  for (MarkerRole& marker : chosen.markers) marker.head_reference = false;
  for (const std::string& name : options.head) {
    const auto known = std::ranges::find(chosen.markers, name, &MarkerRole::name);
    if (known != chosen.markers.end())
      known->head_reference = true;
    else
      chosen.markers.push_back({.name = name, .head_reference = true});
  }
  return chosen;
}

Result<StabilizeSetup> ResolveSetup(const StageTracks& tracks, const MarkerSet& set,
                                    const std::optional<HeadShape>& given_shape,
                                    const StabilizeOptions& options) {
  if (auto valid = CheckOptions(options, tracks.rate_hz()); !valid)
    return tl::unexpected(valid.error());
  const auto axes = ResolveAxes(set, options);
  if (!axes) return tl::unexpected(axes.error());
  if (tracks.num_frames() == 0)
    return Fail("the take has no frames: there is nothing to stabilise");
  StabilizeSetup setup;
  setup.axes = *axes;
  setup.mode = ResolveMode(set, options.mode);
  if (setup.mode == StabilizationMode::kNone) return setup;
  if (auto found = FindReferences(tracks, ReferenceNames(set, given_shape, options),
                                  !options.head.empty(), setup);
      !found)
    return tl::unexpected(found.error());
  if (auto enough = CheckCount(tracks, setup); !enough) return tl::unexpected(enough.error());
  return setup;
}

StageReport StartReport(const StabilizeSetup& setup, const StabilizeOptions& options) {
  StageReport report;
  report.stage = "stabilize";
  report.warnings = setup.warnings;
  report.options = EchoOptions(options);
  return report;
}

}  // namespace articap
