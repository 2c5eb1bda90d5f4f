// SPDX-License-Identifier: MIT
#include "apps/session_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/progress.h"
#include "core/file_io.h"
#include "core/io/text.h"
#include "core/text_grid.h"
#include "core/wav_header.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

std::string FirstBytes(const fs::path& path) {
  std::array<char, 64> bytes{};
  std::ifstream stream(path, std::ios::binary);
  stream.read(bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(stream.gcount())};
}

// By content, then by name.
FileRole RoleOf(const fs::path& path) {
  const std::string start = FirstBytes(path);
  const std::string ending = ToLower(path.extension().string());
  if (LooksLikeWav(start) || ending == ".wav") return FileRole::kAudio;
  if (start.find("ooTextFile") != std::string::npos || ending == ".textgrid")
    return FileRole::kLabels;
  return FileRole::kMarkers;
}

void Append(std::vector<std::string>& warnings, const std::vector<std::string>& more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

Result<void> LookIntoMarkers(ImportFile& file, const MarkerReadOptions& options,
                             std::vector<std::string>& warnings) {
  const Result<MarkerRecording> recording = WithProgress(
      "reading " + file.path.string(), [&] { return ReadMarkers(file.path, options); });
  if (!recording) return tl::unexpected(recording.error());
  file.info.rate_hz = recording->tracks.rate_hz();
  file.info.markers = recording->tracks.num_markers();
  file.info.frames = recording->tracks.num_frames();
  Append(warnings, recording->warnings);
  return {};
}

Result<void> LookIntoAudio(ImportFile& file, std::vector<std::string>& warnings) {
  const Result<WavHeader> header = ReadWavHeader(file.path);
  if (!header) return tl::unexpected(header.error());
  file.info.rate_hz = static_cast<double>(header->rate_hz);
  file.info.channels = header->channels;
  file.info.frames = header->frames;
  Append(warnings, header->warnings);
  return {};
}

Result<void> LookIntoLabels(const ImportFile& file, std::vector<std::string>& warnings) {
  const Result<TextGrid> labels = ReadTextGrid(file.path);
  if (!labels) return tl::unexpected(labels.error());
  Append(warnings, labels->warnings);
  return {};
}

Result<ImportFile> LookInto(const fs::path& path, const ImportOptions& options,
                            std::vector<std::string>& warnings) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    return Fail(
        fmt::format("{}: is no file; name a file of markers, a WAV or a TextGrid", path.string()));
  const std::string name = path.filename().string();
  if (!IsUtf8(name))
    return Fail(fmt::format("{}: its name is not UTF-8; rename it", path.string()));
  ImportFile file;
  file.path = path;
  file.info.role = RoleOf(path);
  file.info.name = SafeNameOf(name);
  file.info.original_name = name;
  Result<void> looked;
  if (file.info.role == FileRole::kMarkers)
    looked = LookIntoMarkers(file, options.read, warnings);
  else if (file.info.role == FileRole::kAudio)
    looked = LookIntoAudio(file, warnings);
  else
    looked = LookIntoLabels(file, warnings);
  if (!looked) return tl::unexpected(looked.error());
  if (file.info.role != FileRole::kMarkers) file.info.offset = options.audio_offset;
  return file;
}

// "sound.wav", "sound_2.wav", ...
void MakeNamesUnique(std::vector<ImportFile>& files) {
  std::set<std::string> taken = {kTakeFileName};
  for (ImportFile& file : files) {
    const fs::path first = file.info.name;
    for (int number = 2; !taken.insert(ToLower(file.info.name)).second; ++number)
      file.info.name =
          fmt::format("{}_{}{}", first.stem().string(), number, first.extension().string());
  }
}

const ImportFile* FirstOf(const std::vector<ImportFile>& files, FileRole role) {
  const auto file = std::find_if(files.begin(), files.end(), [&](const ImportFile& candidate) {
    return candidate.info.role == role;
  });
  return file == files.end() ? nullptr : &*file;
}

std::string IdOf(const std::vector<ImportFile>& files) {
  for (const FileRole role : {FileRole::kMarkers, FileRole::kAudio, FileRole::kLabels})
    if (const ImportFile* file = FirstOf(files, role))
      return SafeNameOf(file->path.stem().string());
  return {};
}

Result<void> CheckTogether(const std::vector<ImportFile>& files, const ImportOptions& options) {
  const auto is_markers = [](const ImportFile& file) {
    return file.info.role == FileRole::kMarkers;
  };
  if (std::count_if(files.begin(), files.end(), is_markers) > 1)
    return Fail("more than one file of markers; a take has one, import them one after the other");
  if (options.audio_offset.count() != 0 && !FirstOf(files, FileRole::kAudio))
    return Fail(
        "--audio-offset-s says where the audio begins, and there is none; add the WAV file");
  return {};
}

// The folder of a take while it is filled; taken away again unless it was kept.
class TakeFolder {
 public:
  explicit TakeFolder(fs::path path) : path_(std::move(path)) {}
  ~TakeFolder() {
    std::error_code ignored;
    if (!kept_) fs::remove_all(path_, ignored);
  }
  TakeFolder(const TakeFolder&) = delete;
  TakeFolder& operator=(const TakeFolder&) = delete;
  const fs::path& path() const { return path_; }
  void Keep() { kept_ = true; }

 private:
  fs::path path_;
  bool kept_ = false;
};

// Makes the folder takes/<id>, or that of the next version; making it is what reserves the id.
Result<fs::path> MakeTakeFolder(const fs::path& takes, const std::string& id) {
  std::error_code error;
  fs::create_directories(takes, error);
  for (int version = 1; !error; ++version) {
    const fs::path folder = takes / (version == 1 ? id : fmt::format("{}_v{}", id, version));
    if (fs::create_directory(folder, error)) return folder;
    if (error == std::errc::file_exists) error.clear();
  }
  return Fail(fmt::format("{}: no folder for a take can be made ({}); check the session's rights",
                          takes.string(), error.message()));
}

}  // namespace

Result<Import> PrepareImport(const std::vector<std::string>& paths, const ImportOptions& options) {
  // Room for "_v1000", so that the next version's name is safe too.
  constexpr std::size_t kLongestId = 90;
  Import import;
  for (const std::string& path : paths) {
    Result<ImportFile> file = LookInto(path, options, import.warnings);
    if (!file) return tl::unexpected(file.error());
    import.files.push_back(*std::move(file));
  }
  if (const auto together = CheckTogether(import.files, options); !together)
    return tl::unexpected(together.error());
  MakeNamesUnique(import.files);
  import.id = options.id.empty() ? IdOf(import.files).substr(0, kLongestId) : options.id;
  if (!IsSafeName(import.id) || import.id.size() > kLongestId)
    return Fail(
        fmt::format("--id {}: is no name for a take: letters, digits, '.', '_' and '-' of "
                    "ASCII, the first no '.' or '-', at most {}",
                    import.id, kLongestId));
  return import;
}

Result<StoredTake> StoreTake(const fs::path& session_folder, const Import& import) {
  const auto made = MakeTakeFolder(session_folder / kTakesFolderName, import.id);
  if (!made) return tl::unexpected(made.error());
  TakeFolder folder(*made);
  TakeInfo take;
  take.id = folder.path().filename().string();
  for (const ImportFile& file : import.files) {
    const Result<FileDigest> digest = WithProgress("copying " + file.path.string(), [&] {
      return CopyFile(file.path, folder.path() / file.info.name);
    });
    if (!digest) return tl::unexpected(digest.error());
    take.files.push_back(file.info);
    take.files.back().digest = *digest;
  }
  const auto written = WriteFile(folder.path() / kTakeFileName, WriteTakeInfo(take));
  if (!written) return tl::unexpected(written.error());
  folder.Keep();
  return OpenTake(folder.path());
}

}  // namespace articap
