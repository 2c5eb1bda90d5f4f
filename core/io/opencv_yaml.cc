// SPDX-License-Identifier: MIT
#include "core/io/opencv_yaml.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "core/io/text.h"

namespace articap {
namespace {

bool IsIndented(std::string_view line) { return line.starts_with(' ') || line.starts_with('\t'); }

// Whether a line carries nothing: blank, a comment, a directive, or the mark of a document.
bool IsEmpty(std::string_view line) {
  const std::string_view text = Trim(line);
  return text.empty() || text.starts_with('#') || line.starts_with('%') || text == "---" ||
         text == "...";
}

// "key: value" -> both, or nothing.
std::optional<std::pair<std::string, std::string>> SplitKey(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || colon == 0) return std::nullopt;
  if (colon + 1 < line.size() && line[colon + 1] != ' ' && line[colon + 1] != '\t')
    return std::nullopt;
  return std::pair{std::string(Trim(line.substr(0, colon))),
                   std::string(Trim(line.substr(colon + 1)))};
}

// Without quotes; within double ones a backslash stands before what would end or begin one.
std::string Unquoted(const std::string& text) {
  const bool is_quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                         text.back() == text.front();
  if (!is_quoted) return text;
  std::string plain;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text.front() == '"' && text[i] == '\\' && i + 2 < text.size()) ++i;
    plain += text[i];
  }
  return plain;
}

// A number as YAML writes it: never with a decimal comma.
std::optional<double> NumberIn(std::string_view text) {
  if (text.find(',') != std::string_view::npos) return std::nullopt;
  return ParseNumber(text);
}

// The numbers between [ and ], which may be on several lines; nothing where that is not all.
std::optional<std::vector<double>> NumbersIn(std::string_view list, int most_values) {
  list = Trim(list);
  if (!list.starts_with('[') || !list.ends_with(']')) return std::nullopt;
  list = list.substr(1, list.size() - 2);
  std::vector<double> numbers;
  while (static_cast<int>(numbers.size()) <= most_values) {
    const std::size_t comma = list.find(',');
    std::string_view cell = list.substr(0, comma);
    while (!cell.empty() && cell.front() <= ' ') cell.remove_prefix(1);
    while (!cell.empty() && cell.back() <= ' ') cell.remove_suffix(1);
    const auto number = NumberIn(cell);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    if (comma == std::string_view::npos) return numbers;
    list.remove_prefix(comma + 1);
  }
  return std::nullopt;
}

struct MatrixText {
  std::string rows, columns, type = "d", data;
};

// The fields of a matrix, from the lines below its name.
MatrixText FieldsOf(std::string_view block) {
  MatrixText fields;
  std::string* field = nullptr;
  LineReader lines(block);
  while (const auto line = lines.Next()) {
    if (Trim(*line).empty()) continue;
    // The lines of a list have no keys.
    const bool is_in_list = field == &fields.data && !field->ends_with(']');
    const auto entry = is_in_list ? std::nullopt : SplitKey(Trim(*line));
    if (entry) {
      const std::string& key = entry->first;
      field = key == "rows"   ? &fields.rows
              : key == "cols" ? &fields.columns
              : key == "dt"   ? &fields.type
              : key == "data" ? &fields.data
                              : nullptr;
      if (field) *field = entry->second;
    } else if (field) {
      *field += ' ';
      *field += Trim(*line);
    }
  }
  return fields;
}

std::optional<int> CountIn(const std::string& text) {
  int count = 0;
  const auto end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, count);
  if (read.ec != std::errc() || read.ptr != end || count < 1) return std::nullopt;
  return count;
}

}  // namespace

Result<OpenCvDocument> OpenCvDocument::Parse(std::string_view text,
                                             const std::string& source_name) {
  OpenCvDocument document;
  document.source_name_ = source_name;
  Entry* entry = nullptr;
  LineReader lines(text);
  while (const auto line = lines.Next()) {
    if (IsEmpty(*line)) continue;
    const bool belongs_above = IsIndented(*line) || line->starts_with("- ");
    if (belongs_above && !entry)
      return Fail(fmt::format("{}:{}: an indented line without a name above it", source_name,
                              lines.line_number()));
    if (belongs_above) {
      entry->block += *line;
      entry->block += '\n';
      continue;
    }
    const auto split = SplitKey(*line);
    if (!split)
      return Fail(fmt::format("{}:{}: '{}' is no line of an OpenCV file (name: value)", source_name,
                              lines.line_number(), Printable(*line)));
    const auto [place, is_new] =
        document.entries_.try_emplace(split->first, Entry{lines.line_number(), split->second, ""});
    if (!is_new)
      return Fail(fmt::format("{}:{}: '{}' is there twice", source_name, lines.line_number(),
                              Printable(split->first)));
    entry = &place->second;
  }
  return document;
}

tl::unexpected<Error> OpenCvDocument::FaultIn(const std::string& key,
                                              const std::string& what) const {
  const auto entry = entries_.find(key);
  const int line = entry == entries_.end() ? 0 : entry->second.line;
  return Fail(line == 0 ? fmt::format("{}: '{}' is missing", source_name_, key)
                        : fmt::format("{}:{}: '{}' {}", source_name_, line, key, what));
}

std::string OpenCvDocument::Text(const std::string& key) const {
  const auto entry = entries_.find(key);
  return entry == entries_.end() ? "" : Unquoted(entry->second.value);
}

Result<double> OpenCvDocument::Number(const std::string& key) const {
  const auto number = NumberIn(Text(key));
  if (!number || !std::isfinite(*number)) return FaultIn(key, "is not a finite number");
  return *number;
}

Result<OpenCvMatrix> OpenCvDocument::Matrix(const std::string& key, int most_values) const {
  const auto entry = entries_.find(key);
  if (entry == entries_.end()) return FaultIn(key, "");
  if (!entry->second.value.empty() && entry->second.value != "!!opencv-matrix")
    return FaultIn(key, "is not a matrix");
  const MatrixText fields = FieldsOf(entry->second.block);
  const auto rows = CountIn(fields.rows), columns = CountIn(fields.columns);
  if (!rows || !columns || *rows > most_values || *columns > most_values ||
      *rows * *columns > most_values)
    return FaultIn(key, "has no rows and columns of a matrix that could stand here");
  const std::string type = Unquoted(fields.type);
  if (type != "d" && type != "f") return FaultIn(key, "does not hold plain numbers (dt: d)");
  const auto values = NumbersIn(fields.data, most_values);
  if (!values || static_cast<int>(values->size()) != *rows * *columns)
    return FaultIn(key, fmt::format("does not hold {} numbers as its data", *rows * *columns));
  for (const double value : *values)
    if (!std::isfinite(value)) return FaultIn(key, "holds a number that is not finite");
  return OpenCvMatrix{*rows, *columns, *values};
}

}  // namespace articap
