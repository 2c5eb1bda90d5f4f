// SPDX-License-Identifier: MIT
#include "calib/corner_grid.h"

#include <algorithm>
#include <cmath>

namespace articap {
namespace {

CornerGrid Transposed(const CornerGrid& grid) {
  CornerGrid turned{grid.rows, grid.columns, {}};
  for (int row = 0; row < turned.rows; ++row)
    for (int column = 0; column < turned.columns; ++column)
      turned.points_px.push_back(grid.at(row, column));
  return turned;
}

// Every row backwards.
CornerGrid Flipped(const CornerGrid& grid) {
  CornerGrid flipped = grid;
  for (int row = 0; row < grid.rows; ++row) {
    const auto first = flipped.points_px.begin() + static_cast<std::ptrdiff_t>(row) * grid.columns;
    std::reverse(first, first + grid.columns);
  }
  return flipped;
}

CornerGrid HalfTurned(CornerGrid grid) {
  std::reverse(grid.points_px.begin(), grid.points_px.end());
  return grid;
}

Eigen::Vector2d RowDirection(const CornerGrid& grid) {
  return grid.at(grid.columns - 1, 0) + grid.at(grid.columns - 1, grid.rows - 1) - grid.at(0, 0) -
         grid.at(0, grid.rows - 1);
}

Eigen::Vector2d ColumnDirection(const CornerGrid& grid) {
  return grid.at(0, grid.rows - 1) + grid.at(grid.columns - 1, grid.rows - 1) - grid.at(0, 0) -
         grid.at(grid.columns - 1, 0);
}

bool IsRightHanded(const CornerGrid& grid) {
  const Eigen::Vector2d x = RowDirection(grid), y = ColumnDirection(grid);
  return x.x() * y.y() - x.y() * y.x() > 0;
}

// The brightness in the middle of a square, by the numbers of the corner at its lower right.
std::optional<double> LevelOf(const CornerGrid& grid, const GrayPicture& picture, int column,
                              int row) {
  const Eigen::Vector2d middle_px = grid.Between(column - 0.5, row - 0.5);
  if (!picture.Contains(middle_px)) return std::nullopt;
  return picture.At(middle_px);
}

// Of the pairs of squares side by side, the part in which the one is darker that should be, with
// square (0, 0) dark.
double PartInOrder(const CornerGrid& grid, const GrayPicture& picture) {
  int pairs = 0, in_order = 0;
  const auto compare = [&](int column, int row, int next_column, int next_row) {
    const auto level = LevelOf(grid, picture, column, row);
    const auto next = LevelOf(grid, picture, next_column, next_row);
    if (!level || !next) return;
    ++pairs;
    const bool is_dark = (column + row) % 2 == 0;
    if (is_dark ? *level < *next : *level > *next) ++in_order;
  };
  for (int row = 0; row <= grid.rows; ++row)
    for (int column = 0; column <= grid.columns; ++column) {
      if (column < grid.columns) compare(column, row, column + 1, row);
      if (row < grid.rows) compare(column, row, column, row + 1);
    }
  return pairs == 0 ? 0 : static_cast<double>(in_order) / pairs;
}

}  // namespace

Eigen::Vector2d CornerGrid::Between(double column, double row) const {
  const int i = std::clamp(static_cast<int>(std::floor(column)), 0, columns - 2);
  const int j = std::clamp(static_cast<int>(std::floor(row)), 0, rows - 2);
  const double u = column - i, v = row - j;
  return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
         v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
}

std::optional<CornerGrid> InBoardOrder(const CornerGrid& grid, const GrayPicture& picture) {
  // A finger over a square, or a highlight, spoils four pairs.
  constexpr double kLeastPart = 0.9;
  const CornerGrid upright = IsRightHanded(grid) ? grid : Flipped(grid);
  std::vector<CornerGrid> orders = {upright, HalfTurned(upright)};
  if (grid.columns == grid.rows) {
    orders.push_back(Flipped(Transposed(upright)));
    orders.push_back(HalfTurned(orders.back()));
  }
  std::optional<CornerGrid> best;
  for (const CornerGrid& order : orders) {
    if (PartInOrder(order, picture) < kLeastPart) continue;
    if (!best || RowDirection(order).x() > RowDirection(*best).x()) best = order;
  }
  return best;
}

bool GoesOn(const CornerGrid& grid, const GrayPicture& picture) {
  // The row of squares beyond one of the four sides, beside the outermost of the board.
  const auto side_goes_on = [&](int count, const auto& outer_level, const auto& beyond_level) {
    int seen = 0, alternating = 0;
    for (int i = 0; i + 1 <= count; ++i) {
      const auto outer = outer_level(i), outer_next = outer_level(i + 1);
      const auto beyond = beyond_level(i), beyond_next = beyond_level(i + 1);
      if (!outer || !outer_next || !beyond || !beyond_next) continue;
      ++seen;
      // Half the contrast at least, the other way round.
      if ((*beyond - *beyond_next) / (*outer - *outer_next) < -0.5) ++alternating;
    }
    return 2 * seen > count && alternating >= 0.9 * seen;
  };
  const auto level = [&](int column, int row) { return LevelOf(grid, picture, column, row); };
  const int columns = grid.columns, rows = grid.rows;
  return side_goes_on(
             columns, [&](int i) { return level(i, 0); }, [&](int i) { return level(i, -1); }) ||
         side_goes_on(
             columns, [&](int i) { return level(i, rows); },
             [&](int i) { return level(i, rows + 1); }) ||
         side_goes_on(
             rows, [&](int i) { return level(0, i); }, [&](int i) { return level(-1, i); }) ||
         side_goes_on(
             rows, [&](int i) { return level(columns, i); },
             [&](int i) { return level(columns + 1, i); });
}

}  // namespace articap
