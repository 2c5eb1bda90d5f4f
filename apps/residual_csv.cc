// SPDX-License-Identifier: MIT
#include "apps/residual_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace articap {
namespace {

// Marker names come from files: a comma, a quote or a line end in one is quoted as RFC 4180 does.
std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  return quoted + '"';
}

}  // namespace

std::string WriteResidualCsv(const ShapeFit& fit) {
  const RigTracks& tracks = fit.measured;
  std::string text = "frame,time_s";
  for (const std::string& name : tracks.names()) text += "," + Cell(name + "_mm");
  text += "\n";
  text.reserve(text.size() + static_cast<std::size_t>(fit.residuals_mm.size() + 1) * 8);
  const auto out = std::back_inserter(text);
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    fmt::format_to(out, "{},{:.6f}", tracks.first_frame() + frame, SecondsOf(tracks.time(frame)));
    for (Eigen::Index marker = 0; marker < fit.residuals_mm.cols(); ++marker) {
      const float residual_mm = fit.residuals_mm(frame, marker);
      if (std::isfinite(residual_mm))
        fmt::format_to(out, ",{:.4f}", residual_mm);
      else
        text += ',';
    }
    text += '\n';
  }
  return text;
}

}  // namespace articap
