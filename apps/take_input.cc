// SPDX-License-Identifier: MIT
#include "apps/take_input.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <system_error>
#include <vector>

#include "core/session.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

// Shown as the user named the folder; the files of a part lie in that of the whole.
std::string NameIn(const std::string& folder, const StoredTake& take, const TakeFile& file) {
  if (!take.info.part) return (fs::path(folder) / file.name).string();
  return (fs::path(folder) / ".." / take.info.part->of / file.name).lexically_normal().string();
}

Result<void> AddLabels(const std::string& folder, const StoredTake& take,
                       std::vector<TakeFile>& files, TakeInput& input) {
  const std::vector<TakeFile> labels = take.FilesOf(FileRole::kLabels);
  if (labels.empty()) return {};
  if (labels.size() > 1)
    return Fail(fmt::format("{}: the take has {} files of labels; choose one with --labels", folder,
                            labels.size()));
  input.labels = NameIn(folder, take, labels[0]);
  // In seconds before they are subtracted: the file's numbers may be anything.
  using Seconds = std::chrono::duration<double>;
  input.labels_shift_s = (Seconds(labels[0].offset) - Seconds(files[0].offset)).count();
  files.push_back(labels[0]);
  return {};
}

// A folder of a take that was copied out of its session has none to ask.
Result<void> AddSession(const std::string& folder, TakeInput& input) {
  const fs::path session_folder = (fs::path(folder) / ".." / "..").lexically_normal();
  std::error_code error;
  if (!fs::exists(session_folder / kSessionFileName, error)) return {};
  const Result<SessionInfo> session = ReadSessionInfo(session_folder);
  if (!session) return tl::unexpected(session.error());
  const fs::path own_map = session_folder / session->map;
  input.map = fs::is_regular_file(own_map, error) ? own_map.string() : session->map;
  if (!session->rig.empty()) input.rig_folder = (session_folder / session->rig).string();
  return {};
}

}  // namespace

Result<TakeInput> FindTakeInput(const std::string& markers, const std::string& labels) {
  if (!IsTakeFolder(markers)) return TakeInput{.markers = markers, .labels = labels};
  const Result<StoredTake> take = OpenTake(markers);
  if (!take) return tl::unexpected(take.error());
  std::vector<TakeFile> files = take->FilesOf(FileRole::kMarkers);
  if (files.size() != 1)
    return Fail(fmt::format("{}: the take has {} files of markers, where one is needed", markers,
                            files.size()));
  TakeInput input = {.markers = NameIn(markers, *take, files[0]), .labels = labels};
  if (const auto& part = take->info.part)
    input.span = TimeSpan{SessionTime(part->start - files[0].offset),
                          SessionTime(part->end - files[0].offset)};
  if (labels.empty())
    if (const auto added = AddLabels(markers, *take, files, input); !added)
      return tl::unexpected(added.error());
  for (const TakeFile& file : files)
    if (const auto fault = FaultOf(*take, file)) return Fail(*fault + "; put it back from a copy");
  if (const auto added = AddSession(markers, input); !added) return tl::unexpected(added.error());
  return input;
}

}  // namespace articap
