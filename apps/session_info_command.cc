// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include "apps/progress.h"
#include "apps/verbs.h"
#include "core/session.h"

namespace articap {
namespace {

// Of the longest file of that role; NaN where there is none.
double DurationOf_s(const StoredTake& take, FileRole role) {
  double longest_s = NAN;
  for (const TakeFile& file : take.FilesOf(role))
    longest_s = std::fmax(longest_s, take.DurationOf_s(file));
  return longest_s;
}

// Of the longest video, all its parts together; NaN where there is none.
double VideoDurationOf_s(const StoredTake& take) {
  double longest_s = NAN;
  for (const std::string& camera : take.cameras())
    longest_s = std::fmax(longest_s, take.DurationOf_s(take.WholeVideoOf(camera)));
  return longest_s;
}

// A part has no bytes of its own.
double SizeOf_bytes(const StoredTake& take) {
  double bytes = 0;
  if (take.info.part) return bytes;
  for (const TakeFile& file : take.info.files) bytes += static_cast<double>(file.digest.size_bytes);
  return bytes;
}

// "1 take", "2 takes".
std::string Count(std::size_t number, const std::string& what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

ReportTable TakeTable(const Recording& recording) {
  ReportTable table = {
      "take", {"markers_s", "audio_s", "video_s", "cameras", "labels", "size_bytes"}, {}};
  for (const StoredTake& take : recording.takes())
    table.rows.push_back(
        {take.info.id,
         {DurationOf_s(take, FileRole::kMarkers), DurationOf_s(take, FileRole::kAudio),
          VideoDurationOf_s(take), static_cast<double>(take.cameras().size()),
          static_cast<double>(take.FilesOf(FileRole::kLabels).size()), SizeOf_bytes(take)}});
  return table;
}

// Every video, its parts together.
ReportTable VideoTable(const Recording& recording) {
  ReportTable table = {
      "video", {"width_px", "height_px", "rate_hz", "frames", "parts", "offset_s"}, {}};
  for (const StoredTake& take : recording.takes())
    for (const std::string& camera : take.cameras()) {
      if (take.info.part) continue;
      const TakeFile whole = take.WholeVideoOf(camera);
      const std::chrono::duration<double> offset = whole.offset;
      table.rows.push_back({take.info.id + "/" + camera,
                            {double(whole.width), double(whole.height), whole.rate_hz,
                             static_cast<double>(whole.frames),
                             static_cast<double>(take.VideoOf(camera).size()), offset.count()}});
    }
  return table;
}

// The whole of which a take is a part, where the part names the same files; null otherwise.
const StoredTake* WholeOf(const StoredTake& take, const Recording& recording) {
  const StoredTake* const whole = take.info.part ? recording.Find(take.info.part->of) : nullptr;
  if (whole == nullptr || whole->info.part) return nullptr;
  const auto same = [](const TakeFile& first, const TakeFile& second) {
    return first.name == second.name && first.digest == second.digest;
  };
  return std::equal(take.info.files.begin(), take.info.files.end(), whole->info.files.begin(),
                    whole->info.files.end(), same)
             ? whole
             : nullptr;
}

std::vector<std::string> FaultsOf(const Recording& recording) {
  std::vector<std::string> faults;
  // The files of a part are those of the whole, which are read once.
  for (const StoredTake& take : recording.takes())
    if (!WholeOf(take, recording)) std::ranges::move(VerifyTake(take), std::back_inserter(faults));
  return faults;
}

std::size_t CountFiles(const Recording& recording) {
  std::size_t count = 0;
  for (const StoredTake& take : recording.takes())
    if (!take.info.part) count += take.info.files.size();
  return count;
}

// Of each whole take the longest file.
double TotalDuration_s(const Recording& recording) {
  double total_s = 0;
  for (const StoredTake& take : recording.takes()) {
    if (take.info.part) continue;
    double longest_s = 0;
    for (const double duration_s : {DurationOf_s(take, FileRole::kMarkers),
                                    DurationOf_s(take, FileRole::kAudio), VideoDurationOf_s(take)})
      longest_s = std::fmax(longest_s, duration_s);
    total_s += longest_s;
  }
  return total_s;
}

std::string VerdictOn(const Recording& recording, const std::vector<std::string>& faults) {
  if (faults.empty())
    return fmt::format("{}: {} of {}, every file as it was", recording.folder().filename().string(),
                       Count(recording.takes().size(), "take"), recording.info().speaker);
  return fmt::format("{} of {} missing or altered; put back from a copy what the warnings name",
                     faults.size(), Count(CountFiles(recording), "file"));
}

StageReport DescribeSession(const Recording& recording, const std::vector<std::string>& faults) {
  const SessionInfo& info = recording.info();
  StageReport report;
  report.stage = "session";
  report.usable = faults.empty();
  report.verdict = VerdictOn(recording, faults);
  report.texts = {{"speaker", info.speaker},
                  {"map", info.map.empty() ? "not said" : info.map},
                  {"rig", info.rig.empty() ? "the default head" : info.rig}};
  if (!info.notes.empty()) report.texts.emplace_back("notes", info.notes);
  report.figures = {{"takes", static_cast<double>(recording.takes().size())},
                    {"files", static_cast<double>(CountFiles(recording))},
                    {"duration_s", TotalDuration_s(recording)}};
  report.tables = {TakeTable(recording)};
  if (ReportTable videos = VideoTable(recording); !videos.rows.empty())
    report.tables.push_back(std::move(videos));
  report.warnings = faults;
  for (const auto& folder : recording.unfinished())
    report.warnings.push_back(
        fmt::format("takes/{} holds no take.toml: an import was cut short; delete the folder and "
                    "import again",
                    folder.filename().string()));
  return report;
}

}  // namespace

ExitCode SessionInfoCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap session info",
                "The takes of a session, and whether every file is as it was.",
                "articap session info anna_01");
  std::string session;
  line.Argument("SESSION", session, "folder of the session");
  if (const auto exit = line.Parse(arguments)) return *exit;
  const Result<Recording> recording = OpenSession(session);
  if (!recording) return FailWith(recording.error());
  const auto faults = WithProgress("verifying " + session, [&] { return FaultsOf(*recording); });
  return line.Finish({DescribeSession(*recording, faults)});
}

}  // namespace articap
