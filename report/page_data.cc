// SPDX-License-Identifier: MIT
#include "report/page_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/check.h"
#include "core/parameter_units.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json TableData(const ReportTable& table) {
  Json rows = Json::array();
  for (const ReportTable::Row& row : table.rows) {
    Json values = Json::array();
    for (const double value : row.values) values.push_back(NumberOrNull(value));
    rows.push_back({{"label", row.label}, {"values", std::move(values)}});
  }
  return {{"name", table.name}, {"columns", table.columns}, {"rows", std::move(rows)}};
}

// One plotted series: {"low"} alone where a point is a frame, else {"low", "high"}.
Json SeriesData(std::span<const double> values, int frames_per_point) {
  const Envelope envelope = EnvelopeOf(values, frames_per_point);
  Json series = {{"low", Quantized(envelope.low)}};
  if (frames_per_point > 1) series["high"] = Quantized(envelope.high);
  return series;
}

// Runs of equal codes: [first frame, code, first frame, code, ...]. Where there would be too many
// for the page, one code stands for every few frames: the largest of them.
Json RunsOf(const std::vector<int>& codes) {
  constexpr std::size_t kMostRuns = 60'000;
  std::size_t num_runs = codes.empty() ? 0 : 1;
  for (std::size_t i = 1; i < codes.size(); ++i) num_runs += codes[i] != codes[i - 1];
  const std::size_t step = num_runs <= kMostRuns ? 1 : (codes.size() + kMostRuns - 1) / kMostRuns;
  Json runs = Json::array();
  int before = -1;
  for (std::size_t i = 0; i < codes.size(); i += step) {
    const auto begin = codes.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(step, codes.size() - i));
    const int code = *std::max_element(begin, end);
    if (code == before) continue;
    runs.push_back(i);
    runs.push_back(code);
    before = code;
  }
  return runs;
}

double Percentile(std::vector<float>& values, double fraction) {
  const std::size_t rank =
      std::min(values.size() - 1,
               static_cast<std::size_t>(std::floor(fraction * static_cast<double>(values.size()))));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

Json MarkerStatistics(const std::string& name, const Eigen::VectorXf& distances_mm) {
  std::vector<float> seen;
  double sum = 0;
  double sum_of_squares = 0;
  for (const float distance : distances_mm) {
    if (!std::isfinite(distance)) continue;
    seen.push_back(distance);
    sum += distance;
    sum_of_squares += static_cast<double>(distance) * distance;
  }
  Json statistics = {{"name", name}, {"count", seen.size()}};
  const double count = static_cast<double>(seen.size());
  statistics["rms_mm"] = NumberOrNull(std::sqrt(sum_of_squares / count));
  statistics["mean_mm"] = NumberOrNull(sum / count);
  statistics["p95_mm"] = seen.empty() ? Json(nullptr) : Json(Percentile(seen, 0.95));
  statistics["max_mm"] =
      seen.empty() ? Json(nullptr) : Json(*std::max_element(seen.begin(), seen.end()));
  return statistics;
}

// Marker by marker, the largest distance in every column of frames, in 254 steps; 255 where the
// marker was not used.
std::vector<std::uint8_t> HeatOf(const MarkerResiduals& residuals, int frames_per_column,
                                 double mm_per_step) {
  constexpr std::uint8_t kUnused = 255;
  const int num_frames = static_cast<int>(residuals.distances_mm.rows());
  std::vector<std::uint8_t> heat;
  for (int marker = 0; marker < residuals.distances_mm.cols(); ++marker)
    for (int begin = 0; begin < num_frames; begin += frames_per_column) {
      const int count = std::min(frames_per_column, num_frames - begin);
      float largest = -1;
      for (const float distance : residuals.distances_mm.col(marker).segment(begin, count))
        if (distance > largest && std::isfinite(distance)) largest = distance;
      heat.push_back(largest < 0 ? kUnused
                                 : static_cast<std::uint8_t>(
                                       std::min(254.0, std::round(largest / mm_per_step))));
    }
  return heat;
}

}  // namespace

int FramesPerPoint(int num_frames, int num_series) {
  // Two bytes a value: 4 MB in all, 5.4 MB in base64.
  constexpr std::int64_t kMostValues = 2'000'000;
  const std::int64_t num_values = static_cast<std::int64_t>(num_frames) * num_series;
  if (num_values <= kMostValues) return 1;
  // A bucket keeps its least and its largest.
  return static_cast<int>((2 * num_values + kMostValues - 1) / kMostValues);
}

FrameWindow DefaultWindow(const ParameterTrack& track) {
  constexpr double kUsualSeconds = 10;
  int first = 0;
  while (first < track.num_frames() && !track.values.row(first).allFinite()) ++first;
  if (first == track.num_frames()) first = 0;
  const double count = std::max(1.0, std::round(kUsualSeconds * track.rate_hz));
  const int left = track.num_frames() - first;
  return {first, count < left ? static_cast<int>(count) : left};
}

Json StagesData(const std::vector<StageReport>& reports) {
  Json stages = Json::array();
  for (const StageReport& report : reports) {
    Json stage = {{"stage", report.stage},
                  {"usable", report.usable},
                  {"verdict", report.verdict},
                  {"warnings", report.warnings}};
    stage["figures"] = Json::array();
    for (const auto& [name, value] : report.figures)
      stage["figures"].push_back({{"name", name}, {"value", NumberOrNull(value)}});
    for (const auto& [key, entries] :
         {std::pair("texts", &report.texts), std::pair("options", &report.options)}) {
      stage[key] = Json::array();
      for (const auto& [name, value] : *entries)
        stage[key].push_back({{"name", name}, {"value", value}});
    }
    stage["tables"] = Json::array();
    for (const ReportTable& table : report.tables) stage["tables"].push_back(TableData(table));
    stages.push_back(std::move(stage));
  }
  return stages;
}

Json TakeData(const ReportPageInput& input) {
  const ParameterTrack& track = *input.parameters;
  return {{"title", input.title},
          {"num_frames", track.num_frames()},
          {"first_frame", track.first_frame},
          {"rate_hz", track.rate_hz},
          {"start_s", SecondsOf(track.start)}};
}

Json ParameterData(const ReportPageInput& input) {
  const ParameterTrack& track = *input.parameters;
  ARTICAP_CHECK(input.ranges.empty() ||
                static_cast<int>(input.ranges.size()) == track.num_parameters());
  const int frames_per_point = FramesPerPoint(track.num_frames(), 2 * track.num_parameters() + 8);
  Json parameters = Json::array();
  for (int i = 0; i < track.num_parameters(); ++i) {
    const FileUnit unit = FileUnitOf(track.units[i]);
    const Eigen::VectorXd values = unit.in_file_per_value * track.values.col(i);
    const Eigen::VectorXd sigmas = unit.in_file_per_value * track.sigmas.col(i);
    Json parameter =
        SeriesData({values.data(), static_cast<std::size_t>(values.size())}, frames_per_point);
    parameter["name"] = track.names[i];
    parameter["unit"] = unit.name;
    if (!input.ranges.empty()) {
      parameter["min"] = NumberOrNull(unit.in_file_per_value * input.ranges[i].min);
      parameter["max"] = NumberOrNull(unit.in_file_per_value * input.ranges[i].max);
      parameter["description"] = input.ranges[i].description;
    }
    parameter["sigma"] = Quantized(
        EnvelopeOf({sigmas.data(), static_cast<std::size_t>(sigmas.size())}, frames_per_point)
            .high);
    parameters.push_back(std::move(parameter));
  }
  Json residual = SeriesData(track.residuals_mm, frames_per_point);
  return {{"frames_per_point", frames_per_point},
          {"parameters", std::move(parameters)},
          {"residual", std::move(residual)}};
}

Json PhoneData(const ParameterTrack& track) {
  std::map<std::string, int> codes;
  for (const std::string& phone : track.phones) codes.emplace(phone, 0);
  Json labels = Json::array();
  for (auto& [label, code] : codes) {
    code = static_cast<int>(labels.size());
    labels.push_back(label);
  }
  std::vector<int> of_frames;
  for (const std::string& phone : track.phones) of_frames.push_back(codes.at(phone));
  return {{"labels", std::move(labels)}, {"runs", RunsOf(of_frames)}};
}

Json StatusData(const ParameterTrack& track) {
  Json labels = Json::array();
  for (const FitStatus status : kAllFitStatuses) labels.push_back(NameOf(status));
  std::vector<int> of_frames;
  for (const FitStatus status : track.statuses) of_frames.push_back(static_cast<int>(status));
  return {{"labels", std::move(labels)}, {"runs", RunsOf(of_frames)}};
}

Json ResidualData(const MarkerResiduals& residuals) {
  constexpr std::int64_t kMostCells = 1'200'000;  // a byte each
  ARTICAP_CHECK_EQ(residuals.names.size(), static_cast<std::size_t>(residuals.distances_mm.cols()));
  const std::int64_t num_cells = residuals.distances_mm.size();
  const int frames_per_column =
      static_cast<int>(std::max<std::int64_t>(1, (num_cells + kMostCells - 1) / kMostCells));
  Json markers = Json::array();
  double largest_mm = 0;
  for (std::size_t i = 0; i < residuals.names.size(); ++i) {
    markers.push_back(MarkerStatistics(residuals.names[i],
                                       residuals.distances_mm.col(static_cast<Eigen::Index>(i))));
    if (markers.back()["max_mm"].is_number())
      largest_mm = std::max(largest_mm, markers.back()["max_mm"].get<double>());
  }
  const double mm_per_step = largest_mm > 0 ? largest_mm / 254 : 1;
  const std::vector<std::uint8_t> heat = HeatOf(residuals, frames_per_column, mm_per_step);
  return {{"markers", std::move(markers)},
          {"frames_per_column", frames_per_column},
          {"mm_per_step", mm_per_step},
          {"heat", Base64Of(std::span<const std::uint8_t>(heat))}};
}

// Movement since the first known pose, in the axes of the head in that pose: displacement of the
// head's origin in mm, rotation vector in degrees.
Json HeadPoseData(const HeadPoseTrack& head_pose, const ParameterTrack& track) {
  const std::size_t num_frames = static_cast<std::size_t>(track.num_frames());
  const int frames_per_point = FramesPerPoint(track.num_frames(), 2 * track.num_parameters() + 8);
  std::vector<std::vector<double>> columns(7, std::vector<double>(num_frames, kNaN));
  const Rigid3d* reference = nullptr;
  for (std::size_t i = 0; i < num_frames; ++i) {
    const std::int64_t index =
        static_cast<std::int64_t>(i) + track.first_frame - head_pose.first_frame;
    if (index < 0 || index >= static_cast<std::int64_t>(head_pose.poses.size())) continue;
    const HeadPose& pose = head_pose.poses[static_cast<std::size_t>(index)];
    if (!pose.is_known()) continue;
    if (!reference) reference = &pose.head_from_stage;
    const Rigid3d first_from_now = *reference * pose.head_from_stage.Inverse();
    const Eigen::AngleAxisd turn(first_from_now.rotation);
    for (int k = 0; k < 3; ++k) {
      columns[k][i] = first_from_now.translation_mm[k];
      columns[3 + k][i] = kDegreesPerRadian * turn.angle() * turn.axis()[k];
    }
    columns[6][i] = pose.residual_mm;
  }
  Json data = {{"mode", NameOf(head_pose.mode)}, {"frames_per_point", frames_per_point}};
  data["columns"] = Json::array();
  for (const std::vector<double>& column : columns)
    data["columns"].push_back(SeriesData(column, frames_per_point));
  return data;
}

}  // namespace articap
