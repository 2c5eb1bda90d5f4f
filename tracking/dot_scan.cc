// SPDX-License-Identifier: MIT
#include "tracking/dot_scan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tracking/dot_scan_kernels.h"

namespace articap {
namespace {

// Appends what the bits mark. False if there is no room for all.
bool AppendRuns(const std::vector<std::uint32_t>& words, int y, int most_runs,
                std::vector<DotRun>& runs) {
  const auto begin = static_cast<std::ptrdiff_t>(runs.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::uint32_t word = words[i];
    while (word != 0) {
      const int first = __builtin_ctz(word);
      const std::uint32_t from_first = ~(word >> first);
      const int length = from_first == 0 ? 32 : __builtin_ctz(from_first);
      const int begin_x = static_cast<int>(32 * i) + first;
      const bool goes_on =
          static_cast<std::ptrdiff_t>(runs.size()) > begin && runs.back().end_x == begin_x;
      if (goes_on) {
        runs.back().end_x += length;
      } else {
        if (static_cast<int>(runs.size()) >= most_runs) return false;
        runs.push_back({y, begin_x, begin_x + length});
      }
      if (first + length >= 32) break;
      word &= ~0u << (first + length);
    }
  }
  return true;
}

// The second brightest of the four pixels that one is compared with.
float SurroundOf(const PixelReader& reader, const DotScanOptions& options, int x, int y) {
  const auto value = [&](int at_x, int at_y) {
    const bool inside = at_x >= 0 && at_y >= 0 && at_x < reader.width() && at_y < reader.height();
    return inside ? reader.Value(at_x, at_y) : 0.0f;
  };
  std::array<float, 4> around = {value(x - options.distance_x, y), value(x + options.distance_x, y),
                                 value(x, y - options.distance_y),
                                 value(x, y + options.distance_y)};
  std::sort(around.begin(), around.end());
  return around[2];
}

}  // namespace

bool DotScanner::Cut(const PixelReader& reader, const DotScanOptions& options, const DotRun& run,
                     std::vector<DotRun>& runs) {
  int peak_x = run.begin_x;
  for (int x = run.begin_x; x < run.end_x; ++x)
    if (reader.Value(x, run.y) > reader.Value(peak_x, run.y)) peak_x = x;
  const float half = (reader.Value(peak_x, run.y) + SurroundOf(reader, options, peak_x, run.y)) / 2;
  // Runs above half, and runs below.
  for (int begin = run.begin_x; begin < run.end_x;) {
    const bool above = reader.Value(begin, run.y) > half;
    DotRun part{run.y, begin, begin + 1, begin};
    while (part.end_x < run.end_x && (reader.Value(part.end_x, run.y) > half) == above) {
      if (reader.Value(part.end_x, run.y) > reader.Value(part.peak_x, run.y))
        part.peak_x = part.end_x;
      ++part.end_x;
    }
    begin = part.end_x;
    // The flanks of a peak are none themselves.
    const bool is_flank = !above && (part.peak_x == part.begin_x || part.peak_x == part.end_x - 1);
    if (is_flank && part.end_x - part.begin_x < run.end_x - run.begin_x) continue;
    if (static_cast<int>(runs.size()) >= options.most_runs) return false;
    part.surround = SurroundOf(reader, options, part.peak_x, run.y);
    part.contrast = reader.Value(part.peak_x, run.y) - part.surround;
    const double sigma = std::sqrt(options.noise.VarianceAt(part.surround));
    if (part.contrast > options.margin_sigma * sigma) runs.push_back(part);
  }
  return true;
}

bool DotScanner::Scan(const PixelReader& reader, const DotScanOptions& options,
                      std::vector<DotRun>& runs) {
  runs.clear();
  marked_.clear();
  if (reader.width() == 0 || reader.height() == 0) return true;
  const bool all = reader.is_16_bit() ? ScanRows<std::uint16_t>(reader, options, marked_)
                                      : ScanRows<std::uint8_t>(reader, options, marked_);
  for (const DotRun& run : marked_)
    if (!Cut(reader, options, run, runs)) return false;
  return all;
}

template <class Integer>
bool DotScanner::ScanRows(const PixelReader& reader, const DotScanOptions& options,
                          std::vector<DotRun>& runs) {
  constexpr int kVector = 32;
  const int width = reader.width();
  const int across = options.distance_y / options.step_y;  // rows read, to what is compared
  const int num_read = (reader.height() + options.step_y - 1) / options.step_y;
  // The rows that are still needed in turns, and one that is all dark; dark margins left and right.
  const int num_kept = 2 * across + 1;
  const std::size_t length = width + 2 * options.distance_x + kVector;
  rows_.assign((length * (num_kept + 1) * sizeof(Integer) + 1) / 2, 0);
  auto* const kept = reinterpret_cast<Integer*>(rows_.data()) + options.distance_x;
  const auto row_of = [&](int index) {
    return kept + length * (index < 0 || index >= num_read ? num_kept : index % num_kept);
  };
  constexpr double kFull = static_cast<Integer>(~Integer{0});
  ScanRow<Integer> row;
  row.width = width;
  row.distance_x = options.distance_x;
  row.margin = static_cast<Integer>(std::clamp(std::floor(options.margin * kFull), 0.0, kFull));
  std::vector<std::uint32_t> words((width + 31) / 32);
  for (int index = -across; index < num_read; ++index) {
    const int next = index + across;
    if (next < num_read) reader.ReadRow(next * options.step_y, row_of(next));
    if (index < 0) continue;
    row.row = row_of(index);
    row.above = row_of(index - across);
    row.below = row_of(index + across);
    MarkOutstanding(row, level_, words.data());
    if (!AppendRuns(words, index * options.step_y, options.most_runs, runs)) return false;
  }
  return true;
}

}  // namespace articap
