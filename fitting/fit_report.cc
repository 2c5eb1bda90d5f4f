// SPDX-License-Identifier: MIT
#include "fitting/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "core/statistics.h"
#include "fitting/displaced_markers.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A parameter that rests at a bound for more than this part of the take deserves a word.
constexpr double kOftenAtBound = 0.05;

// Median length of a vector of three normal deviates, in their sigmas.
constexpr double kMedianLength = 1.5382;

// Of the movement, %; on real faces bound well the rig explains nine tenths.
constexpr double kLittleExplained = 75;

// Residuals this many times larger than the assumed noise deserve a word.
constexpr double kNoisierThanAssumed = 3;

double Mean(const std::vector<double>& values) {
  if (values.empty()) return kNaN;
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double RootMeanSquare(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return values.empty() ? kNaN : std::sqrt(sum / static_cast<double>(values.size()));
}

ReportTable ParameterTable(const ShapeFit& fit, const FaceRig& rig,
                           const std::vector<bool>& determined, StageReport* report) {
  ReportTable table{
      "parameters (deg, mm)", {"min", "max", "mean", "sd", "sigma", "at_bound_%", "held"}, {}};
  for (int k = 0; k < fit.parameters.num_parameters(); ++k) {
    const RigParameter& parameter = rig.definition().parameters[k];
    const double unit = parameter.unit == ParameterUnit::kRadian ? 180 / std::numbers::pi : 1;
    const double touch = 1e-6 * (parameter.max - parameter.min);
    std::vector<double> values, sigmas;
    int at_bound = 0;
    for (int frame = 0; frame < fit.parameters.num_frames(); ++frame) {
      const double value = fit.parameters.values(frame, k);
      if (!std::isfinite(value)) continue;
      values.push_back(unit * value);
      sigmas.push_back(unit * fit.parameters.sigmas(frame, k));
      at_bound += value <= parameter.min + touch || value >= parameter.max - touch;
    }
    if (values.empty()) continue;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double mean = Mean(values);
    std::vector<double> deviations = values;
    for (double& deviation : deviations) deviation -= mean;
    const double part_at_bound = at_bound / static_cast<double>(values.size());
    table.rows.push_back({parameter.name,
                          {*least, *most, mean, RootMeanSquare(deviations), QuantileOf(sigmas, 0.5),
                           100 * part_at_bound, determined[k] ? 0.0 : 1.0}});
    if (determined[k] && part_at_bound > kOftenAtBound)
      report->warnings.push_back(fmt::format(
          "{} rests at a bound of its range in {:.0f} % of the frames: the speaker moves "
          "more than the rig may",
          parameter.name, 100 * part_at_bound));
  }
  return table;
}

ReportTable ResidualTable(const ShapeFit& fit, const ExplainedVariance& explained) {
  ReportTable table{
      "residuals", {"rms_mm", "mean_mm", "p95_mm", "max_mm", "seen_%", "explained_%"}, {}};
  for (int marker = 0; marker < fit.measured.num_markers(); ++marker) {
    std::vector<double> residuals;
    for (Eigen::Index frame = 0; frame < fit.residuals_mm.rows(); ++frame)
      if (const double residual = fit.residuals_mm(frame, marker); std::isfinite(residual))
        residuals.push_back(residual);
    table.rows.push_back(
        {fit.measured.names()[marker],
         {RootMeanSquare(residuals), Mean(residuals), QuantileOf(residuals, 0.95),
          QuantileOf(residuals, 1),
          100.0 * static_cast<double>(residuals.size()) / std::max(1, fit.measured.num_frames()),
          100 * explained.per_marker[marker]}});
  }
  return table;
}

// Standard deviation of a marker's coordinate, mm of the speaker, from the median residual and the
// freedom that the parameters leave to the residuals; nothing where they leave next to none.
std::optional<double> MarkerSigma_mm(const Eigen::MatrixXf& residuals_mm,
                                     const Eigen::MatrixXd& unit_sigmas) {
  constexpr double kLeastFreedom = 0.05;  // of all numbers
  std::vector<double> lengths;
  double numbers = 0, freedom = 0;
  for (Eigen::Index frame = 0; frame < residuals_mm.rows(); ++frame) {
    int seen = 0;
    for (const float residual : residuals_mm.row(frame))
      if (std::isfinite(residual)) {
        lengths.push_back(residual);
        ++seen;
      }
    const auto free = unit_sigmas.row(frame).array().isFinite().count();
    numbers += 3 * seen;
    freedom += std::max(0.0, static_cast<double>(3 * seen - free));
  }
  if (lengths.empty() || freedom < kLeastFreedom * numbers) return std::nullopt;
  return MedianOf(std::move(lengths)) / kMedianLength * std::sqrt(numbers / freedom);
}

// The rest of a sentence; empty where the parameters may be used.
std::string WhyNotUsable(int num_fitted, int num_frames, int num_determined, double percent) {
  if (num_determined == 0)
    return ": the markers determine none; bring more, or allow more uncertainty "
           "(--max-sigma-of-range, --marker-sigma-mm)";
  if (2 * num_fitted < num_frames || num_fitted == 0)
    return ": too few to go on with; see which markers are missing, and the head stabilisation's "
           "report";
  if (percent < 0)
    return fmt::format(
        "; the rig explains {:.1f} % of the movement: a face that stood still would come nearer. "
        "The reference pose (--reference) is no face at rest, or markers are misnamed",
        percent);
  return "";
}

}  // namespace

ExplainedVariance ExplainVariance(const ShapeFit& fit, const std::vector<bool>& judged,
                                  const std::vector<bool>& is_mouth_or_chin) {
  const int num_markers = fit.measured.num_markers();
  ExplainedVariance explained;
  explained.num_frames = static_cast<int>(std::count(judged.begin(), judged.end(), true));
  double unexplained_all = 0, total_all = 0, unexplained_mouth = 0, total_mouth = 0;
  for (int marker = 0; marker < num_markers; ++marker) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0, unexplained = 0;
    int count = 0;
    for (int frame = 0; frame < fit.measured.num_frames(); ++frame) {
      if (!judged[frame] || fit.measured.is_missing(frame, marker) ||
          fit.virtual_markers.is_missing(frame, marker))
        continue;
      const Eigen::Vector3d& p = fit.measured.position_mm(frame, marker);
      sum += p;
      squares += p.squaredNorm();
      unexplained += (fit.virtual_markers.position_mm(frame, marker) - p).squaredNorm();
      ++count;
    }
    const double total = count == 0 ? 0 : squares - sum.squaredNorm() / count;
    explained.per_marker.push_back(total > 0 ? 1 - unexplained / total : kNaN);
    unexplained_all += unexplained;
    total_all += total;
    if (is_mouth_or_chin[marker]) {
      unexplained_mouth += unexplained;
      total_mouth += total;
    }
  }
  explained.all = total_all > 0 ? 1 - unexplained_all / total_all : kNaN;
  explained.mouth_and_chin = total_mouth > 0 ? 1 - unexplained_mouth / total_mouth : kNaN;
  return explained;
}

void DescribeFit(const ShapeFit& fit, const FaceRig& rig, const std::vector<bool>& determined,
                 const ExplainedVariance& explained, StageReport* report) {
  std::map<FitStatus, int> statuses;
  for (const FitStatus status : fit.parameters.statuses) ++statuses[status];
  report->figures.emplace_back("frames", fit.parameters.num_frames());
  for (const auto& [status, count] : statuses)
    report->figures.emplace_back(fmt::format("frames_{}", NameOf(status)), count);

  std::vector<double> residuals;
  for (const double residual : fit.parameters.residuals_mm)
    if (std::isfinite(residual)) residuals.push_back(residual);
  report->figures.emplace_back("mean_residual_mm", Mean(residuals));
  report->figures.emplace_back("worst_frame_residual_mm", QuantileOf(residuals, 1));
  report->figures.emplace_back("explained_variance_mouth_chin_%", 100 * explained.mouth_and_chin);
  report->figures.emplace_back("explained_variance_all_%", 100 * explained.all);
  report->figures.emplace_back("explained_variance_frames", explained.num_frames);
  report->tables.push_back(ParameterTable(fit, rig, determined, report));
  report->tables.push_back(ResidualTable(fit, explained));
  for (const DisplacedMarker& displaced : FindDisplacedMarkers(fit))
    report->warnings.push_back(fmt::format(
        "{} lies {:.1f} mm (of the rig) from where the binding has it, in the same direction all "
        "through the take: glued elsewhere, or carrying another marker's name? Bind anew, or leave "
        "it out",
        displaced.name, displaced.distance_mm));
}

void NoteUndetermined(const FaceRig& rig, const Eigen::VectorXd& sigmas,
                      const std::vector<bool>& determined, const FitOptions& options,
                      StageReport* report) {
  std::vector<std::string> held, kept;
  for (int k = 0; k < rig.num_parameters(); ++k) {
    const RigParameter& parameter = rig.definition().parameters[k];
    (determined[k] ? kept : held).push_back(parameter.name);
    if (determined[k]) continue;
    const double part = sigmas[k] / (parameter.max - parameter.min);
    report->warnings.push_back(fmt::format(
        "{} is not determined by these markers ({}) and is held at the reference", parameter.name,
        part < 100 ? fmt::format("its standard deviation would be {:.0f} % of its range, above "
                                 "{:.0f} %",
                                 100 * part, 100 * options.max_sigma_of_range)
                   : "none of them tells it apart"));
  }
  report->texts.emplace_back("determined", fmt::format("{}", fmt::join(kept, ", ")));
  report->texts.emplace_back("held", fmt::format("{}", fmt::join(held, ", ")));
}

void NoteSmoothing(const FitOptions& options, const Smoothing& smoothing, StageReport* report) {
  if (options.smoothing_s == 0) return;
  report->figures.emplace_back("smoothing_steps", smoothing.steps);
  if (!smoothing.converged)
    report->warnings.push_back(fmt::format(
        "smoothing stopped after {} steps, short of the minimum; a shorter --smoothing-s "
        "is easier, and gaps of many markers make it harder",
        smoothing.steps));
}

double EstimateSigma(const ShapeFit& fit, const FrameFits& fits, const FitOptions& options,
                     StageReport* report) {
  const auto estimate = MarkerSigma_mm(fit.residuals_mm, fits.unit_sigmas);
  if (!estimate) {
    report->warnings.push_back(fmt::format(
        "the markers meet the rig exactly, whatever they measure: they are too few to tell their "
        "own noise; the sigmas assume {:.2g} mm a coordinate (--marker-sigma-mm)",
        options.marker_sigma_mm));
    return options.marker_sigma_mm;
  }
  report->figures.emplace_back("residual_sigma_mm", *estimate);
  if (*estimate > kNoisierThanAssumed * options.marker_sigma_mm)
    report->warnings.push_back(fmt::format(
        "the residuals are those of {:.2f} mm a coordinate, and which parameters are determined "
        "was decided with {:.2f} mm: some are less certain than their range allows (see their "
        "sigmas). "
        "The rig does not fit this face everywhere, or the markers are noisy; "
        "--marker-sigma-mm {:.2f} holds what is uncertain",
        *estimate, options.marker_sigma_mm, *estimate));
  return *estimate;
}

void Judge(const ShapeFit& fit, const ExplainedVariance& explained, int num_determined,
           StageReport* report) {
  const bool has_mouth = std::isfinite(explained.mouth_and_chin);
  const double percent = 100 * (has_mouth ? explained.mouth_and_chin : explained.all);
  const auto num_fitted = std::ranges::count_if(
      fit.parameters.residuals_mm, [](double residual) { return std::isfinite(residual); });
  const std::string fitted =
      fmt::format("{} of {} frames fitted with {} of {} parameters", num_fitted,
                  fit.parameters.num_frames(), num_determined, fit.parameters.num_parameters());
  const std::string why_not = WhyNotUsable(static_cast<int>(num_fitted),
                                           fit.parameters.num_frames(), num_determined, percent);
  report->usable = why_not.empty();
  if (!report->usable) {
    report->verdict = "not usable: " + fitted + why_not;
  } else if (!std::isfinite(percent)) {
    report->verdict =
        fitted +
        "; how much of the movement the rig explains was not judged: every frame served the "
        "binding or the refinement, or no marker has freedom left";
  } else {
    report->verdict = fmt::format("{}; the rig explains {:.1f} % of the movement{}", fitted,
                                  percent, has_mouth ? " of mouth and chin" : "");
    if (percent < kLittleExplained)
      report->warnings.push_back(fmt::format(
          "the rig explains only {:.0f} % of the movement: refine where the markers sit "
          "(--refine-frames 300), choose another reference pose (--reference), or see by the "
          "residuals which markers do not fit",
          percent));
  }
}

}  // namespace articap
