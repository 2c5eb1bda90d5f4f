// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace articap {

// Rows of a comma-separated text (RFC 4180: quoted cells, doubled quotes, line ends LF or CRLF; a
// byte order mark is passed over). A cell is a view into the text, or into the reader where quotes
// had to be taken off, and holds until the next row is read.
class CsvRows {
 public:
  CsvRows(std::string_view text, std::string source_name);

  // The next row that is not blank; false at the end of the text. Fails on quotes that do not
  // close, and on anything between a closing quote and the next comma.
  Result<bool> Next(std::vector<std::string_view>& cells);

  // "file.csv:12", the line on which the current row begins.
  std::string Where() const;
  int line() const { return row_line_; }
  // Rows that can follow at most.
  std::size_t CountLinesLeft() const;

 private:
  Result<std::string_view> QuotedCell(std::size_t cell_index);

  std::string_view text_;
  std::string source_name_;
  std::size_t position_ = 0;
  int line_ = 1;
  int row_line_ = 0;
  // Of the current row; a deque, since views into it must hold while it grows.
  std::deque<std::string> unquoted_;
};

// The cell as it stands in a file: quoted where it holds a comma, a quote or a line end.
std::string CsvCell(std::string_view text);

}  // namespace articap
