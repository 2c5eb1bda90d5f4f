// SPDX-License-Identifier: MIT
#include "apps/take.h"

#include <fmt/format.h>

#include <utility>

#include "apps/progress.h"
#include "apps/resources.h"
#include "core/file_io.h"
#include "rig/io/rig_folder.h"

namespace articap {

Result<Take> ReadTake(const std::string& path, const MarkerReadOptions& options, bool mirror,
                      const std::optional<TimeSpan>& span) {
  Result<MarkerRecording> recording =
      WithProgress("reading " + path, [&] { return ReadMarkers(path, options); });
  if (!recording) return tl::unexpected(recording.error());
  if (const auto implausible = ImplausibleSize(*recording))
    return Fail(fmt::format("{}: {}", path, *implausible));
  if (span) *recording = CropToTimes(*recording, span->start, span->end);
  if (recording->tracks.num_frames() == 0)
    return Fail(fmt::format("{}: no frame of the markers lies in the part from {:.3f} to {:.3f} s",
                            path, span ? SecondsOf(span->start) : 0.0,
                            span ? SecondsOf(span->end) : 0.0));
  if (mirror) recording->tracks = MirrorTracks(recording->tracks);
  Take take{path, std::move(*recording), {}};
  const StageTracks& tracks = take.recording.tracks;
  take.report.stage = "read";
  take.report.verdict = fmt::format(
      "{}: {} frames of {} markers at {} Hz{}", take.path.filename().string(), tracks.num_frames(),
      tracks.num_markers(), tracks.rate_hz(), mirror ? ", mirrored back" : "");
  take.report.warnings = take.recording.warnings;
  return take;
}

Result<MarkerSet> ReadMap(const std::string& name_or_path) {
  const auto path = FindMap(name_or_path);
  if (!path) return tl::unexpected(path.error());
  return ReadMarkerSet(*path);
}

Result<std::vector<SourceHash>> SourcesOf(const std::string& reference_path, const std::string& map,
                                          const FaceRig& rig) {
  const auto map_path = FindMap(map);
  if (!map_path) return tl::unexpected(map_path.error());
  std::vector<SourceHash> sources;
  for (const auto& [role, path] :
       {std::pair<const char*, std::filesystem::path>{"reference", reference_path},
        {"map", *map_path}}) {
    const Result<std::string> bytes = ReadFile(path);
    if (!bytes) return tl::unexpected(bytes.error());
    sources.push_back({role, path.filename().string(), HashOf(*bytes)});
  }
  sources.push_back({"rig", rig.definition().name, HashOf(rig)});
  return sources;
}

Result<StageResult<Stabilized>> StabilizeTake(const Take& take, const MarkerSet& set,
                                              const std::optional<HeadShape>& given_shape,
                                              const StabilizeOptions& options) {
  auto result = WithProgress("stabilizing " + take.path.string(), [&] {
    return Stabilize(take.recording.tracks, set, given_shape, options);
  });
  if (!result) return Fail(fmt::format("{}: {}", take.path.string(), result.error().message));
  return result;
}

MarkerRecording HeadLocalRecording(const HeadTracks& tracks, const MarkerRecording& source) {
  MarkerRecording recording = source;
  recording.source_unit = "mm";
  recording.tracks = StageTracks(tracks.names(), tracks.num_frames(), tracks.rate_hz(),
                                 tracks.first_frame(), tracks.start());
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker)
      if (!tracks.is_missing(frame, marker))
        recording.tracks.Set(frame, marker, tracks.position_mm(frame, marker),
                             tracks.state(frame, marker), tracks.sigma_mm(frame, marker));
  return recording;
}

}  // namespace articap
