// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace articap {

// A table of numbers of a report, such as residuals per marker. Column names end in their unit.
struct ReportTable {
  std::string name;
  std::vector<std::string> columns;
  struct Row {
    std::string label;
    std::vector<double> values;  // NaN prints as "-" and becomes null in JSON
  };
  std::vector<Row> rows;
};

// What a stage did, written beside every result: nothing is dropped, repaired or clamped without a
// figure or a warning here.
struct StageReport {
  std::string stage;    // "stabilize", "bind", "fit", ...
  bool usable = true;   // may the next stage rely on the result?
  std::string verdict;  // one sentence in plain words; says what to do where it is not usable
  std::vector<std::pair<std::string, double>> figures;     // name with unit -> value
  std::vector<std::pair<std::string, std::string>> texts;  // names, choices, files
  std::vector<ReportTable> tables;
  std::vector<std::string> warnings;
  std::vector<std::pair<std::string, std::string>> options;  // as used, defaults included

  bool IsUsable() const { return usable; }
  // A few lines for a terminal: the verdict, the figures and the warnings; tables up to
  // `max_table_rows` rows.
  std::string BriefReport(int max_table_rows = 50) const;
  // UTF-8 JSON, keys in the order given, with articap's version.
  std::string ToJson() const;
};

// A stage's output with its report.
template <class Output>
struct StageResult {
  Output output;
  StageReport report;
};

// A JSON object of several reports under their stages' names.
std::string ReportsToJson(const std::vector<StageReport>& reports);

}  // namespace articap
