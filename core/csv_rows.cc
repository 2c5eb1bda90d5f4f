// SPDX-License-Identifier: MIT
#include "core/csv_rows.h"

#include <fmt/format.h>

#include <algorithm>

namespace articap {

CsvRows::CsvRows(std::string_view text, std::string source_name)
    : text_(text), source_name_(std::move(source_name)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

std::string CsvRows::Where() const { return fmt::format("{}:{}", source_name_, row_line_); }

std::size_t CsvRows::CountLinesLeft() const {
  return static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(position_),
                                             text_.end(), '\n')) +
         1;
}

Result<bool> CsvRows::Next(std::vector<std::string_view>& cells) {
  cells.clear();
  while (position_ < text_.size() && (text_[position_] == '\n' || text_[position_] == '\r'))
    line_ += text_[position_++] == '\n';
  row_line_ = line_;
  if (position_ >= text_.size()) return false;
  while (true) {
    std::string_view cell;
    if (position_ < text_.size() && text_[position_] == '"') {
      const auto quoted = QuotedCell(cells.size());
      if (!quoted) return tl::unexpected(quoted.error());
      cell = *quoted;
    } else {
      const std::size_t begin = position_;
      position_ = std::min(text_.find_first_of(",\n", begin), text_.size());
      cell = text_.substr(begin, position_ - begin);
      if (cell.ends_with('\r')) cell.remove_suffix(1);
    }
    cells.push_back(cell);
    if (position_ >= text_.size()) return true;
    if (text_[position_++] == '\n') {
      ++line_;
      return true;
    }
  }
}

Result<std::string_view> CsvRows::QuotedCell(std::size_t cell_index) {
  while (unquoted_.size() <= cell_index) unquoted_.emplace_back();
  std::string& cell = unquoted_[cell_index];
  cell.clear();
  while (true) {
    const std::size_t begin = ++position_;
    const std::size_t quote = text_.find('"', begin);
    if (quote == std::string_view::npos)
      return Fail(fmt::format("{}: a quoted cell does not end; close its quotes", Where()));
    cell.append(text_, begin, quote - begin);
    position_ = quote + 1;
    if (position_ < text_.size() && text_[position_] == '"')
      cell += '"';
    else
      break;
  }
  line_ += static_cast<int>(std::count(cell.begin(), cell.end(), '\n'));
  if (text_.substr(position_).starts_with("\r\n")) ++position_;
  if (position_ < text_.size() && text_[position_] != ',' && text_[position_] != '\n')
    return Fail(
        fmt::format("{}: text follows a closing quote; double the quotes inside a cell", Where()));
  return std::string_view(cell);
}

std::string CsvCell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c;
  }
  return cell + "\"";
}

}  // namespace articap
