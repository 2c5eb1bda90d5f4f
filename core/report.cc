// SPDX-License-Identifier: MIT
#include "core/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/version.h"

namespace articap {
namespace {

using Json = nlohmann::ordered_json;

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json TableToJson(const ReportTable& table) {
  Json rows = Json::object();
  for (const ReportTable::Row& row : table.rows) {
    Json cells = Json::object();
    for (std::size_t i = 0; i < table.columns.size() && i < row.values.size(); ++i)
      cells[table.columns[i]] = NumberOrNull(row.values[i]);
    rows[row.label] = std::move(cells);
  }
  return rows;
}

Json ReportToJson(const StageReport& report) {
  Json json;
  json["stage"] = report.stage;
  json["articap_version"] = kVersion;
  json["usable"] = report.usable;
  json["verdict"] = report.verdict;
  json["warnings"] = report.warnings;
  json["figures"] = Json::object();
  for (const auto& [name, value] : report.figures) json["figures"][name] = NumberOrNull(value);
  json["texts"] = Json::object();
  for (const auto& [name, value] : report.texts) json["texts"][name] = value;
  json["tables"] = Json::object();
  for (const ReportTable& table : report.tables) json["tables"][table.name] = TableToJson(table);
  json["options"] = Json::object();
  for (const auto& [name, value] : report.options) json["options"][name] = value;
  return json;
}

// Marker names read from files may hold any bytes; the report replaces what is not UTF-8.
std::string Dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string FormatNumber(double value) {
  if (!std::isfinite(value)) return "-";
  // Counts, frame numbers and long times are not rounded.
  if (value == std::round(value) && std::abs(value) < 1e15)
    return fmt::format("{:.0f}", value + 0.0);
  return fmt::format(fmt::runtime(std::abs(value) < 1e4 ? "{:.5g}" : "{:.3f}"), value);
}

std::string FormatTable(const ReportTable& table, int max_rows) {
  std::size_t label_width = table.name.size();
  for (const ReportTable::Row& row : table.rows)
    label_width = std::max(label_width, row.label.size());
  std::string text = fmt::format("  {:<{}}", table.name, label_width);
  for (const std::string& column : table.columns) text += fmt::format("  {:>10}", column);
  text += "\n";
  const int num_rows = static_cast<int>(table.rows.size());
  for (int i = 0; i < std::min(num_rows, max_rows); ++i) {
    const ReportTable::Row& row = table.rows[i];
    text += fmt::format("  {:<{}}", row.label, label_width);
    for (std::size_t k = 0; k < row.values.size(); ++k) {
      const std::size_t width =
          std::max<std::size_t>(10, k < table.columns.size() ? table.columns[k].size() : 0);
      text += fmt::format("  {:>{}}", FormatNumber(row.values[k]), width);
    }
    text += "\n";
  }
  if (num_rows > max_rows) text += fmt::format("  ... {} more\n", num_rows - max_rows);
  return text;
}

}  // namespace

std::string StageReport::BriefReport(int max_table_rows) const {
  std::string text = fmt::format("{}: {}\n", stage, verdict);
  std::size_t width = 0;
  for (const auto& [name, value] : figures) width = std::max(width, name.size());
  for (const auto& [name, value] : texts) width = std::max(width, name.size());
  for (const auto& [name, value] : texts) text += fmt::format("  {:<{}}  {}\n", name, width, value);
  for (const auto& [name, value] : figures)
    text += fmt::format("  {:<{}}  {}\n", name, width, FormatNumber(value));
  if (max_table_rows > 0)
    for (const ReportTable& table : tables) text += FormatTable(table, max_table_rows);
  for (const std::string& warning : warnings) text += fmt::format("  warning: {}\n", warning);
  return text;
}

std::string StageReport::ToJson() const { return Dump(ReportToJson(*this)); }

std::string ReportsToJson(const std::vector<StageReport>& reports) {
  Json json;
  for (const StageReport& report : reports) json[report.stage] = ReportToJson(report);
  return Dump(json);
}

}  // namespace articap
