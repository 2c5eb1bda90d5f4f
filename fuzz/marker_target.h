// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

#include "core/io/marker_info.h"
#include "core/marker_io.h"

namespace articap {

// What every file of markers must survive: it is read or refused with a message; what was read can
// be described, and written, read and written again without changing a byte. Aborts where that is
// not so.
inline void CheckMarkerBytes(std::span<const std::byte> bytes, const char* source_name,
                             std::span<const MarkerFormat> formats) {
  MarkerReadOptions options;
  options.unit = "mm";
  auto recording = ParseMarkers(bytes, source_name, options);
  if (!recording) recording = ParseMarkers(bytes, source_name);
  if (!recording) {
    if (recording.error().message.empty()) std::abort();
    return;
  }
  if (DescribeRecording(*recording, source_name).verdict.empty()) std::abort();
  // Thousands of markers would only cost time.
  if (recording->tracks.num_markers() > 2000) return;
  for (const MarkerFormat format : formats) {
    LossesOf(*recording, format);
    if (LimitExceeded(*recording, format)) continue;
    const std::string once = FormatMarkers(*recording, format);
    const auto read = ParseMarkers(std::as_bytes(std::span(once)), "written");
    if (!read) {
      std::fprintf(stderr, "written as %s, not readable: %s\n", NameOf(format),
                   read.error().message.c_str());
      std::abort();
    }
    if (FormatMarkers(*read, format) != once) {
      std::fprintf(stderr, "written as %s, changes when written again\n", NameOf(format));
      std::abort();
    }
  }
}

}  // namespace articap
