// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/point_cloud.h"
#include "core/transforms.h"
#include "tracking/label.h"
#include "tracking/label_assignment.h"

namespace articap {

struct FoundHead {
  Rigid3d template_from_stage;
  std::vector<int> points;  // by marker
  double cost = 0;          // TotalCost of it
  // What a distinctly other pose (by more than 20 degrees or 30 mm) would cost at least, as far as
  // any was met; infinite otherwise.
  double next_cost = 0;
};

// Finds the head in a cloud without knowing anything of other frames. Triples of points whose
// distances are those of three rigid markers propose poses; where there are no such markers, the
// attitude that the template was learnt in and some turns of it do, shifted so that any marker is
// any point. The best are refined. Nothing where fewer than `least_share` of the markers are found.
std::optional<FoundHead> FindHead(std::span<const MarkerPlace> markers,
                                  std::span<const CloudPoint> cloud, const LabelPriors& priors,
                                  const LabelOptions& options);

}  // namespace articap
