// SPDX-License-Identifier: MIT
#include "core/board.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace articap {
namespace {

constexpr const char* kExamples =
    "write chessboard:9x6:25 (inner corners, square in mm) or charuco:7x5:12:9 (squares, square "
    "and marker in mm)";
constexpr const char* kDefaultDictionary = "DICT_5X5_250";
constexpr int kMostSquares = 200;
constexpr double kLargestSquare_mm = 1000;

std::vector<std::string_view> Split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    parts.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

template <class Number>
std::optional<Number> NumberOf(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// "9x6"
std::optional<std::pair<int, int>> CountsOf(std::string_view text) {
  const std::vector<std::string_view> parts = Split(text, 'x');
  if (parts.size() != 2) return std::nullopt;
  const int columns = NumberOf<int>(parts[0]).value_or(0);
  const int rows = NumberOf<int>(parts[1]).value_or(0);
  if (std::min(columns, rows) < 3 || std::max(columns, rows) > kMostSquares) return std::nullopt;
  return std::pair(columns, rows);
}

std::optional<double> LengthOf_mm(std::string_view text) {
  const std::optional<double> length_mm = NumberOf<double>(text);
  if (!length_mm || !(*length_mm > 0) || !(*length_mm <= kLargestSquare_mm)) return std::nullopt;
  return length_mm;
}

tl::unexpected<Error> Refuse(std::string_view text, std::string_view why) {
  return Fail(fmt::format("board '{}': {}; {}", text, why, kExamples));
}

}  // namespace

bool BoardSpec::is_ambiguous() const {
  // Turned about its middle, square (r, c) comes to lie on (rows - 1 - r, columns - 1 - c): of the
  // same colour where rows + columns is even. Markers tell the ends apart.
  return kind == BoardKind::kChessboard && (square_columns() + square_rows()) % 2 == 0;
}

Result<BoardSpec> ParseBoardSpec(std::string_view text) {
  const std::vector<std::string_view> parts = Split(text, ':');
  BoardSpec board;
  if (parts[0] == "charuco")
    board.kind = BoardKind::kCharuco;
  else if (parts[0] != "chessboard")
    return Refuse(text, fmt::format("'{}' is no kind of board", parts[0]));
  const bool is_charuco = board.kind == BoardKind::kCharuco;
  const std::size_t most = is_charuco ? 5 : 3;
  if (parts.size() < (is_charuco ? 4U : 3U) || parts.size() > most)
    return Refuse(text, fmt::format("has {} parts between its colons", parts.size()));

  const auto counts = CountsOf(parts[1]);
  if (!counts)
    return Refuse(text,
                  fmt::format("'{}' is no COLUMNSxROWS, each 3 to {}", parts[1], kMostSquares));
  const auto square_mm = LengthOf_mm(parts[2]);
  if (!square_mm)
    return Refuse(text, fmt::format("'{}' is no length in mm above 0, at most {}", parts[2],
                                    kLargestSquare_mm));
  board.columns = counts->first;
  board.rows = counts->second;
  board.square_mm = *square_mm;
  if (!is_charuco) return board;

  const auto marker_mm = LengthOf_mm(parts[3]);
  if (!marker_mm || *marker_mm >= *square_mm)
    return Refuse(text, fmt::format("'{}' is no marker side in mm below the square's {}", parts[3],
                                    *square_mm));
  board.marker_mm = *marker_mm;
  board.dictionary = parts.size() == 5 ? std::string(parts[4]) : kDefaultDictionary;
  return board;
}

std::string NameOf(const BoardSpec& board) {
  if (board.kind == BoardKind::kChessboard)
    return fmt::format("chessboard:{}x{}:{}", board.columns, board.rows, board.square_mm);
  return fmt::format("charuco:{}x{}:{}:{}:{}", board.columns, board.rows, board.square_mm,
                     board.marker_mm, board.dictionary);
}

BoardPattern SquaresOf(const BoardSpec& board) {
  const double side_mm = board.square_mm;
  const auto corner = [&](double column, double row) {
    return Eigen::Vector2d{side_mm * column, side_mm * row};
  };
  BoardPattern pattern;
  pattern.paper = {corner(-2, -2), corner(board.corner_columns() + 1, board.corner_rows() + 1)};
  for (int row = 0; row < board.square_rows(); ++row)
    for (int column = row % 2; column < board.square_columns(); column += 2)
      pattern.dark.push_back({corner(column - 1, row - 1), corner(column, row)});
  return pattern;
}

}  // namespace articap
