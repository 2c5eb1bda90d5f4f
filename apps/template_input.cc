// SPDX-License-Identifier: MIT
#include "apps/template_input.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "apps/take.h"
#include "tracking/learn_template.h"
#include "tracking/rigidity.h"

namespace articap {
namespace {

// The frame that is named, or some of them all.
Result<std::vector<int>> FramesToTry(const TemplateInput& input, const PointClouds& clouds) {
  constexpr int kTried = 8;
  if (input.frame == 0) return SpreadFrames(clouds.num_frames(), kTried);
  const int frame = static_cast<int>(std::lround(input.frame)) - clouds.first_frame;
  if (frame < 0 || frame >= clouds.num_frames())
    return Fail(fmt::format("--frame {}: the recording has the frames {} to {}", input.frame,
                            clouds.first_frame, clouds.first_frame + clouds.num_frames() - 1));
  return std::vector<int>{frame};
}

// With a map beside it, a layout is checked for an exchange of left and right.
Result<MarkerTemplate> LayoutFor(const TemplateInput& input) {
  std::optional<MarkerSet> set;
  if (!input.map.empty()) {
    Result<MarkerSet> read = ReadMap(input.map);
    if (!read) return tl::unexpected(read.error());
    set = std::move(*read);
  }
  if (input.layout.empty()) {
    if (set) return LayoutOf(*set);
    return Fail(
        "by what should the markers be named? Give --template, learnt from another take of this "
        "speaker, or a marker map with --map, or rough places with --layout");
  }
  Result<MarkerTemplate> layout = ReadMarkerTemplate(input.layout);
  if (!layout) return layout;
  if (set)
    if (const auto allowed = RefuseMirrored(*layout, *set); !allowed)
      return Fail(fmt::format("{}: {}", input.layout, allowed.error().message));
  return layout;
}

}  // namespace

void AddTemplateInput(VerbLine& line, TemplateInput& input) {
  line.Flag("--template", input.known, "FILE", "where the speaker's markers sit, learnt before");
  line.Flag("--map", input.map, "NAME|FILE",
            "marker map: without a template, markers are looked for at its landmarks");
  line.Flag("--layout", input.layout, "FILE",
            "rough places of the markers, in the form of a template; head axes, mm");
  line.Flag("--frame", input.frame, "N", "frame to learn from: all seen, speaker at rest");
}

Result<MarkerTemplate> TemplateFor(const TemplateInput& input, const PointClouds& clouds,
                                   std::span<const Eigen::Quaterniond> attitudes,
                                   const LabelOptions& options) {
  if (const auto checked = CheckOptions(options); !checked) return tl::unexpected(checked.error());
  if (!input.known.empty()) return ReadMarkerTemplate(input.known);
  const Result<MarkerTemplate> layout = LayoutFor(input);
  if (!layout) return layout;
  const Result<std::vector<int>> frames = FramesToTry(input, clouds);
  if (!frames) return tl::unexpected(frames.error());
  return LearnTemplate(clouds, *layout, *frames, attitudes, options);
}

}  // namespace articap
