// SPDX-License-Identifier: MIT
#include "core/view_regions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace articap {

Result<void> SetViewRegions(const std::vector<std::string>& texts, CameraArray& array) {
  const std::vector<View> views = array.views();
  std::vector<std::string> names;
  for (const View& view : views) names.push_back(array.NameOf(view));
  std::set<std::string> given;
  for (const std::string& text : texts) {
    const std::size_t sign = text.rfind('=');
    if (sign == std::string::npos)
      return Fail(fmt::format(
          "view region '{}': write VIEW=WIDTHxHEIGHT+LEFT+TOP in px, as {}=640x720+640+0", text,
          names.back()));
    const std::string name = text.substr(0, sign);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      return Fail(fmt::format("view region '{}': there is no view '{}'; there are {}", text, name,
                              fmt::join(names, ", ")));
    if (!given.insert(name).second)
      return Fail(fmt::format("view '{}' is given two regions; give the one around both", name));
    const Result<PictureRegion> region = ParsePictureRegion(text.substr(sign + 1));
    if (!region) return Fail(fmt::format("view region '{}': {}", text, region.error().message));
    array.RegionOf(views[static_cast<std::size_t>(found - names.begin())]) = *region;
  }
  return CheckRegions(array);
}

Result<void> CheckRegions(const CameraArray& array) {
  for (const View& view : array.views()) {
    const auto& region = array.RegionOf(view);
    const Camera& camera = array.cameras[view.camera];
    if (region && (region->left < 0 || region->top < 0 || region->width < 1 || region->height < 1 ||
                   region->width > camera.width - region->left ||
                   region->height > camera.height - region->top))
      return Fail(fmt::format("region {} of view '{}' does not lie within its picture of {}x{}",
                              FormatPictureRegion(*region), array.NameOf(view), camera.width,
                              camera.height));
  }
  return {};
}

}  // namespace articap
