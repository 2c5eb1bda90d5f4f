// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>

#include "apps/marker_input.h"
#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/verbs.h"

namespace articap {
namespace {

constexpr std::array<MarkerFormat, 6> kFormats = {
    MarkerFormat::kC3d,      MarkerFormat::kTrc,       MarkerFormat::kQualisysTsv,
    MarkerFormat::kNexusCsv, MarkerFormat::kMotiveCsv, MarkerFormat::kPlainCsv};

Result<MarkerFormat> ChosenFormat(const std::string& name, const std::string& path) {
  if (name.empty()) return MarkerFormatOf(path);
  std::string known;
  for (const MarkerFormat format : kFormats) {
    if (name == NameOf(format)) return format;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", NameOf(format));
  }
  return Fail(fmt::format("--format {}: no such format; there are {}", name, known));
}

StageReport DescribeConversion(const MarkerRecording& recording, MarkerFormat format,
                               const std::string& path) {
  const StageTracks& tracks = recording.tracks;
  int num_missing = 0;
  for (int marker = 0; marker < tracks.num_markers(); ++marker)
    num_missing += tracks.CountMissing(marker);
  StageReport report;
  report.stage = "convert";
  report.verdict = fmt::format("{} frames of {} markers written to {}", tracks.num_frames(),
                               tracks.num_markers(), path);
  report.texts = {{"format", NameOf(format)}};
  report.figures = {{"rate_hz", tracks.rate_hz()},
                    {"missing_samples", static_cast<double>(num_missing)}};
  report.warnings = recording.warnings;
  for (const std::string& loss : LossesOf(recording, format)) report.warnings.push_back(loss);
  return report;
}

}  // namespace

ExitCode ConvertCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap convert",
                "Between marker formats. What the format of OUT cannot carry is named.",
                "articap convert take01.c3d take01.trc");
  std::string input, output, format_name;
  MarkerReadOptions read_options;
  line.Argument("IN", input, "marker file: C3D, TRC, Qualisys TSV, CSV (Nexus, Motive, plain)");
  line.Argument("OUT", output, "marker file to write; its ending says the format");
  line.Flag("--format", format_name, "NAME",
            "c3d, trc, tsv, nexus, motive or csv, whatever the ending");
  line.Stage("read", read_options);
  if (const auto exit = line.Parse(arguments)) return *exit;

  const Result<MarkerFormat> format = ChosenFormat(format_name, output);
  if (!format) return FailWith(ExitCode::kWrongUsage, format.error().message);
  const Result<MarkerRecording> recording =
      WithProgress("reading " + input, [&] { return ReadMarkers(input, read_options); });
  if (!recording) return FailWith(recording.error());
  if (const auto limit = LimitExceeded(*recording, *format))
    return FailWith(ExitCode::kNotUsable,
                    fmt::format("{} has {}; write another format", input, *limit));
  OutputSet outputs;
  outputs.Add(output, FormatMarkers(*recording, *format));
  if (const auto allowed = outputs.RefuseToOverwrite({input, line.config_path()}); !allowed)
    return FailWith(allowed.error());
  if (const auto written = outputs.Commit(); !written) return FailWith(written.error());
  return line.Finish({DescribeConversion(*recording, *format, output)});
}

}  // namespace articap
