// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace articap {

// Blanks and NULs off both ends.
std::string_view Trim(std::string_view text);
// ASCII only.
std::string ToLower(std::string_view text);
// One line without control characters, trimmed, cut to `max_bytes` between UTF-8 characters: fit
// for any format's text.
std::string CleanText(std::string_view text, std::size_t max_bytes = 255);
bool IsUtf8(std::string_view bytes);
// For messages: cut to a line's length, control characters as '?'.
std::string Printable(std::string_view text);

// The whole of `text` as a decimal number, independent of the locale; "," is taken as a decimal
// point too. Correctly rounded.
std::optional<double> ParseNumber(std::string_view text);

// Appends with a fixed number of decimals, kDecimals, without "-0".
void AppendFixed(double value, std::string& out);
inline constexpr int kDecimals = 4;  // 0.1 um, far below what any capture system resolves
// The same value with the decimals that times have (1 us).
void AppendSeconds(double value_s, std::string& out);
// The shortest text that reads back as the same number, with at least two decimals ("60.00").
std::string FormatRate(double rate_hz);

// The lines of a text, without their ends (LF, CRLF, or CR alone) and without a byte-order mark.
class LineReader {
 public:
  explicit LineReader(std::string_view text);
  std::optional<std::string_view> Next();
  // Number of the line that Next() returned last, from 1.
  int line_number() const { return line_number_; }
  // Whether the line that Next() returned last had an end. The last line of a file that was cut
  // short has none.
  bool line_was_ended() const { return line_was_ended_; }

 private:
  std::string_view rest_;
  char end_of_line_ = '\n';
  int line_number_ = 0;
  bool line_was_ended_ = true;
};

// The cells of a line, trimmed; quotes around a cell are taken off ("" inside is one quote). A
// delimiter of ' ' stands for runs of blanks.
std::vector<std::string> SplitCells(std::string_view line, char delimiter);
// A cell for a CSV file, quoted where it needs to be.
std::string QuoteCell(std::string_view cell, char delimiter);
// Tab, comma, semicolon or runs of blanks, whichever the line has, in this order.
char GuessDelimiter(std::string_view line);

}  // namespace articap
