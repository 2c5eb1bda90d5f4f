// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/file_io.h"
#include "core/result.h"

namespace articap {

// A session on disk, as recordings/README.md defines it to the byte: SESSION/session.toml,
// SESSION/takes/<id>/take.toml with the raw files beside it, SESSION/derived/<id>/.

inline constexpr const char* kSessionFileName = "session.toml";
inline constexpr const char* kTakesFolderName = "takes";
inline constexpr const char* kTakeFileName = "take.toml";

// session.toml: what all takes share.
struct SessionInfo {
  std::string speaker;
  // The marker map: the name of one that comes with articap, or a file of the session
  // ("markers.toml"). Empty: not said.
  std::string map;
  std::string rig;    // a rig's folder in the session; empty: the default head
  std::string notes;  // free text
};

enum class FileRole : std::uint8_t {
  kMarkers,
  kAudio,  // WAV
  kLabels,
  kVideo,
  kOriginal,  // kept as it came, of which another file of the take was made: sound that is no WAV
};
const char* NameOf(FileRole role);  // "markers", "audio", "labels", "video", "original"

// A raw file of a take.
struct TakeFile {
  FileRole role = FileRole::kMarkers;
  std::string name;           // in the take's folder
  FileDigest digest;          // of the bytes that were recorded, or imported
  std::string original_name;  // before it was imported; any text
  // Where the file's own time 0 lies on the session clock.
  std::chrono::nanoseconds offset{0};
  double rate_hz = 0;       // of the frames; labels and originals have none
  int markers = 0;          // of markers
  int channels = 0;         // of audio
  std::int64_t frames = 0;  // of markers, audio and video, whose fields count as frames
  std::string made_from;    // of audio: the file of the take whose sound it is; empty: recorded so
  std::string camera;       // of video: a safe name
  int part = 1;             // of video: a camera's files are one video, in this order from 1
  int width = 0;            // of video: of the picture, upright, with square pixels, px
  int height = 0;

  double duration_s() const { return rate_hz > 0 ? static_cast<double>(frames) / rate_hz : 0; }
};

enum class TakeState : std::uint8_t { kComplete };

// The take that a part is cut from, and from when to when it goes on their common session clock.
struct TakePart {
  std::string of;  // the whole take's id
  std::chrono::nanoseconds start{0};
  std::chrono::nanoseconds end{0};  // later than the start; what happens then is no more of it

  bool operator==(const TakePart&) const = default;
};

// take.toml: what is in the folder of a take.
struct TakeInfo {
  std::string id;  // the folder's name
  TakeState state = TakeState::kComplete;
  // The instant, ns since 1970-01-01T00:00:00 UTC, at which the take's session clock is 0; nothing
  // where it is not known, as of imported files.
  std::optional<std::int64_t> clock_start_unix_ns;
  // Of a take that is part of another one. It has no files of its own: those that it names lie in
  // the folder of the whole, and are the same.
  std::optional<TakePart> part;
  std::vector<TakeFile> files;
};

// Parsing refuses, naming file and key, what it does not know, what contradicts itself, and names
// that lead out of the folder. write(read(write(x))) equals write(x) byte for byte.
Result<SessionInfo> ParseSessionInfo(const std::string& toml_text, const std::string& source_name);
Result<SessionInfo> ReadSessionInfo(const std::filesystem::path& session_folder);
std::string WriteSessionInfo(const SessionInfo& session);
Result<TakeInfo> ParseTakeInfo(const std::string& toml_text, const std::string& source_name);
std::string WriteTakeInfo(const TakeInfo& take);

// Names of takes and their files: letters and digits of ASCII, '.', '_' and '-', the first a
// letter, digit or '_', at most 100, so that they are the same on every system and never a path.
bool IsSafeName(std::string_view name);
// The same with '_' for every other character; "take" where nothing is left.
std::string SafeNameOf(std::string_view name);

// A take as it lies on disk.
struct StoredTake {
  TakeInfo info;
  std::filesystem::path folder;  // absolute

  // Where the files are: in this folder, or in that of the take of which this one is a part.
  std::filesystem::path files_folder() const {
    return info.part ? folder.parent_path() / info.part->of : folder;
  }
  std::filesystem::path PathOf(const TakeFile& file) const { return files_folder() / file.name; }
  std::vector<TakeFile> FilesOf(FileRole role) const;
  // The names of the cameras, in the order of their files.
  std::vector<std::string> cameras() const;
  // A camera's video, in the order of its parts, and as if it were one file: the first of them,
  // with the frames of all.
  std::vector<TakeFile> VideoOf(std::string_view camera) const;
  TakeFile WholeVideoOf(std::string_view camera) const;
  // Seconds of the file that belong to the take.
  double DurationOf_s(const TakeFile& file) const;
};

// Whether a folder holds a take.toml, and what it says. Refused where the id is not the folder's
// name.
bool IsTakeFolder(const std::filesystem::path& folder);
Result<StoredTake> OpenTake(const std::filesystem::path& folder);

// What is wrong with a file of a take: that it is missing, of another size, or altered; nothing
// where it is as it was.
std::optional<std::string> FaultOf(const StoredTake& take, const TakeFile& file);
// Of all its files, a sentence each.
std::vector<std::string> VerifyTake(const StoredTake& take);

// A session's folder, opened to be read; nothing in it is ever altered through this.
class Recording {
 public:
  const std::filesystem::path& folder() const { return folder_; }  // absolute
  const SessionInfo& info() const { return info_; }
  // By id, numbers in them by value: take2 before take10.
  const std::vector<StoredTake>& takes() const { return takes_; }
  const StoredTake* Find(std::string_view take_id) const;
  // Folders among the takes that hold no take.toml: imports that were cut short.
  const std::vector<std::filesystem::path>& unfinished() const { return unfinished_; }

 private:
  friend Result<Recording> OpenSession(const std::filesystem::path& folder);

  std::filesystem::path folder_;
  SessionInfo info_;
  std::vector<StoredTake> takes_;
  std::vector<std::filesystem::path> unfinished_;
};

Result<Recording> OpenSession(const std::filesystem::path& folder);

}  // namespace articap
