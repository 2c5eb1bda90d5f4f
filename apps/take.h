// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/binding.h"
#include "core/marker_io.h"
#include "core/marker_set.h"
#include "core/report.h"
#include "core/result.h"
#include "core/time.h"
#include "rig/face_rig.h"
#include "tracking/stabilize.h"

namespace articap {

// A marker file that the stages after reading work on.
struct Take {
  std::filesystem::path path;
  MarkerRecording recording;
  StageReport report;  // what reading had to say
};

// From a time to before another.
struct TimeSpan {
  SessionTime start;
  SessionTime end;
};

// Reads a take and refuses what cannot be a face, with the unit that its size looks like. `mirror`:
// the recording is mirrored back, see MirrorTracks(). `span`: only these frames of it.
Result<Take> ReadTake(const std::string& path, const MarkerReadOptions& options, bool mirror,
                      const std::optional<TimeSpan>& span = {});

// A marker map by name or path.
Result<MarkerSet> ReadMap(const std::string& name_or_path);

// What a binding is made from, with its hashes.
Result<std::vector<SourceHash>> SourcesOf(const std::string& reference_path, const std::string& map,
                                          const FaceRig& rig);

// Stabilize() with progress shown.
Result<StageResult<Stabilized>> StabilizeTake(const Take& take, const MarkerSet& set,
                                              const std::optional<HeadShape>& given_shape,
                                              const StabilizeOptions& options);

// Head-local tracks in a form that marker files hold, with what the source's file held besides.
MarkerRecording HeadLocalRecording(const HeadTracks& tracks, const MarkerRecording& source);

}  // namespace articap
