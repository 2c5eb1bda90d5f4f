// SPDX-License-Identifier: MIT
#include "core/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/check.h"
#include "core/natural_order.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 100;

bool IsLetterOrDigit(char c) {
  return ('0' <= c && c <= '9') || ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z');
}

Result<fs::path> ExistingFolder(const fs::path& folder, const std::string& what_it_lacks) {
  std::error_code error;
  fs::path canonical = fs::canonical(folder, error);
  if (!error && fs::is_directory(canonical, error)) return canonical;
  return Fail(fmt::format("{}: there is no such folder{}", folder.string(), what_it_lacks));
}

Result<std::vector<fs::path>> FoldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  if (!fs::exists(folder, error)) return folders;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->is_directory(error)) folders.push_back(entry->path());
  if (error)
    return Fail(fmt::format("{}: cannot be read ({}); check the folder's rights", folder.string(),
                            error.message()));
  std::sort(folders.begin(), folders.end());
  return folders;
}

}  // namespace

bool IsSafeName(std::string_view name) {
  if (name.empty() || name.size() > kLongestName) return false;
  if (!IsLetterOrDigit(name[0]) && name[0] != '_') return false;
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return IsLetterOrDigit(c) || c == '.' || c == '_' || c == '-'; });
}

std::string SafeNameOf(std::string_view name) {
  std::string safe;
  for (const char c : name) {
    const bool continues_character = (static_cast<unsigned char>(c) & 0xC0) == 0x80;
    if (continues_character) continue;
    safe += IsLetterOrDigit(c) || c == '.' || c == '-' ? c : '_';
  }
  if (!safe.empty() && (safe[0] == '.' || safe[0] == '-')) safe[0] = '_';
  safe.resize(std::min(safe.size(), kLongestName));
  return safe.find_first_not_of('_') == std::string::npos ? "take" : safe;
}

std::vector<TakeFile> StoredTake::FilesOf(FileRole role) const {
  std::vector<TakeFile> files;
  std::copy_if(info.files.begin(), info.files.end(), std::back_inserter(files),
               [&](const TakeFile& file) { return file.role == role; });
  return files;
}

std::vector<std::string> StoredTake::cameras() const {
  std::vector<std::string> cameras;
  for (const TakeFile& file : info.files)
    if (file.role == FileRole::kVideo && file.part == 1) cameras.push_back(file.camera);
  return cameras;
}

std::vector<TakeFile> StoredTake::VideoOf(std::string_view camera) const {
  std::vector<TakeFile> files = FilesOf(FileRole::kVideo);
  std::erase_if(files, [&](const TakeFile& file) { return file.camera != camera; });
  return files;
}

TakeFile StoredTake::WholeVideoOf(std::string_view camera) const {
  const std::vector<TakeFile> parts = VideoOf(camera);
  ARTICAP_CHECK(!parts.empty());
  TakeFile whole = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i) whole.frames += parts[i].frames;
  return whole;
}

double StoredTake::DurationOf_s(const TakeFile& file) const {
  if (!info.part) return file.duration_s();
  // As seconds, since a file's offset may be any number.
  using Seconds = std::chrono::duration<double>;
  const double begins_s = Seconds(file.offset).count() - Seconds(info.part->start).count();
  const double part_s = Seconds(info.part->end).count() - Seconds(info.part->start).count();
  return std::max(0.0, std::min(begins_s + file.duration_s(), part_s) - std::max(begins_s, 0.0));
}

bool IsTakeFolder(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / kTakeFileName, error);
}

Result<StoredTake> OpenTake(const fs::path& folder) {
  const Result<fs::path> absolute = ExistingFolder(folder, "; name the folder of a take");
  if (!absolute) return tl::unexpected(absolute.error());
  const fs::path source = folder / kTakeFileName;
  const Result<std::string> text = ReadFile(source);
  if (!text) return tl::unexpected(text.error());
  Result<TakeInfo> info = ParseTakeInfo(*text, source.string());
  if (!info) return tl::unexpected(info.error());
  if (info->id != absolute->filename())
    return Fail(
        fmt::format("{}: 'id' is \"{}\", but the folder is called \"{}\"; give the folder "
                    "its name back",
                    source.string(), info->id, absolute->filename().string()));
  return StoredTake{*std::move(info), *absolute};
}

std::optional<std::string> FaultOf(const StoredTake& take, const TakeFile& file) {
  const fs::path path = take.PathOf(file);
  const std::string where =
      fmt::format("takes/{}/{}", take.info.part ? take.info.part->of : take.info.id, file.name);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return where + " is missing";
  const auto size_bytes = static_cast<std::int64_t>(fs::file_size(path, error));
  if (!error && size_bytes != file.digest.size_bytes)
    return fmt::format("{} has {} bytes, and had {}", where, size_bytes, file.digest.size_bytes);
  const Result<FileDigest> digest = DigestOf(path);
  if (!digest) return digest.error().message;
  if (*digest == file.digest) return std::nullopt;
  return fmt::format("{} was altered: its hash is {}, and was {}", where, digest->xxh3,
                     file.digest.xxh3);
}

std::vector<std::string> VerifyTake(const StoredTake& take) {
  std::vector<std::string> faults;
  for (const TakeFile& file : take.info.files)
    if (auto fault = FaultOf(take, file)) faults.push_back(*std::move(fault));
  return faults;
}

Result<SessionInfo> ReadSessionInfo(const fs::path& session_folder) {
  const Result<fs::path> absolute =
      ExistingFolder(session_folder, "; 'articap session new' makes a session");
  if (!absolute) return tl::unexpected(absolute.error());
  const fs::path path = session_folder / kSessionFileName;
  std::error_code error;
  if (!fs::exists(path, error))
    return Fail(
        fmt::format("{}: is no session: it holds no session.toml; 'articap session new' "
                    "makes one",
                    session_folder.string()));
  const Result<std::string> text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseSessionInfo(*text, path.string());
}

const StoredTake* Recording::Find(std::string_view take_id) const {
  const auto take = std::find_if(takes_.begin(), takes_.end(), [&](const StoredTake& candidate) {
    return candidate.info.id == take_id;
  });
  return take == takes_.end() ? nullptr : &*take;
}

Result<Recording> OpenSession(const fs::path& folder) {
  Result<SessionInfo> info = ReadSessionInfo(folder);
  if (!info) return tl::unexpected(info.error());
  Recording recording;
  recording.folder_ = fs::canonical(folder);
  recording.info_ = *std::move(info);
  const auto take_folders = FoldersIn(recording.folder_ / kTakesFolderName);
  if (!take_folders) return tl::unexpected(take_folders.error());
  for (const fs::path& take_folder : *take_folders) {
    if (!IsTakeFolder(take_folder)) {
      recording.unfinished_.push_back(take_folder);
      continue;
    }
    Result<StoredTake> take = OpenTake(take_folder);
    if (!take) return tl::unexpected(take.error());
    recording.takes_.push_back(*std::move(take));
  }
  std::sort(recording.takes_.begin(), recording.takes_.end(),
            [](const StoredTake& first, const StoredTake& second) {
              return NaturallyBefore(first.info.id, second.info.id);
            });
  return recording;
}

}  // namespace articap
