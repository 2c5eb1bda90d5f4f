// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tracking/stabilize.h"

namespace articap {

// What the map, the options and the take together ask for.
struct StabilizeSetup {
  StabilizationMode mode = StabilizationMode::kRigid;
  std::optional<DeclaredAxes> axes;
  std::vector<int> references;  // columns of the tracks; empty in mode none
  std::vector<std::string> warnings;
};
Result<StabilizeSetup> ResolveSetup(const StageTracks& tracks, const MarkerSet& set,
                                    const std::optional<HeadShape>& given_shape,
                                    const StabilizeOptions& options);

StageReport StartReport(const StabilizeSetup& setup, const StabilizeOptions& options);

// The rigid mode; the others are in stabilize.cc.
Result<StageResult<Stabilized>> StabilizeRigid(const StageTracks& tracks, const MarkerSet& set,
                                               const std::optional<HeadShape>& given_shape,
                                               const StabilizeSetup& setup,
                                               const StabilizeOptions& options);

}  // namespace articap
