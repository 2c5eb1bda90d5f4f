// SPDX-License-Identifier: MIT
#include "tracking/relative_to_marker.h"

#include <cmath>
#include <limits>

#include "core/check.h"

namespace articap {

MarkerRecording RelativeToMarker(const MarkerRecording& recording, std::string_view marker) {
  const StageTracks& from = recording.tracks;
  const auto origin = from.Find(marker);
  ARTICAP_CHECK(origin.has_value());
  MarkerRecording relative = recording;
  std::size_t sample = 0;
  for (int frame = 0; frame < from.num_frames(); ++frame)
    for (int m = 0; m < from.num_markers(); ++m, ++sample) {
      if (from.is_missing(frame, m)) continue;
      if (from.is_missing(frame, *origin)) {
        relative.tracks.SetMissing(frame, m);
        if (!relative.residuals_mm.empty())
          relative.residuals_mm[sample] = std::numeric_limits<float>::quiet_NaN();
        if (!relative.camera_masks.empty()) relative.camera_masks[sample] = 0;
        continue;
      }
      const bool is_measured = from.state(frame, m) == SampleState::kMeasured &&
                               from.state(frame, *origin) == SampleState::kMeasured;
      relative.tracks.Set(
          frame, m, from.position_mm(frame, m) - from.position_mm(frame, *origin),
          is_measured ? SampleState::kMeasured : SampleState::kFilled,
          m == *origin ? 0.0F : std::hypot(from.sigma_mm(frame, m), from.sigma_mm(frame, *origin)));
      // C3D calls samples of residual 0 generated.
      if (!is_measured && !relative.residuals_mm.empty()) relative.residuals_mm[sample] = 0;
    }
  return relative;
}

}  // namespace articap
