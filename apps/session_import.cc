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
#include "apps/take_folder.h"
#include "capture/audio.h"
#include "capture/media_kind.h"
#include "capture/video.h"
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
  if (MarkerFormatOf(path)) return FileRole::kMarkers;
  switch (MediaKindOf(path)) {
    case MediaKind::kVideo:
      return FileRole::kVideo;
    case MediaKind::kAudio:
      return FileRole::kOriginal;
    default:
      return FileRole::kMarkers;
  }
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

Result<ImportFile> FileAt(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    return Fail(fmt::format(
        "{}: is no file; name a file of markers, a video, a sound or a TextGrid", path.string()));
  const std::string name = path.filename().string();
  if (!IsUtf8(name))
    return Fail(fmt::format("{}: its name is not UTF-8; rename it", path.string()));
  ImportFile file;
  file.path = path;
  file.info.name = SafeNameOf(name);
  file.info.original_name = name;
  return file;
}

// All of a camera's files, and its sound.
Result<void> AddCamera(const CameraFiles& camera, Import& import) {
  std::vector<ImportFile> files;
  for (const fs::path& path : camera.parts) {
    Result<ImportFile> file = FileAt(path);
    if (!file) return tl::unexpected(file.error());
    files.push_back(*std::move(file));
  }
  const auto source =
      WithProgress("reading " + camera.parts[0].string(), [&] { return OpenVideo(camera.parts); });
  if (!source) return tl::unexpected(source.error());
  const FrameSourceInfo& video = (*source)->info();
  const int fields = video.interlaced ? 2 : 1;
  ImportSound sound = {{}, SafeNameOf(camera.parts[0].stem().string()) + ".wav"};
  for (ImportFile& file : files) {
    const auto pictures = CountPictures(file.path, video.rate_hz / fields);
    if (!pictures) return tl::unexpected(pictures.error());
    file.info.role = FileRole::kVideo;
    file.info.rate_hz = video.rate_hz;
    file.info.frames = fields * *pictures;
    file.info.camera = camera.camera;
    file.info.part = static_cast<int>(sound.of.size()) + 1;
    file.info.width = video.width;
    file.info.height = video.height;
    sound.of.push_back(import.files.size());
    import.files.push_back(std::move(file));
  }
  for (const std::string& note : video.notes)
    import.notes.push_back(fmt::format("{}: {}", camera.parts[0].filename().string(), note));
  if (HasAudio(camera.parts[0])) import.sounds.push_back(std::move(sound));
  return {};
}

Result<void> AddFile(const fs::path& path, const ImportOptions& options, Import& import) {
  Result<ImportFile> file = FileAt(path);
  if (!file) return tl::unexpected(file.error());
  file->info.role = RoleOf(path);
  Result<void> looked;
  switch (file->info.role) {
    case FileRole::kVideo:
      return AddCamera({SafeNameOf(path.stem().string()), {path}}, import);
    case FileRole::kMarkers:
      looked = LookIntoMarkers(*file, options.read, import.warnings);
      break;
    case FileRole::kAudio:
      looked = LookIntoAudio(*file, import.warnings);
      break;
    case FileRole::kLabels:
      looked = LookIntoLabels(*file, import.warnings);
      break;
    case FileRole::kOriginal:
      import.sounds.push_back({{import.files.size()}, SafeNameOf(path.stem().string()) + ".wav"});
      break;
  }
  if (!looked) return tl::unexpected(looked.error());
  import.files.push_back(*std::move(file));
  return {};
}

// "sound.wav", "sound_2.wav", ...
void MakeNamesUnique(Import& import) {
  std::set<std::string> taken = {kTakeFileName};
  const auto make_unique = [&](std::string& name) {
    const fs::path first = name;
    for (int number = 2; !taken.insert(ToLower(name)).second; ++number)
      name = fmt::format("{}_{}{}", first.stem().string(), number, first.extension().string());
  };
  for (ImportFile& file : import.files) make_unique(file.info.name);
  for (ImportSound& sound : import.sounds) make_unique(sound.name);
}

// Two videos of one name are two cameras all the same.
Result<void> CheckCameras(const std::vector<ImportFile>& files) {
  std::set<std::string> cameras;
  for (const ImportFile& file : files)
    if (file.info.role == FileRole::kVideo && file.info.part == 1 &&
        !cameras.insert(file.info.camera).second)
      return Fail(
          fmt::format("two videos are of the camera {}; name each with --camera NAME=FILE, "
                      "or the parts of one with --camera NAME=FILE,FILE",
                      file.info.camera));
  return {};
}

const ImportFile* FirstOf(const std::vector<ImportFile>& files, FileRole role) {
  const auto file = std::find_if(files.begin(), files.end(), [&](const ImportFile& candidate) {
    return candidate.info.role == role;
  });
  return file == files.end() ? nullptr : &*file;
}

std::string IdOf(const std::vector<ImportFile>& files) {
  for (const FileRole role : {FileRole::kMarkers, FileRole::kAudio, FileRole::kOriginal,
                              FileRole::kVideo, FileRole::kLabels})
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
  const bool has_audio = FirstOf(files, FileRole::kAudio) || FirstOf(files, FileRole::kOriginal);
  if (options.audio_offset.count() != 0 && !has_audio)
    return Fail(
        "--audio-offset-s says where the audio begins, and there is none; add the WAV file");
  if (options.video_offset.count() != 0 && !FirstOf(files, FileRole::kVideo))
    return Fail("--video-offset-s says where the videos begin, and there is none; add the video");
  return CheckCameras(files);
}

void PlaceInTime(const ImportOptions& options, std::vector<ImportFile>& files) {
  const bool has_audio = FirstOf(files, FileRole::kAudio) || FirstOf(files, FileRole::kOriginal);
  for (ImportFile& file : files) {
    const FileRole role = file.info.role;
    if (role == FileRole::kAudio || role == FileRole::kOriginal ||
        (role == FileRole::kLabels && has_audio))
      file.info.offset = options.audio_offset;
    if (role == FileRole::kVideo || (role == FileRole::kLabels && !has_audio))
      file.info.offset = options.video_offset;
  }
}

// Of files that are in the folder already.
Result<TakeFile> MakeSound(const ImportSound& sound, const fs::path& folder, const TakeInfo& take,
                           std::vector<std::string>& notes) {
  std::vector<fs::path> parts;
  for (const std::size_t file : sound.of) parts.push_back(folder / take.files[file].name);
  const TakeFile& source = take.files[sound.of[0]];
  const auto audio = WithProgress("making the sound of " + source.original_name,
                                  [&] { return ExtractAudio(parts, folder / sound.name); });
  if (!audio) return tl::unexpected(audio.error());
  const Result<FileDigest> digest = DigestOf(folder / sound.name);
  if (!digest) return tl::unexpected(digest.error());
  for (const std::string& note : audio->notes)
    notes.push_back(fmt::format("{}: {}", sound.name, note));
  TakeFile file;
  file.role = FileRole::kAudio;
  file.name = file.original_name = sound.name;
  file.digest = *digest;
  file.offset = source.offset + audio->offset;
  file.rate_hz = static_cast<double>(audio->format.rate_hz);
  file.channels = audio->format.channels;
  file.frames = audio->frames;
  file.made_from = source.name;
  return file;
}

}  // namespace

Result<Import> PrepareImport(const std::vector<std::string>& paths, const ImportOptions& options) {
  Import import;
  for (const std::string& path : paths)
    if (const auto added = AddFile(path, options, import); !added)
      return tl::unexpected(added.error());
  for (const CameraFiles& camera : options.cameras)
    if (const auto added = AddCamera(camera, import); !added) return tl::unexpected(added.error());
  if (const auto together = CheckTogether(import.files, options); !together)
    return tl::unexpected(together.error());
  PlaceInTime(options, import.files);
  MakeNamesUnique(import);
  import.id = options.id.empty() ? IdOf(import.files).substr(0, kLongestTakeId) : options.id;
  if (!IsSafeName(import.id) || import.id.size() > kLongestTakeId)
    return Fail(
        fmt::format("--id {}: is no name for a take: letters, digits, '.', '_' and '-' of "
                    "ASCII, the first no '.' or '-', at most {}",
                    import.id, kLongestTakeId));
  return import;
}

Result<ImportedTake> StoreTake(const fs::path& session_folder, const Import& import) {
  Result<TakeFolder> made = MakeTakeFolder(session_folder / kTakesFolderName, import.id);
  if (!made) return tl::unexpected(made.error());
  TakeFolder& folder = *made;
  ImportedTake imported;
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
  for (const ImportSound& sound : import.sounds) {
    Result<TakeFile> file = MakeSound(sound, folder.path(), take, imported.notes);
    if (!file) return tl::unexpected(file.error());
    take.files.push_back(*std::move(file));
  }
  const auto written = WriteFile(folder.path() / kTakeFileName, WriteTakeInfo(take));
  if (!written) return tl::unexpected(written.error());
  folder.Keep();
  Result<StoredTake> stored = OpenTake(folder.path());
  if (!stored) return tl::unexpected(stored.error());
  imported.take = *std::move(stored);
  return imported;
}

}  // namespace articap
