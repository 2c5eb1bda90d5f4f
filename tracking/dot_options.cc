// SPDX-License-Identifier: MIT
#include "tracking/dot_options.h"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "tracking/dot_detector.h"

namespace articap {

void VisitOptions(DotDetectorOptions& options, OptionVisitor& visit) {
  visit.Enumeration("polarity", options.polarity, {"bright", "dark"},
                    "whether dots are brighter or darker than what surrounds them");
  visit("min_diameter_px", options.min_diameter_px, "smaller spots are no dots; px");
  visit("max_diameter_px", options.max_diameter_px, "larger spots are no dots; px");
  visit("min_roundness", options.min_roundness,
        "shortest over longest axis of a dot, at least; 0 to 1");
  visit("max_blur_px", options.max_blur_px,
        "softer spots are highlights, not dots; standard deviation of the blur, px");
  visit("min_contrast", options.min_contrast,
        "difference of a dot from what surrounds it, at least; part of the full range");
  visit("sensitivity", options.sensitivity,
        "the same in standard deviations of a pixel's noise: less finds fainter dots");
  visit("max_misfit", options.max_misfit,
        "what a dot may differ from a blurred ellipse beyond noise; part of the contrast");
  visit("color", options.color,
        "of the dots in pictures in colour, #rrggbb; empty: bright or dark ones");
  visit.Enumeration("tone", options.tone, {"linear", "srgb"},
                    "how the file's values come from light: machine vision, or camcorders");
  visit("read_noise", options.read_noise,
        "standard deviation of a pixel without light, part of the full range; not given: from the "
        "picture");
  visit("noise_gain", options.noise_gain,
        "variance that light adds per light, parts of the full range; not given: from the picture");
  visit("regions", options.regions,
        "where dots may be, polygons \"x:y x:y x:y\" of the picture, px; none: everywhere");
  visit("most_dots", options.most_dots, "in one picture; the clearest are kept");
}

Result<void> CheckOptions(const DotDetectorOptions& options) {
  if (const auto checked = RequirePositive({{"min_diameter_px", options.min_diameter_px},
                                            {"max_diameter_px", options.max_diameter_px},
                                            {"max_blur_px", options.max_blur_px},
                                            {"min_contrast", options.min_contrast},
                                            {"sensitivity", options.sensitivity},
                                            {"max_misfit", options.max_misfit},
                                            {"most_dots", options.most_dots}});
      !checked)
    return checked;
  if (const auto checked = RequireNotNegative({{"min_roundness", options.min_roundness},
                                               {"read_noise", options.read_noise.value_or(0)},
                                               {"noise_gain", options.noise_gain.value_or(0)}});
      !checked)
    return checked;
  if (options.min_roundness > 1)
    return Fail(
        fmt::format("min_roundness {}: a circle has 1, no dot has more", options.min_roundness));
  constexpr double kLeast_px = 2, kLargest_px = 400;
  if (options.min_diameter_px < kLeast_px || options.max_diameter_px > kLargest_px ||
      options.min_diameter_px > options.max_diameter_px)
    return Fail(
        fmt::format("dots from {} to {} px: give diameters from {} to {} px, the smaller "
                    "one first",
                    options.min_diameter_px, options.max_diameter_px, kLeast_px, kLargest_px));
  if (const auto color = ParseDotColor(options.color); !color) return tl::unexpected(color.error());
  for (const std::string& region : options.regions)
    if (const auto polygon = ParseRegion(region); !polygon) return tl::unexpected(polygon.error());
  return {};
}

Result<std::optional<Eigen::Vector3f>> ParseDotColor(const std::string& text) {
  if (text.empty()) return std::optional<Eigen::Vector3f>();
  const bool is_hexadecimal =
      text.size() == 7 && text[0] == '#' &&
      text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!is_hexadecimal)
    return Fail(fmt::format("color \"{}\": write #rrggbb, such as #00a0ff", text));
  const auto rgb = static_cast<unsigned>(std::strtoul(text.c_str() + 1, nullptr, 16));
  return Eigen::Vector3f(static_cast<float>(rgb >> 16), static_cast<float>(rgb >> 8 & 255),
                         static_cast<float>(rgb & 255)) /
         255;
}

Result<DotRegion> ParseRegion(const std::string& text) {
  DotRegion region;
  std::istringstream corners(text);
  std::string corner;
  while (corners >> corner) {
    double x = 0, y = 0;
    char colon = 0, rest = 0;
    std::istringstream numbers(corner);
    if (!(numbers >> x >> colon >> y) || colon != ':' || numbers >> rest)
      return Fail(fmt::format("region \"{}\": \"{}\" is no corner; write x:y in px", text, corner));
    region.corners_px.emplace_back(x, y);
  }
  if (region.corners_px.size() < 3)
    return Fail(
        fmt::format("region \"{}\": a polygon has three corners or more, x:y each, with "
                    "spaces between them",
                    text));
  return region;
}

bool DotRegion::Contains(const Eigen::Vector2d& point_px) const {
  bool inside = false;
  Eigen::Vector2d last = corners_px.back();
  for (const Eigen::Vector2d& corner : corners_px) {
    if ((corner.y() > point_px.y()) != (last.y() > point_px.y())) {
      const double part = (point_px.y() - corner.y()) / (last.y() - corner.y());
      if (point_px.x() < corner.x() + part * (last.x() - corner.x())) inside = !inside;
    }
    last = corner;
  }
  return inside;
}

}  // namespace articap
