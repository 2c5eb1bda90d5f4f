// SPDX-License-Identifier: MIT
#include "synthetic/take_files.h"

#include <fmt/format.h>

#include <charconv>
#include <iterator>

#include "core/marker_io.h"
#include "core/version.h"
#include "synthetic/text_grid_writer.h"

namespace articap {
namespace {

const char* NameOfFault(SampleFault fault) {
  switch (fault) {
    case SampleFault::kNone:
      return "none";
    case SampleFault::kDropout:
      return "dropout";
    case SampleFault::kGap:
      return "gap";
    case SampleFault::kOutlier:
      return "outlier";
    case SampleFault::kSwap:
      return "swap";
  }
  return "none";
}

// The shortest text that reads back as the same number, with the point that makes it a TOML float.
std::string TomlFloat(double value) {
  std::string text = fmt::format("{}", value + 0.0);  // no negative zero
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string TomlString(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    if (static_cast<unsigned char>(letter) < 0x20)
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned char>(letter));
    else
      quoted += letter;
  }
  return quoted + '"';
}

// Numbers and truth values as they are, everything else as a string.
std::string TomlOption(const std::string& text) {
  double number = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
  return is_number || text == "true" || text == "false" ? text : TomlString(text);
}

using Options = std::vector<std::pair<std::string, std::string>>;

std::string WriteOptions(const std::string& table, const Options& options) {
  std::string text = fmt::format("\n[{}]\n", table);
  for (const auto& [name, value] : options)
    text += fmt::format("{} = {}\n", name, TomlOption(value));
  return text;
}

std::string WriteTruthToml(const SyntheticTake& take, const DisturbedRecording& recorded,
                           const SyntheticNoiseOptions& noise,
                           const std::vector<NamedOptions>& further) {
  std::string text = "# A synthetic take: who spoke, and what was done to the markers.\n";
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "articap_version = {}\nrig = {}\nframes = {}\nrate_hz = {}\n",
                 TomlString(kVersion), TomlString(take.rig_name), take.truth.num_frames(),
                 TomlFloat(take.truth.rate_hz));
  fmt::format_to(out, "# x = (tx, ty, tz in mm, ax, ay, az in rad, s), R = Rz(az) Ry(ay) Rx(ax)\n");
  fmt::format_to(out, "rig_from_head = [");
  const auto x = take.rig_from_head.ToParameters();
  for (std::size_t i = 0; i < x.size(); ++i)
    fmt::format_to(out, "{}{}", i == 0 ? "" : ", ", TomlFloat(x[i]));
  text += "]\n\n[identity]\n";
  for (const NamedValue& slider : take.identity)
    fmt::format_to(out, "{} = {}\n", TomlString(slider.name), TomlFloat(slider.value));
  text += WriteOptions("options", take.options);
  text += WriteOptions("noise", EchoOptions(noise));
  for (const NamedOptions& more : further) text += WriteOptions(more.table, more.options);
  text += "\n[faults]\n";
  for (const SampleFault fault :
       {SampleFault::kDropout, SampleFault::kGap, SampleFault::kOutlier, SampleFault::kSwap})
    fmt::format_to(out, "{} = {}\n", NameOfFault(fault), recorded.Count(fault));
  text +=
      "\n# Where the markers are glued: q = v1 + s (v2 - v1) + t (v3 - v1) + u e1, on the rig\n"
      "# with the identity above.\n";
  for (const VirtualMarker& marker : take.true_attachments)
    fmt::format_to(
        out, "[[attachment]]\nname = {}\ntriangle = [{}, {}, {}]\ns = {}\nt = {}\nu_mm = {}\n",
        TomlString(marker.name), marker.triangle[0], marker.triangle[1], marker.triangle[2],
        TomlFloat(marker.s), TomlFloat(marker.t), TomlFloat(marker.u_mm));
  return text;
}

std::string WriteFaultsCsv(const DisturbedRecording& recorded) {
  std::string text = "frame,marker,fault\n";
  const StageTracks& tracks = recorded.markers.tracks;
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      const SampleFault fault = recorded.fault(frame, marker);
      if (fault == SampleFault::kOutlier || fault == SampleFault::kSwap)
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", tracks.first_frame() + frame,
                       tracks.names()[marker], NameOfFault(fault));
    }
  return text;
}

}  // namespace

std::vector<OutputFile> FilesOf(const SyntheticTake& take, const DisturbedRecording& recorded,
                                const SyntheticNoiseOptions& noise,
                                const std::vector<NamedOptions>& further) {
  return {{"take.c3d", FormatMarkers(recorded.markers, MarkerFormat::kC3d)},
          {"markers.toml", WriteMarkerSet(take.marker_set)},
          {"labels.TextGrid", WriteTextGrid(take.labels)},
          {"truth.csv", WriteParameterCsv(take.truth)},
          {"truth.pose.csv", WriteHeadPoseCsv(take.true_pose)},
          {"truth.toml", WriteTruthToml(take, recorded, noise, further)},
          {"truth.faults.csv", WriteFaultsCsv(recorded)}};
}

}  // namespace articap
