// SPDX-License-Identifier: MIT
#include "apps/session_split.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "apps/progress.h"
#include "apps/take_folder.h"
#include "capture/sound_events.h"
#include "core/file_io.h"
#include "core/text_grid.h"
#include "core/time.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

// The one file of its role, as it was; of audio the first: others were made from videos.
Result<TakeFile> FileFor(const StoredTake& take, FileRole role) {
  const std::vector<TakeFile> files = take.FilesOf(role);
  if (files.empty() || (files.size() > 1 && role == FileRole::kLabels))
    return Fail(fmt::format("the take {} has {} files of {}, where one is needed", take.info.id,
                            files.size(), NameOf(role)));
  if (const auto fault = FaultOf(take, files[0])) return Fail(*fault + "; put it back from a copy");
  return files[0];
}

Result<std::vector<Cut>> CutsByTier(const StoredTake& take, const std::string& tier_name) {
  const Result<TakeFile> file = FileFor(take, FileRole::kLabels);
  if (!file) return tl::unexpected(file.error());
  Result<TextGrid> grid = ReadTextGrid(take.PathOf(*file));
  if (!grid) return tl::unexpected(grid.error());
  ShiftTimes(*grid, Seconds(file->offset).count());
  const Result<const TextGridTier*> tier = FindPhoneTier(*grid, tier_name);
  if (!tier) return Fail(fmt::format("{}: {}", file->name, tier.error().message));
  return CutsOfTier(**tier);
}

Result<std::vector<Cut>> CutsBySound(const StoredTake& take, const SplitRule& rule,
                                     const SplitOptions& options) {
  const Result<TakeFile> file = FileFor(take, FileRole::kAudio);
  if (!file) return tl::unexpected(file.error());
  const auto envelope = WithProgress("listening to " + file->name, [&] {
    return ReadEnvelope(take.PathOf(*file), rule.silence ? 0 : rule.pulse_channel - 1);
  });
  if (!envelope) return tl::unexpected(envelope.error());
  std::vector<Cut> cuts = rule.silence
                              ? FindSpeech(*envelope, {options.above_noise_db, options.min_speech_s,
                                                       options.min_silence_s})
                              : FindPulseBursts(*envelope, options.gap_s);
  if (cuts.empty())
    return Fail(fmt::format(
        "{}: {}", file->name,
        rule.silence ? "nothing in it is louder than the noise by --above-noise-db; lower it"
                     : "no pulses stand out on that channel; name the channel of the pulses"));
  for (Cut& cut : cuts) {
    cut.start_s += Seconds(file->offset).count();
    cut.end_s += Seconds(file->offset).count();
  }
  return cuts;
}

Result<std::vector<Cut>> CutsByTimes(const std::string& path) {
  const Result<std::string> text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseCuts(*text, path);
}

// From when to when anything was recorded.
std::pair<double, double> ExtentOf_s(const StoredTake& take) {
  double start_s = std::numeric_limits<double>::infinity(), end_s = -start_s;
  const auto add = [&](const TakeFile& file) {
    const double offset_s = Seconds(file.offset).count();
    start_s = std::min(start_s, offset_s);
    end_s = std::max(end_s, offset_s + static_cast<double>(file.frames) / file.rate_hz);
  };
  for (const TakeFile& file : take.info.files)
    if (file.role == FileRole::kMarkers || file.role == FileRole::kAudio) add(file);
  for (const std::string& camera : take.cameras()) add(take.WholeVideoOf(camera));
  return {start_s, end_s};
}

std::string IdOf(const StoredTake& take, std::size_t number, std::size_t count, const Cut& cut) {
  constexpr std::size_t kLongestWhole = 40;
  const int digits = count < 100 ? 2 : count < 1000 ? 3 : 5;
  std::string id = fmt::format("{}_{:0{}}", take.info.id.substr(0, kLongestWhole), number, digits);
  if (!cut.name.empty()) id += "_" + SafeNameOf(cut.name);
  return id.substr(0, kLongestTakeId);
}

// The cut with its pad, within the recording; nothing where it lies outside.
std::optional<TakePart> PartOf(const StoredTake& take, const Cut& cut, double pad_s) {
  const auto [first_s, last_s] = ExtentOf_s(take);
  const double start_s = std::max(cut.start_s - pad_s, first_s);
  const double end_s = std::min(cut.end_s + pad_s, last_s);
  constexpr double kLongest_s = 9e9;  // within int64 ns
  if (!(start_s < end_s) || start_s < -kLongest_s || end_s > kLongest_s) return std::nullopt;
  const TakePart part = {take.info.id, SessionTimeFromSeconds(start_s).time_since_epoch(),
                         SessionTimeFromSeconds(end_s).time_since_epoch()};
  return part.end > part.start ? std::optional(part) : std::nullopt;
}

// Whether markers were recorded, but none then.
bool LacksMarkers(const StoredTake& take, const TakePart& part) {
  StoredTake cut = take;
  cut.info.part = part;
  const std::vector<TakeFile> markers = cut.FilesOf(FileRole::kMarkers);
  return !markers.empty() && cut.DurationOf_s(markers[0]) <= 0;
}

struct MadePart {
  TakeFolder folder;
  TakePart part;
};

Result<MadePart> MakePart(const StoredTake& whole, const TakePart& part, const std::string& id) {
  Result<TakeFolder> folder = MakeTakeFolder(whole.folder.parent_path(), id);
  if (!folder) return tl::unexpected(folder.error());
  TakeInfo take = whole.info;
  take.id = folder->path().filename().string();
  take.part = part;
  const auto written = WriteFile(folder->path() / kTakeFileName, WriteTakeInfo(take));
  if (!written) return tl::unexpected(written.error());
  return MadePart{*std::move(folder), part};
}

StageReport DescribeParts(const StoredTake& take, const std::vector<MadePart>& parts) {
  StageReport report;
  report.stage = "split";
  ReportTable table = {"part", {"start_s", "end_s", "duration_s"}, {}};
  double total_s = 0;
  for (const MadePart& made : parts) {
    const double start_s = Seconds(made.part.start).count();
    const double end_s = Seconds(made.part.end).count();
    total_s += end_s - start_s;
    const std::string id = made.folder.path().filename().string();
    table.rows.push_back({id, {start_s, end_s, end_s - start_s}});
    if (LacksMarkers(take, made.part))
      report.warnings.push_back(fmt::format("{}: no markers were recorded then", id));
  }
  report.verdict = fmt::format("take {} cut into {} part{}; its files stay where they are",
                               take.info.id, parts.size(), parts.size() == 1 ? "" : "s");
  report.figures = {{"parts", static_cast<double>(parts.size())}, {"duration_s", total_s}};
  report.tables = {std::move(table)};
  return report;
}

}  // namespace

void VisitOptions(SplitOptions& options, OptionVisitor& visit) {
  visit("pad_s", options.pad_s, "seconds added before and behind every part");
  visit("gap_s", options.gap_s, "pulses farther apart than this belong to two bursts; s");
  visit("above_noise_db", options.above_noise_db,
        "what is louder than the noise floor by this is speech; dB");
  visit("min_speech_s", options.min_speech_s, "shorter sounds are no speech; s");
  visit("min_silence_s", options.min_silence_s, "shorter silences do not part; s");
}

Result<std::vector<Cut>> FindCuts(const StoredTake& take, const SplitRule& rule,
                                  const SplitOptions& options) {
  if (take.info.part)
    return Fail(fmt::format("{} is a part of {}; split that", take.info.id, take.info.part->of));
  const auto allowed = RequireNotNegative({{"--pad-s", options.pad_s},
                                           {"--gap-s", options.gap_s},
                                           {"--above-noise-db", options.above_noise_db},
                                           {"--min-speech-s", options.min_speech_s},
                                           {"--min-silence-s", options.min_silence_s}});
  if (!allowed) return tl::unexpected(allowed.error());
  if (!rule.tier.empty()) return CutsByTier(take, rule.tier);
  if (!rule.times.empty()) return CutsByTimes(rule.times);
  return CutsBySound(take, rule, options);
}

Result<StageReport> SplitTake(const StoredTake& take, const std::vector<Cut>& cuts,
                              const SplitOptions& options) {
  std::vector<MadePart> parts;
  std::vector<std::string> warnings;
  for (const Cut& cut : cuts) {
    const std::optional<TakePart> part = PartOf(take, cut, options.pad_s);
    if (!part) {
      warnings.push_back(fmt::format("{:.3f} to {:.3f} s {}: nothing was recorded then; left out",
                                     cut.start_s, cut.end_s, cut.name));
      continue;
    }
    Result<MadePart> made = MakePart(take, *part, IdOf(take, parts.size() + 1, cuts.size(), cut));
    if (!made) return tl::unexpected(made.error());
    parts.push_back(*std::move(made));
  }
  if (parts.empty())
    return Fail(fmt::format("the take {} has nothing at these times", take.info.id));
  for (MadePart& made : parts) made.folder.Keep();
  StageReport report = DescribeParts(take, parts);
  report.warnings.insert(report.warnings.begin(), warnings.begin(), warnings.end());
  report.options = EchoOptions(options);
  return report;
}

}  // namespace articap
