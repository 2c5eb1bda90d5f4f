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

std::vector<float> LevelsOf(const ImageView& picture) {
  std::vector<float> levels;
  levels.reserve(static_cast<std::size_t>(picture.width) * picture.height);
  for (int y = 0; y < picture.height; ++y) {
    const std::uint8_t* const row = picture.row(y);
    for (int x = 0; x < picture.width; ++x) {
      if (picture.format == PixelFormat::kGray8) {
        levels.push_back(row[x]);
        continue;
      }
      std::uint16_t value = 0;
      std::memcpy(&value, row + 2 * x, sizeof value);
      levels.push_back(static_cast<float>(value) / 257.0F);
    }
  }
  return levels;
}

float Square(float value) { return value * value; }

constexpr int kSmoothed_px = 5;  // along a row: movement covers neighbours, noise does not

// What changed from picture to picture, smoothed along the rows.
std::vector<float> SmoothChanges(const std::vector<float>& last, const std::vector<float>& next,
                                 int width) {
  constexpr int kReach = kSmoothed_px / 2;
  std::vector<float> changes(next.size(), 0);
  for (std::size_t row = 0; row < next.size(); row += static_cast<std::size_t>(width))
    for (int x = kReach; x + kReach < width; ++x) {
      float sum = 0;
      for (int near = x - kReach; near <= x + kReach; ++near)
        sum += next[row + near] - last[row + near];
      changes[row + x] = sum / kSmoothed_px;
    }
  return changes;
}

// Smoothed changes above this are movement: beyond five standard deviations of the noise, which is
// the change in the quieter fifth of the picture's pieces.
float MovementThreshold(const std::vector<float>& changes) {
  constexpr float kLeast = 12;       // of 255: compression makes smaller ones
  constexpr float kNoisiest = 4.5F;  // a camera's; more is movement all over the picture
  constexpr std::size_t kPiece = 256;
  std::vector<float> rms;
  for (std::size_t start = 0; start + kPiece <= changes.size(); start += kPiece) {
    float sum = 0;
    for (std::size_t i = start; i < start + kPiece; ++i) sum += changes[i] * changes[i];
    rms.push_back(std::sqrt(sum / kPiece));
  }
  if (rms.empty()) return kLeast;
  const auto quiet = rms.begin() + static_cast<std::ptrdiff_t>(rms.size() / 5);
  std::nth_element(rms.begin(), quiet, rms.end());
  return std::max(kLeast, 5 * std::min(*quiet, kNoisiest));
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
  std::vector<float> next = LevelsOf(picture);
  if (!is_first && height_ > 4) Compare(next);
  last_ = std::move(next);
}

void CombMeter::Compare(const std::vector<float>& next) {
  const std::vector<float> changes = SmoothChanges(last_, next, width_);
  const float threshold = MovementThreshold(changes);
  const auto width = static_cast<std::size_t>(width_);
  for (int y = 2; y + 2 < height_; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t here = static_cast<std::size_t>(y) * width + x;
      const std::size_t up = here - width, down = here + width;
      const bool moves = std::max({std::abs(changes[here]), std::abs(changes[up]),
                                   std::abs(changes[down])}) > threshold;
      if (!moves) continue;
      ++sums_.moving;
      sums_.change += Square(next[here] - last_[here]);
      sums_.beside += Square(next[here] - (next[up] + next[down]) / 2);
      sums_.two_away += Square(next[here] - (next[up - width] + next[down + width]) / 2);
      // This row of one picture, and those beside it of the other.
      const float later = Square(next[here] - (last_[up] + last_[down]) / 2);
      const float earlier = Square(last_[here] - (next[up] + next[down]) / 2);
      const bool is_top = y % 2 == 0;
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
