// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "apps/progress.h"
#include "apps/verbs.h"
#include "core/session.h"

namespace articap {
namespace {

// Of the longest file of that role; NaN where there is none.
double DurationOf_s(const StoredTake& take, FileRole role) {
  double longest_s = NAN;
  for (const TakeFile& file : take.FilesOf(role))
    longest_s = std::fmax(longest_s, file.duration_s());
  return longest_s;
}

double SizeOf_bytes(const StoredTake& take) {
  double bytes = 0;
  for (const TakeFile& file : take.info.files) bytes += static_cast<double>(file.digest.size_bytes);
  return bytes;
}

// "1 take", "2 takes".
std::string Count(std::size_t number, const std::string& what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

ReportTable TakeTable(const Recording& recording) {
  ReportTable table = {"take", {"markers_s", "audio_s", "labels", "size_bytes"}, {}};
  for (const StoredTake& take : recording.takes())
    table.rows.push_back(
        {take.info.id,
         {DurationOf_s(take, FileRole::kMarkers), DurationOf_s(take, FileRole::kAudio),
          static_cast<double>(take.FilesOf(FileRole::kLabels).size()), SizeOf_bytes(take)}});
  return table;
}

std::vector<std::string> FaultsOf(const Recording& recording) {
  std::vector<std::string> faults;
  for (const StoredTake& take : recording.takes())
    std::ranges::move(VerifyTake(take), std::back_inserter(faults));
  return faults;
}

std::size_t CountFiles(const Recording& recording) {
  std::size_t count = 0;
  for (const StoredTake& take : recording.takes()) count += take.info.files.size();
  return count;
}

// Of each take the longest file.
double TotalDuration_s(const Recording& recording) {
  double total_s = 0;
  for (const StoredTake& take : recording.takes()) {
    double longest_s = 0;
    for (const TakeFile& file : take.info.files) longest_s = std::max(longest_s, file.duration_s());
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
