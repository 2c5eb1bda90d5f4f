// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <set>
#include <utility>

#include "core/session.h"
#include "core/toml_reader.h"

namespace articap {
namespace {

constexpr int kFormatVersion = 1;
constexpr const char* kComplete = "complete";
constexpr std::array<FileRole, 5> kRoles = {FileRole::kMarkers, FileRole::kAudio, FileRole::kLabels,
                                            FileRole::kVideo, FileRole::kOriginal};

constexpr char kSessionHead[] =
    R"(# An articap session: what its takes share. recordings/README.md defines the format.
)";
constexpr char kTakeHead[] =
    R"(# A take of an articap session: its raw files, which are never altered. offset_ns is where a file's
# own time 0 lies on the take's session clock. recordings/README.md defines the format.
)";

// Before anything else is judged: another version may have other keys.
void CheckVersion(const TomlReader& document) {
  const int version = document.Integer("format");
  if (version != kFormatVersion)
    document.Fault("format", fmt::format("is {}, and this articap reads format {}; use the version "
                                         "of articap that wrote it, or a newer one",
                                         version, kFormatVersion));
}

bool IsPathInside(std::string_view path) {
  while (true) {
    const std::size_t slash = path.find('/');
    if (!IsSafeName(path.substr(0, slash))) return false;
    if (slash == std::string_view::npos) return true;
    path.remove_prefix(slash + 1);
  }
}

std::string ReadPathInside(const TomlReader& table, std::string_view key) {
  std::string path = table.Text(key, "");
  if (table.Has(key) && !IsPathInside(path))
    table.Fault(key, fmt::format("is \"{}\", which is no path inside the session: safe names "
                                 "(A-Z a-z 0-9 . _ -) with '/' between them",
                                 path));
  return path;
}

std::string ReadSafeName(const TomlReader& table, std::string_view key) {
  std::string name = table.Text(key);
  if (!IsSafeName(name))
    table.Fault(key, fmt::format("is \"{}\", which is no safe name: letters, digits, '.', '_' and "
                                 "'-' of ASCII, the first no '.' or '-', no path",
                                 name));
  return name;
}

FileRole ReadRole(const TomlReader& table) {
  const std::string name = table.Text("role");
  for (const FileRole role : kRoles)
    if (name == NameOf(role)) return role;
  table.Fault("role",
              fmt::format("is \"{}\"; the roles are \"markers\", \"audio\", \"labels\", \"video\" "
                          "and \"original\"",
                          name));
  return FileRole::kLabels;
}

std::string ReadHash(const TomlReader& table) {
  constexpr std::size_t kHexDigits = 16;
  std::string hash = table.Text("xxh3");
  if (hash.size() != kHexDigits || hash.find_first_not_of("0123456789abcdef") != std::string::npos)
    table.Fault("xxh3",
                fmt::format("is \"{}\", where 16 hex digits in small letters belong", hash));
  return hash;
}

std::int64_t ReadAtLeast(const TomlReader& table, std::string_view key, std::int64_t least) {
  const std::int64_t value = table.Integer64(key);
  if (value < least) table.Fault(key, fmt::format("is {}, and not at least {}", value, least));
  return value;
}

int ReadCount(const TomlReader& table, std::string_view key) {
  const int count = table.Integer(key);
  if (count < 1) table.Fault(key, fmt::format("is {}, and not at least 1", count));
  return count;
}

// What is said of the frames of markers, audio and video.
void ReadFrames(const TomlReader& table, TakeFile& file) {
  file.rate_hz = table.Number("rate_hz");
  if (!(file.rate_hz > 0)) table.Fault("rate_hz", "is not above 0");
  file.frames = ReadAtLeast(table, "frames", 0);
}

void AllowKeysOf(FileRole role, const TomlReader& table) {
  switch (role) {
    case FileRole::kMarkers:
      return table.AllowOnly({"role", "name", "xxh3", "size_bytes", "original_name", "offset_ns",
                              "rate_hz", "markers", "frames"});
    case FileRole::kAudio:
      return table.AllowOnly({"role", "name", "xxh3", "size_bytes", "original_name", "offset_ns",
                              "rate_hz", "channels", "frames", "made_from"});
    case FileRole::kVideo:
      return table.AllowOnly({"role", "name", "xxh3", "size_bytes", "original_name", "offset_ns",
                              "rate_hz", "camera", "part", "width", "height", "frames"});
    case FileRole::kLabels:
    case FileRole::kOriginal:
      return table.AllowOnly({"role", "name", "xxh3", "size_bytes", "original_name", "offset_ns"});
  }
}

bool HasFrames(FileRole role) {
  return role == FileRole::kMarkers || role == FileRole::kAudio || role == FileRole::kVideo;
}

TakeFile ReadFileTable(const TomlReader& table) {
  TakeFile file;
  file.role = ReadRole(table);
  AllowKeysOf(file.role, table);
  file.name = ReadSafeName(table, "name");
  file.digest.xxh3 = ReadHash(table);
  file.digest.size_bytes = ReadAtLeast(table, "size_bytes", 0);
  file.original_name = table.Text("original_name");
  file.offset = std::chrono::nanoseconds(table.Integer64("offset_ns"));
  if (HasFrames(file.role)) ReadFrames(table, file);
  if (file.role == FileRole::kMarkers) file.markers = ReadCount(table, "markers");
  if (file.role == FileRole::kAudio) {
    file.channels = ReadCount(table, "channels");
    if (table.Has("made_from")) file.made_from = ReadSafeName(table, "made_from");
  }
  if (file.role == FileRole::kVideo) {
    file.camera = ReadSafeName(table, "camera");
    file.part = ReadCount(table, "part");
    file.width = ReadCount(table, "width");
    file.height = ReadCount(table, "height");
  }
  return file;
}

// That a camera's parts are there one after the other, and what a sound was made from too.
void CheckFile(const TomlReader& table, const TakeFile& file,
               const std::vector<TakeFile>& files_before) {
  int parts_before = 0;
  bool has_source = file.made_from.empty();
  for (const TakeFile& before : files_before) {
    parts_before += before.role == FileRole::kVideo && before.camera == file.camera;
    has_source =
        has_source || (before.name == file.made_from &&
                       (before.role == FileRole::kVideo || before.role == FileRole::kOriginal));
  }
  if (file.role == FileRole::kVideo && file.part != parts_before + 1)
    table.Fault("part", fmt::format("is {}, where part {} of the camera {} should be", file.part,
                                    parts_before + 1, file.camera));
  if (!has_source)
    table.Fault("made_from",
                fmt::format("is \"{}\", which is no video or original before it", file.made_from));
}

std::vector<TakeFile> ReadFiles(const TomlReader& document) {
  std::vector<TakeFile> files;
  std::set<std::string> names = {kTakeFileName};
  for (const TomlReader& table : document.Tables("file")) {
    TakeFile file = ReadFileTable(table);
    CheckFile(table, file, files);
    files.push_back(std::move(file));
    if (!names.insert(files.back().name).second)
      table.Fault("name", fmt::format("is \"{}\", as another file is called", files.back().name));
  }
  return files;
}

std::string OptionalLine(const std::string& key, const std::string& value) {
  return value.empty() ? "" : fmt::format("{} = {}\n", key, QuotedToml(value));
}

std::string FileTable(const TakeFile& file) {
  std::string text = fmt::format(
      "\n[[file]]\nrole = \"{}\"\nname = {}\nxxh3 = {}\nsize_bytes = {}\noriginal_name = {}\n"
      "offset_ns = {}\n",
      NameOf(file.role), QuotedToml(file.name), QuotedToml(file.digest.xxh3),
      file.digest.size_bytes, QuotedToml(file.original_name), file.offset.count());
  if (!HasFrames(file.role)) return text;
  text += fmt::format("rate_hz = {}\n", TomlFloat(file.rate_hz));
  if (file.role == FileRole::kMarkers) text += fmt::format("markers = {}\n", file.markers);
  if (file.role == FileRole::kAudio) text += fmt::format("channels = {}\n", file.channels);
  if (file.role == FileRole::kVideo)
    text += fmt::format("camera = {}\npart = {}\nwidth = {}\nheight = {}\n",
                        QuotedToml(file.camera), file.part, file.width, file.height);
  return text + fmt::format("frames = {}\n", file.frames) +
         OptionalLine("made_from", file.made_from);
}

// Nothing where the take is whole.
std::optional<TakePart> ReadPart(const TomlReader& document, const std::string& take_id) {
  if (!document.Has("part_of")) {
    for (const char* key : {"start_ns", "end_ns"})
      if (document.Has(key)) document.Fault(key, "is said of a take without 'part_of'");
    return std::nullopt;
  }
  TakePart part;
  part.of = ReadSafeName(document, "part_of");
  part.start = std::chrono::nanoseconds(document.Integer64("start_ns"));
  part.end = std::chrono::nanoseconds(document.Integer64("end_ns"));
  if (part.of == take_id) document.Fault("part_of", "is the take itself");
  if (part.end <= part.start)
    document.Fault("end_ns", fmt::format("is {}, which is not later than 'start_ns', {}",
                                         part.end.count(), part.start.count()));
  return part;
}

}  // namespace

const char* NameOf(FileRole role) {
  switch (role) {
    case FileRole::kMarkers:
      return "markers";
    case FileRole::kAudio:
      return "audio";
    case FileRole::kLabels:
      return "labels";
    case FileRole::kVideo:
      return "video";
    case FileRole::kOriginal:
      break;
  }
  return "original";
}

std::string WriteSessionInfo(const SessionInfo& session) {
  return kSessionHead +
         fmt::format("format = {}\nspeaker = {}\n", kFormatVersion, QuotedToml(session.speaker)) +
         OptionalLine("map", session.map) + OptionalLine("rig", session.rig) +
         OptionalLine("notes", session.notes);
}

Result<SessionInfo> ParseSessionInfo(const std::string& toml_text, const std::string& source_name) {
  const auto document = ParseToml(toml_text, source_name);
  if (!document) return tl::unexpected(document.error());
  std::optional<Error> fault;
  const TomlReader reader(*document, source_name, fault);
  CheckVersion(reader);
  reader.AllowOnly({"format", "speaker", "map", "rig", "notes"});
  SessionInfo session;
  session.speaker = reader.Text("speaker");
  if (session.speaker.empty()) reader.Fault("speaker", "is empty; name who speaks");
  session.map = ReadPathInside(reader, "map");
  session.rig = ReadPathInside(reader, "rig");
  session.notes = reader.Text("notes", "");
  if (fault) return tl::unexpected(*fault);
  return session;
}

std::string WriteTakeInfo(const TakeInfo& take) {
  std::string text = kTakeHead + fmt::format("format = {}\nid = {}\nstate = \"{}\"\n",
                                             kFormatVersion, QuotedToml(take.id), kComplete);
  if (take.clock_start_unix_ns)
    text += fmt::format("clock_start_unix_ns = {}\n", *take.clock_start_unix_ns);
  if (take.part)
    text += fmt::format("part_of = {}\nstart_ns = {}\nend_ns = {}\n", QuotedToml(take.part->of),
                        take.part->start.count(), take.part->end.count());
  for (const TakeFile& file : take.files) text += FileTable(file);
  return text;
}

Result<TakeInfo> ParseTakeInfo(const std::string& toml_text, const std::string& source_name) {
  const auto document = ParseToml(toml_text, source_name);
  if (!document) return tl::unexpected(document.error());
  std::optional<Error> fault;
  const TomlReader reader(*document, source_name, fault);
  CheckVersion(reader);
  reader.AllowOnly(
      {"format", "id", "state", "clock_start_unix_ns", "part_of", "start_ns", "end_ns", "file"});
  TakeInfo take;
  take.id = ReadSafeName(reader, "id");
  if (const std::string state = reader.Text("state"); state != kComplete)
    reader.Fault("state",
                 fmt::format("is \"{}\"; the only state there is, is \"complete\"", state));
  if (reader.Has("clock_start_unix_ns"))
    take.clock_start_unix_ns = reader.Integer64("clock_start_unix_ns");
  take.part = ReadPart(reader, take.id);
  take.files = ReadFiles(reader);
  if (fault) return tl::unexpected(*fault);
  return take;
}

}  // namespace articap
