// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/marker_io.h"
#include "core/report.h"
#include "core/result.h"
#include "core/session.h"

namespace articap {

// The files of one camera, in their order.
struct CameraFiles {
  std::string camera;  // a safe name
  std::vector<std::filesystem::path> parts;
};

struct ImportOptions {
  // Of the take; empty: the stem of the markers, else of the audio, the video or the labels.
  std::string id;
  // Videos besides those among the paths, each of which is a camera named by its stem.
  std::vector<CameraFiles> cameras;
  // Where the audio's first sample, and the videos' first pictures, lie on the session clock, whose
  // 0 is that of the markers' own times. Labels are made on audio: they move with it, or with the
  // videos where no audio is imported.
  std::chrono::nanoseconds audio_offset{0};
  std::chrono::nanoseconds video_offset{0};
  MarkerReadOptions read;
};

// A file that was looked into and is to become one of a take.
struct ImportFile {
  std::filesystem::path path;
  TakeFile info;  // its digest is known once it is copied
};

// A WAV file to be made: the sound of files of the import, which follow one another.
struct ImportSound {
  std::vector<std::size_t> of;  // indices of the files
  std::string name;
};

struct Import {
  std::string id;  // wished for; a retake gets the next version
  std::vector<ImportFile> files;
  std::vector<ImportSound> sounds;
  std::vector<std::string> notes;  // what was found out of the videos, sentences
  std::vector<std::string> warnings;
};

// Reads each file, so that nothing becomes part of a session that cannot be read again.
Result<Import> PrepareImport(const std::vector<std::string>& paths, const ImportOptions& options);

struct ImportedTake {
  StoredTake take;
  std::vector<std::string> notes;  // on the sounds that were made
};

// Copies the files into a folder of their own below the session's takes, makes the sounds beside
// them, take.toml last. Never in the place of another take: its next version is `id`_v2, `id`_v3,
// ... Leaves nothing on failure.
Result<ImportedTake> StoreTake(const std::filesystem::path& session_folder, const Import& import);

}  // namespace articap
