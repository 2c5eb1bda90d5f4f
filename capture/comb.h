// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/image.h"

namespace articap {

// What whole pictures, in their order, tell of whether they are woven from two fields that were
// exposed one after the other. Only places that change from one picture to the next are looked at.
struct CombEvidence {
  std::int64_t moving_pixels = 0;
  // How much less a row is like the rows beside it than like those two away, in mean squares, over
  // how much it changes from picture to picture. Each row is compared with the mean of the two
  // above and below, which a slant of brightness leaves at 0. An edge that moves by v in a picture
  // has moved by v/2 in the other field: between 1/4 (small v) and 1/2 (large v) for fields, and
  // not above 0 for whole pictures, whose rows are the less alike the farther apart they are.
  double comb = 0;
  // How unlike the first top field is to the second bottom field, over the same of the first bottom
  // and the second top field: in the same speed 3 where the top field is exposed first, for three
  // field times lie between the former two and one between the latter, and 1/3 where the bottom
  // field is.
  double order = 1;

  // Nothing where too little moves, or what moves does not say.
  std::optional<bool> interlaced() const;
  std::optional<bool> top_field_first() const;
};

// Sums it up, picture by picture.
class CombMeter {
 public:
  // Of grey pictures of one size; others are passed over.
  void Add(const ImageView& picture);
  CombEvidence evidence() const;

 private:
  struct Sums {
    std::int64_t moving = 0;
    double change = 0, beside = 0, two_away = 0;
    double top_then_bottom = 0, bottom_then_top = 0;
  };
  void Compare(const std::vector<std::uint8_t>& next);
  // `changes`: of row y, those of the rows beside it before and behind.
  void CompareRow(const std::vector<std::uint8_t>& next, const std::int16_t* changes, int threshold,
                  int y);

  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> last_;  // grey levels
  Sums sums_;
};

}  // namespace articap
