// SPDX-License-Identifier: MIT
#include "core/io/text.h"

#include <fmt/format.h>
#include <unicode/unistr.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace articap {
namespace {

constexpr std::array<double, 23> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr std::uint64_t kExactIntegers = 1ULL << 53;  // below, every integer is a double

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\0'; }

// Digits and one point make an exact integer over an exact power of ten: one correctly rounded
// division (Clinger's fast path). Nothing where that does not hold.
std::optional<double> ParsePlainDecimal(std::string_view text) {
  const bool negative = text.front() == '-';
  std::size_t at = negative ? 1 : 0;
  std::uint64_t digits = 0;
  int num_digits = 0;
  int num_decimals = -1;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c >= '0' && c <= '9') {
      digits = digits * 10 + static_cast<std::uint64_t>(c - '0');
      ++num_digits;
      if (num_decimals >= 0) ++num_decimals;
    } else if ((c == '.' || c == ',') && num_decimals < 0) {
      num_decimals = 0;
    } else {
      return std::nullopt;
    }
  }
  if (num_digits == 0 || num_digits > 18 || digits >= kExactIntegers) return std::nullopt;
  const double value = static_cast<double>(digits) / kPowersOfTen[std::max(num_decimals, 0)];
  return negative ? -value : value;
}

// `value` times 10^decimals must be below 2^52.
void AppendScaled(double value, int decimals, std::string& out) {
  const std::int64_t scaled = std::llround(value * kPowersOfTen[decimals]);
  std::array<char, 32> buffer;
  char* at = buffer.data() + buffer.size();
  auto rest = static_cast<std::uint64_t>(std::abs(scaled));
  for (int i = 0; i < decimals; ++i, rest /= 10) *--at = static_cast<char>('0' + rest % 10);
  *--at = '.';
  do *--at = static_cast<char>('0' + rest % 10);
  while ((rest /= 10) != 0);
  if (scaled < 0) *--at = '-';
  out.append(at, static_cast<std::size_t>(buffer.data() + buffer.size() - at));
}

void AppendDecimals(double value, int decimals, std::string& out) {
  constexpr double kLargest = 4e15;  // below 2^52
  if (std::abs(value) * kPowersOfTen[decimals] < kLargest)
    AppendScaled(value, decimals, out);
  else
    fmt::format_to(std::back_inserter(out), "{:.{}f}", value, decimals);
}

}  // namespace

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string ToLower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string CleanText(std::string_view text, std::size_t max_bytes) {
  std::string clean(text);
  for (char& c : clean)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  std::string_view trimmed = Trim(clean);
  if (trimmed.size() > max_bytes) {
    std::size_t end = max_bytes;
    while (end > 0 && (static_cast<unsigned char>(trimmed[end]) & 0xC0) == 0x80) --end;
    trimmed = Trim(trimmed.substr(0, end));
  }
  return std::string(trimmed);
}

bool IsUtf8(std::string_view bytes) {
  // ICU replaces what is not UTF-8; text that comes back the same was UTF-8.
  std::string back;
  icu::UnicodeString::fromUTF8({bytes.data(), static_cast<int32_t>(bytes.size())})
      .toUTF8String(back);
  return back == bytes;
}

std::string Printable(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string printable(text.substr(0, kLongest));
  for (char& c : printable)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  if (text.size() > kLongest) printable += "...";
  return printable;
}

std::optional<double> ParseNumber(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  if (text.empty()) return std::nullopt;
  if (const auto plain = ParsePlainDecimal(text)) return plain;
  std::string with_point;
  if (text.find(',') != std::string_view::npos) {
    with_point.assign(text);
    std::replace(with_point.begin(), with_point.end(), ',', '.');
    text = with_point;
  }
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end) return std::nullopt;
  // Too large or too small for a double: from_chars leaves the value alone.
  if (error == std::errc::result_out_of_range) {
    const std::size_t exponent = text.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos && exponent + 1 < text.size() &&
                      text[exponent + 1] == '-';
    return tiny ? 0.0 : (text.front() == '-' ? -HUGE_VAL : HUGE_VAL);
  }
  if (error != std::errc()) return std::nullopt;
  return value;
}

void AppendFixed(double value, std::string& out) { AppendDecimals(value, kDecimals, out); }

void AppendSeconds(double value_s, std::string& out) { AppendDecimals(value_s, 6, out); }

std::string FormatRate(double rate_hz) {
  std::string text = fmt::format("{}", rate_hz);
  if (text.find_first_of("en") != std::string::npos) return text;
  const std::size_t point = text.find('.');
  if (point == std::string::npos) return text + ".00";
  if (point + 2 == text.size()) text += "0";
  return text;
}

LineReader::LineReader(std::string_view text) : rest_(text) {
  if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  if (rest_.find('\n') == std::string_view::npos) end_of_line_ = '\r';
}

std::optional<std::string_view> LineReader::Next() {
  if (rest_.empty()) return std::nullopt;
  const std::size_t end = rest_.find(end_of_line_);
  line_was_ended_ = end != std::string_view::npos;
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(line_was_ended_ ? end + 1 : rest_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++line_number_;
  return line;
}

std::vector<std::string> SplitCells(std::string_view line, char delimiter) {
  std::vector<std::string> cells;
  if (delimiter == ' ') {
    while (!(line = Trim(line)).empty()) {
      const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
      cells.emplace_back(line.substr(0, end));
      line.remove_prefix(end);
    }
    return cells;
  }
  std::string cell;
  bool quoted = false;
  for (std::size_t at = 0; at <= line.size(); ++at) {
    const char c = at < line.size() ? line[at] : delimiter;
    if (c == '"' && quoted && at + 1 < line.size() && line[at + 1] == '"') {
      cell += line[++at];
    } else if (c == '"' && (quoted || Trim(cell).empty())) {
      quoted = !quoted;
    } else if (c == delimiter && (!quoted || at == line.size())) {
      cells.emplace_back(Trim(cell));
      cell.clear();
      quoted = false;
    } else {
      cell += c;
    }
  }
  return cells;
}

std::string QuoteCell(std::string_view cell, char delimiter) {
  if (cell.find(delimiter) == std::string_view::npos && cell.find('"') == std::string_view::npos)
    return std::string(cell);
  std::string quoted = "\"";
  for (const char c : cell) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

char GuessDelimiter(std::string_view line) {
  for (const char delimiter : {'\t', ',', ';'})
    if (line.find(delimiter) != std::string_view::npos) return delimiter;
  return ' ';
}

}  // namespace articap
