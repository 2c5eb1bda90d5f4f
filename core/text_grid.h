// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/time.h"

namespace articap {

// A label of a tier, times in seconds from the start of the recording. A point's start is its end.
struct TextGridLabel {
  double start_s = 0;
  double end_s = 0;
  std::string text;  // UTF-8
};

struct TextGridTier {
  enum class Kind : std::uint8_t { kIntervals, kPoints };
  std::string name;
  Kind kind = Kind::kIntervals;
  std::vector<TextGridLabel> labels;  // in the order of time, intervals without overlaps
};

// Praat's annotation of a recording.
struct TextGrid {
  double start_s = 0;
  double end_s = 0;
  std::vector<TextGridTier> tiers;
  std::vector<std::string> warnings;  // what reading had to assume, each a sentence
};

// Reads the long and the short text form, in UTF-8, UTF-16 (with or without byte order mark) or,
// with a warning, Latin-1.
Result<TextGrid> ParseTextGrid(std::string_view bytes, const std::string& source_name);
Result<TextGrid> ReadTextGrid(const std::filesystem::path& path);

// Adds to every time.
void ShiftTimes(TextGrid& grid, double shift_s);

// The tier of that name; where the name is empty, the one interval tier whose name says phones
// ("phones", "phone", "segments", "MAU", "Anna - phones", ...). The error names the tiers there
// are.
Result<const TextGridTier*> FindPhoneTier(const TextGrid& grid, std::string_view name = {});

// The label at each time: of the interval with start <= time < end (the last interval includes its
// end), or, of a tier of points, the label of a point at the time nearest to it. Empty where there
// is none. Times ascend.
std::vector<std::string> LabelsOfFrames(const TextGridTier& tier,
                                        std::span<const SessionTime> times);

}  // namespace articap
