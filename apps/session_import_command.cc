// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "apps/marker_input.h"
#include "apps/session_import.h"
#include "apps/verbs.h"
#include "core/time.h"

namespace articap {
namespace {

// Larger than any session, and within int64 ns.
constexpr double kLongestOffset_s = 1e6;

StageReport DescribeImport(const StoredTake& take, const Import& import) {
  StageReport report;
  report.stage = "import";
  report.verdict = fmt::format("take {}, copied byte for byte", take.info.id);
  if (take.info.id != import.id)
    report.verdict += fmt::format("; there was a take {} already", import.id);
  report.texts = {{"take", take.folder.string()}};
  for (const TakeFile& file : take.info.files)
    report.texts.emplace_back(NameOf(file.role), file.name);
  report.warnings = import.warnings;
  return report;
}

Result<StageReport> RunImport(const std::string& session, const std::vector<std::string>& files,
                              const ImportOptions& options) {
  if (const auto info = ReadSessionInfo(session); !info) return tl::unexpected(info.error());
  const Result<Import> import = PrepareImport(files, options);
  if (!import) return tl::unexpected(import.error());
  const Result<StoredTake> take = StoreTake(session, *import);
  if (!take) return tl::unexpected(take.error());
  return DescribeImport(*take, *import);
}

}  // namespace

ExitCode SessionImportCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap session import",
                "Make a take of what was recorded together: one file of markers, WAV files,\n"
                "TextGrids, in any combination. They are copied byte for byte.",
                "articap session import anna_01 take01.c3d take01.wav take01.TextGrid");
  std::string session;
  std::vector<std::string> files;
  double audio_offset_s = 0;
  ImportOptions options;
  line.Argument("SESSION", session, "folder of the session, from 'articap session new'");
  line.Arguments("FILE", files, "what was recorded together");
  line.Flag("--id", options.id, "NAME",
            "name of the take; else the stem of the markers, or of the audio");
  line.Flag("--audio-offset-s", audio_offset_s, "X",
            "seconds of the markers' time at which the audio begins; labels go with it");
  line.Stage("read", options.read);
  if (const auto exit = line.Parse(arguments)) return *exit;
  if (!(std::abs(audio_offset_s) <= kLongestOffset_s))
    return FailWith(ExitCode::kWrongUsage,
                    fmt::format("--audio-offset-s {}: give seconds within +-{}", audio_offset_s,
                                kLongestOffset_s));
  options.audio_offset = SessionTimeFromSeconds(audio_offset_s).time_since_epoch();
  const Result<StageReport> report = RunImport(session, files, options);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
