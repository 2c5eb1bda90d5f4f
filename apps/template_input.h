// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>

#include "apps/verb_line.h"
#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "core/result.h"
#include "tracking/label.h"

namespace articap {

// By what markers get their names; what the verbs that label have in common.
struct TemplateInput {
  std::string known;   // a template that was learnt before
  std::string layout;  // rough places, in the same form
  std::string map;     // a marker map: typical places of its landmarks
  double frame = 0;    // the reference pose's, as the recording counts; 0: tried out
};
void AddTemplateInput(VerbLine& line, TemplateInput& input);

// The template that is given, or one that is learnt from this recording. The head is looked for in
// the given attitudes.
Result<MarkerTemplate> TemplateFor(const TemplateInput& input, const PointClouds& clouds,
                                   std::span<const Eigen::Quaterniond> attitudes,
                                   const LabelOptions& options);

}  // namespace articap
