// SPDX-License-Identifier: MIT
#include "capture/comb.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <tuple>
#include <utility>

namespace articap {
namespace {

// As few moving pixels could be noise, or one flickering lamp.
constexpr std::int64_t kEnoughMoving = 1000;
// Between what whole pictures give (at most 0, noise included) and fields (at least 0.25, less what
// a camera smooths across its rows).
constexpr double kSurelyFields = 0.10;
constexpr double kSurelyWhole = 0.03;
// Between 1 (no order to be seen) and 3.
constexpr double kSureOrder = 1.4;

std::vector<std::uint8_t> LevelsOf(const ImageView& picture) {
  std::vector<std::uint8_t> levels(static_cast<std::size_t>(picture.width) * picture.height);
  for (int y = 0; y < picture.height; ++y) {
    const std::uint8_t* const row = picture.row(y);
    std::uint8_t* const out = levels.data() + static_cast<std::ptrdiff_t>(y) * picture.width;
    if (picture.format == PixelFormat::kGray8) {
      std::copy_n(row, picture.width, out);
      continue;
    }
    for (int x = 0; x < picture.width; ++x) {
      std::uint16_t value = 0;
      std::memcpy(&value, row + 2 * static_cast<std::ptrdiff_t>(x), sizeof value);
      out[x] = static_cast<std::uint8_t>((value + 128) / 257);
    }
  }
  return levels;
}

float Square(float value) { return value * value; }

constexpr int kSmoothed_px = 5;  // along a row: movement covers neighbours, noise does not

// What changed from picture to picture, summed over so many neighbours in the row.
std::vector<std::int16_t> SmoothChanges(const std::vector<std::uint8_t>& last,
                                        const std::vector<std::uint8_t>& next, int width) {
  constexpr int kReach = kSmoothed_px / 2;
  std::vector<std::int16_t> changes(next.size(), 0);
  std::vector<std::int16_t> single(static_cast<std::size_t>(width));
  for (std::size_t row = 0; row < next.size(); row += static_cast<std::size_t>(width)) {
    for (int x = 0; x < width; ++x)
      single[x] = static_cast<std::int16_t>(next[row + x] - last[row + x]);
    for (int x = kReach; x + kReach < width; ++x)
      changes[row + x] = static_cast<std::int16_t>(single[x - 2] + single[x - 1] + single[x] +
                                                   single[x + 1] + single[x + 2]);
  }
  return changes;
}

// Summed changes above this are movement: beyond five standard deviations of the noise, which is
// the change in the quieter fifth of the picture's pieces.
int MovementThreshold(const std::vector<std::int16_t>& changes) {
  constexpr float kLeast = 12;       // of 255: compression makes smaller ones
  constexpr float kNoisiest = 4.5F;  // a camera's; more is movement all over the picture
  constexpr std::size_t kPiece = 256;
  std::vector<float> rms;
  for (std::size_t start = 0; start + kPiece <= changes.size(); start += kPiece) {
    std::int32_t sum = 0;  // of at most (5 * 255)^2 each
    for (std::size_t i = start; i < start + kPiece; ++i)
      sum += std::int32_t{changes[i]} * changes[i];
    rms.push_back(std::sqrt(static_cast<float>(sum) / kPiece) / kSmoothed_px);
  }
  float threshold = kLeast;
  if (!rms.empty()) {
    const auto quiet = rms.begin() + static_cast<std::ptrdiff_t>(rms.size() / 5);
    std::nth_element(rms.begin(), quiet, rms.end());
    threshold = std::max(kLeast, 5 * std::min(*quiet, kNoisiest));
  }
  return static_cast<int>(threshold * kSmoothed_px);
}

// Whether anything in a row moves.
bool RowMoves(const std::int16_t* changes, int width, int threshold) {
  int largest = 0;
  for (int x = 0; x < width; ++x) largest = std::max(largest, std::abs(int{changes[x]}));
  return largest > threshold;
}

}  // namespace

std::optional<bool> CombEvidence::interlaced() const {
  if (moving_pixels < kEnoughMoving) return std::nullopt;
  // Stripes as fine as the rows are no fields: they look the same in either order.
  if (comb > kSurelyFields && top_field_first()) return true;
  if (comb < kSurelyWhole) return false;
  return std::nullopt;
}

std::optional<bool> CombEvidence::top_field_first() const {
  if (moving_pixels < kEnoughMoving || std::max(order, 1 / order) < kSureOrder) return std::nullopt;
  return order > 1;
}

void CombMeter::Add(const ImageView& picture) {
  if (picture.format == PixelFormat::kRgb8) return;
  const bool is_first = last_.empty();
  if (is_first) std::tie(width_, height_) = std::pair(picture.width, picture.height);
  if (picture.width != width_ || picture.height != height_) return;
  std::vector<std::uint8_t> next = LevelsOf(picture);
  if (!is_first && height_ > 4) Compare(next);
  last_ = std::move(next);
}

void CombMeter::Compare(const std::vector<std::uint8_t>& next) {
  const std::vector<std::int16_t> changes = SmoothChanges(last_, next, width_);
  const int threshold = MovementThreshold(changes);
  const auto row = [&](int y) { return changes.data() + static_cast<std::ptrdiff_t>(y) * width_; };
  std::vector<bool> moves(static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y) moves[y] = RowMoves(row(y), width_, threshold);
  for (int y = 2; y + 2 < height_; ++y)
    if (moves[y - 1] || moves[y] || moves[y + 1]) CompareRow(next, row(y), threshold, y);
}

void CombMeter::CompareRow(const std::vector<std::uint8_t>& next, const std::int16_t* changes,
                           int threshold, int y) {
  const std::ptrdiff_t width = width_;
  const std::uint8_t* const now = next.data() + y * width;
  const std::uint8_t* const before = last_.data() + y * width;
  const bool is_top = y % 2 == 0;
  for (int x = 0; x < width_; ++x) {
    const bool moves = std::max({std::abs(changes[x]), std::abs(changes[x - width]),
                                 std::abs(changes[x + width])}) > threshold;
    if (!moves) continue;
    const auto mean = [x](const std::uint8_t* row, std::ptrdiff_t off) {
      return static_cast<float>(row[x - off] + row[x + off]) / 2;
    };
    const float here = now[x], here_before = before[x];
    ++sums_.moving;
    sums_.change += Square(here - here_before);
    sums_.beside += Square(here - mean(now, width));
    sums_.two_away += Square(here - mean(now, 2 * width));
    // This row of one picture, and those beside it of the other.
    const float later = Square(here - mean(before, width));
    const float earlier = Square(here_before - mean(now, width));
    sums_.bottom_then_top += is_top ? later : earlier;
    sums_.top_then_bottom += is_top ? earlier : later;
  }
}

CombEvidence CombMeter::evidence() const {
  CombEvidence evidence;
  evidence.moving_pixels = sums_.moving;
  if (sums_.change > 0) evidence.comb = (sums_.beside - sums_.two_away) / sums_.change;
  // One grey level a pixel of what is no movement keeps the quotient sensible.
  const auto floor = static_cast<double>(sums_.moving) + 1;
  evidence.order = (sums_.top_then_bottom + floor) / (sums_.bottom_then_top + floor);
  return evidence;
}

}  // namespace articap
