// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "apps/marker_input.h"
#include "apps/session_import.h"
#include "apps/verbs.h"
#include "core/time.h"

namespace articap {
namespace {

// Larger than any session, and within int64 ns.
constexpr double kLongestOffset_s = 1e6;

StageReport DescribeImport(const ImportedTake& imported, const Import& import) {
  const StoredTake& take = imported.take;
  StageReport report;
  report.stage = "import";
  report.verdict = fmt::format("take {}, copied byte for byte", take.info.id);
  if (take.info.id != import.id)
    report.verdict += fmt::format("; there was a take {} already", import.id);
  report.texts = {{"take", take.folder.string()}};
  for (const TakeFile& file : take.info.files)
    report.texts.emplace_back(NameOf(file.role), file.name);
  for (const auto* const notes : {&import.notes, &imported.notes})
    for (const std::string& note : *notes) report.texts.emplace_back("note", note);
  report.warnings = import.warnings;
  return report;
}

Result<StageReport> RunImport(const std::string& session, const std::vector<std::string>& files,
                              const ImportOptions& options) {
  if (const auto info = ReadSessionInfo(session); !info) return tl::unexpected(info.error());
  const Result<Import> import = PrepareImport(files, options);
  if (!import) return tl::unexpected(import.error());
  const Result<ImportedTake> take = StoreTake(session, *import);
  if (!take) return tl::unexpected(take.error());
  return DescribeImport(*take, *import);
}

// "left=a.MTS", "b.MTS", "right=c.mp4" are the camera left with two parts, and right.
Result<std::vector<CameraFiles>> ParseCameras(const std::vector<std::string>& entries) {
  std::vector<CameraFiles> cameras;
  for (const std::string& entry : entries) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos && !cameras.empty()) {
      cameras.back().parts.emplace_back(entry);
      continue;
    }
    const std::string name = entry.substr(0, equals);
    if (equals == std::string::npos || !IsSafeName(name))
      return Fail(
          fmt::format("--camera {}: give a name (letters, digits, '.', '_' and '-' of "
                      "ASCII) and a file, or its parts: left=00001.MTS,00002.MTS",
                      entry));
    cameras.push_back({name, {entry.substr(equals + 1)}});
  }
  return cameras;
}

struct ImportArguments {
  std::string session;
  std::vector<std::string> files, cameras;
  double audio_offset_s = 0, video_offset_s = 0;
  ImportOptions options;
};

// What the flags say, in the options; or what is wrong with them.
Result<void> ReadFlags(ImportArguments& arguments) {
  for (const auto& [flag, offset_s] :
       {std::pair<const char*, double>{"--audio-offset-s", arguments.audio_offset_s},
        {"--video-offset-s", arguments.video_offset_s}})
    if (!(std::abs(offset_s) <= kLongestOffset_s))
      return Fail(fmt::format("{} {}: give seconds within +-{}", flag, offset_s, kLongestOffset_s));
  auto cameras = ParseCameras(arguments.cameras);
  if (!cameras) return tl::unexpected(cameras.error());
  if (arguments.files.empty() && cameras->empty())
    return Fail("no FILE is named; name what was recorded together");
  ImportOptions& options = arguments.options;
  options.cameras = *std::move(cameras);
  options.audio_offset = SessionTimeFromSeconds(arguments.audio_offset_s).time_since_epoch();
  options.video_offset = SessionTimeFromSeconds(arguments.video_offset_s).time_since_epoch();
  return {};
}

}  // namespace

ExitCode SessionImportCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap session import",
      "Make a take of what was recorded together: one file of markers, videos, sounds,\n"
      "TextGrids, in any combination. They are copied byte for byte; the sound of videos,\n"
      "and of files that are not WAV, comes as WAV besides.",
      "articap session import anna_01 take01.c3d take01.wav take01.TextGrid\n"
      "  articap session import anna_01 --camera front=00001.MTS,00002.MTS");
  ImportArguments values;
  line.Argument("SESSION", values.session, "folder of the session, from 'articap session new'");
  line.Arguments("FILE", values.files, "what was recorded together")->required(false);
  line.Flag("--camera", values.cameras, "NAME=FILE[,FILE...]",
            "a camera's video, or its parts in order; else a video is called by its stem");
  line.Flag("--id", values.options.id, "NAME",
            "name of the take; else the stem of the markers, or of the audio");
  line.Flag("--audio-offset-s", values.audio_offset_s, "X",
            "seconds of the markers' time at which the audio begins; labels go with it");
  line.Flag("--video-offset-s", values.video_offset_s, "X",
            "seconds of the markers' time at which the videos begin");
  line.Stage("read", values.options.read);
  if (const auto exit = line.Parse(arguments)) return *exit;
  if (const auto read = ReadFlags(values); !read)
    return FailWith(ExitCode::kWrongUsage, read.error().message);
  const Result<StageReport> report = RunImport(values.session, values.files, values.options);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
