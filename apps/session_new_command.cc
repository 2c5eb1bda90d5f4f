// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "apps/output_set.h"
#include "apps/resources.h"
#include "apps/verbs.h"
#include "core/io/text.h"
#include "core/marker_set.h"
#include "core/session.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

// A map of one's own goes along with the session, under this name.
constexpr const char* kOwnMapName = "markers.toml";

struct NewSession {
  std::string folder, speaker, map, notes;
};

Result<void> CheckPlace(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::is_empty(folder, error)) return {};
  return Fail(fmt::format("{}: is there already; a session begins in a new or empty folder",
                          folder.string()));
}

Result<void> CheckTexts(const NewSession& wanted) {
  if (wanted.speaker.empty()) return Fail("--speaker is empty; name who speaks");
  for (const auto& [flag, text] :
       {std::pair<const char*, const std::string&>{"--speaker", wanted.speaker},
        {"--notes", wanted.notes}})
    if (!IsUtf8(text)) return Fail(fmt::format("{}: the text is not UTF-8", flag));
  return {};
}

// What session.toml says of the map, whose file becomes one of the outputs where it is one's own.
Result<std::string> AdoptMap(const NewSession& wanted, OutputSet& outputs) {
  if (wanted.map.empty()) return std::string();
  const Result<fs::path> path = FindMap(wanted.map);
  if (!path) return tl::unexpected(path.error());
  if (const auto readable = ReadMarkerSet(*path); !readable)
    return tl::unexpected(readable.error());
  std::error_code error;
  if (!fs::exists(wanted.map, error)) return wanted.map;
  Result<std::string> bytes = ReadFile(*path);
  if (!bytes) return tl::unexpected(bytes.error());
  outputs.Add(fs::path(wanted.folder) / kOwnMapName, *std::move(bytes));
  return std::string(kOwnMapName);
}

Result<StageReport> MakeSession(const NewSession& wanted) {
  if (const auto texts = CheckTexts(wanted); !texts) return tl::unexpected(texts.error());
  if (const auto place = CheckPlace(wanted.folder); !place) return tl::unexpected(place.error());
  OutputSet outputs;
  const Result<std::string> map = AdoptMap(wanted, outputs);
  if (!map) return tl::unexpected(map.error());
  const SessionInfo session = {
      .speaker = wanted.speaker, .map = *map, .rig = {}, .notes = wanted.notes};
  outputs.Add(fs::path(wanted.folder) / kSessionFileName, WriteSessionInfo(session));
  if (const auto written = outputs.Commit(); !written) return tl::unexpected(written.error());
  StageReport report;
  report.stage = "session";
  report.verdict = fmt::format(
      "{}: a session of {}, without takes yet; 'articap session import' "
      "brings them in",
      wanted.folder, wanted.speaker);
  report.texts = {{"map", map->empty() ? "not said" : *map}};
  return report;
}

}  // namespace

ExitCode SessionNewCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap session new",
                "Begin the session of a speaker: a folder that holds raw recordings as they were.",
                "articap session new anna_01 --speaker anna --map spectacles30");
  NewSession wanted;
  line.Argument("SESSION", wanted.folder, "folder to make");
  line.Flag("--speaker", wanted.speaker, "NAME", "who speaks")->required();
  line.Flag("--map", wanted.map, "NAME|FILE",
            "marker map: one that comes with articap, or a file, which is copied");
  line.Flag("--notes", wanted.notes, "TEXT", "what else should be known");
  if (const auto exit = line.Parse(arguments)) return *exit;
  const Result<StageReport> report = MakeSession(wanted);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
