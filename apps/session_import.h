// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/marker_io.h"
#include "core/report.h"
#include "core/result.h"
#include "core/session.h"

namespace articap {

struct ImportOptions {
  std::string
      id;  // of the take; empty: the stem of the markers, else of the audio, else of a label
  // Where the audio's first sample lies on the session clock, whose 0 is that of the markers' own
  // times. Labels are made on audio: they move with it.
  std::chrono::nanoseconds audio_offset{0};
  MarkerReadOptions read;
};

// A file that was looked into and is to become one of a take.
struct ImportFile {
  std::filesystem::path path;
  TakeFile info;  // its digest is known once it is copied
};

struct Import {
  std::string id;  // wished for; a retake gets the next version
  std::vector<ImportFile> files;
  std::vector<std::string> warnings;
};

// Reads each file, so that nothing becomes part of a session that cannot be read again.
Result<Import> PrepareImport(const std::vector<std::string>& paths, const ImportOptions& options);

// Copies the files into a folder of their own below the session's takes, take.toml last. Never in
// the place of another take: its next version is `id`_v2, `id`_v3, ... Leaves nothing on failure.
Result<StoredTake> StoreTake(const std::filesystem::path& session_folder, const Import& import);

}  // namespace articap
