// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "apps/corrections_input.h"
#include "apps/marker_input.h"
#include "apps/output_names.h"
#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/review_outputs.h"
#include "apps/template_input.h"
#include "apps/verbs.h"
#include "tracking/apply_corrections.h"
#include "tracking/fill_gaps.h"
#include "tracking/labelled_markers.h"
#include "tracking/learn_template.h"

namespace articap {
namespace {

struct LabelArguments {
  std::string input, output, config, corrections;
  TemplateInput naming;
  MarkerReadOptions read;
  LabelOptions label;
  FillOptions fill;
};

// Of a recording whose cameras nobody knows: the axes that laboratories use, the speaker looking
// along any of them.
std::vector<Eigen::Quaterniond> AttitudesOfLaboratories() {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  std::vector<Eigen::Quaterniond> attitudes;
  for (const Eigen::Vector3d& up : {y, z})
    for (const Eigen::Vector3d& forward :
         {z, x, Eigen::Vector3d(-x), Eigen::Vector3d(-z), y, Eigen::Vector3d(-y)}) {
      if (std::abs(up.dot(forward)) > 0.5) continue;
      Eigen::Matrix3d stage_from_head;
      stage_from_head << up.cross(forward), up, forward;
      attitudes.emplace_back(stage_from_head.transpose());
    }
  return attitudes;
}

struct LabelledFile {
  PointClouds clouds;
  MarkerTemplate marker_template;
  Labelling labelling;
};

Result<LabelledFile> LabelFile(const LabelArguments& arguments, const MarkerRecording& source,
                               AppliedCorrections& corrections) {
  LabelledFile result;
  result.clouds = CloudsOf(source);
  Result<MarkerTemplate> marker_template =
      TemplateFor(arguments.naming, result.clouds, AttitudesOfLaboratories(), arguments.label);
  if (!marker_template) return tl::unexpected(marker_template.error());
  result.marker_template = std::move(*marker_template);
  if (const auto known = corrections.CheckMarkers(result.marker_template); !known)
    return tl::unexpected(known.error());
  result.labelling =
      corrections.Label(result.clouds, result.marker_template, arguments.label, CameraArray{}, {});
  return result;
}

Result<void> WriteLabelled(const LabelArguments& arguments, const LabelledFile& file,
                           const MarkerRecording& labelled, MarkerFormat format,
                           const std::vector<StageReport>& reports) {
  OutputSet outputs;
  outputs.Add(arguments.output, FormatMarkers(labelled, format));
  const TakeReview review = ReviewOf(file.clouds, file.labelling, labelled);
  AddReview(arguments.output, review, DoubtsOf(review, file.labelling, labelled.tracks), reports,
            outputs);
  if (arguments.naming.known.empty())
    outputs.Add(Beside(arguments.output, ".template.toml"),
                WriteMarkerTemplate(file.marker_template));
  if (auto allowed = outputs.RefuseToOverwrite({arguments.input, arguments.naming.known,
                                                arguments.naming.layout, arguments.config,
                                                arguments.corrections});
      !allowed)
    return allowed;
  return outputs.Commit();
}

Result<std::vector<StageReport>> RunLabel(const LabelArguments& arguments) {
  if (const auto checked = CheckOptions(arguments.fill); !checked)
    return tl::unexpected(checked.error());
  const Result<MarkerFormat> format = MarkerFormatOf(arguments.output);
  if (!format) return tl::unexpected(format.error());
  const Result<MarkerRecording> source = ReadMarkers(arguments.input, arguments.read);
  if (!source) return tl::unexpected(source.error());
  Result<AppliedCorrections> corrections =
      CorrectionsOf(arguments.corrections, source->tracks.first_frame(), CameraArray{});
  if (!corrections) return tl::unexpected(corrections.error());
  const Result<LabelledFile> file =
      WithProgress("labelling", [&] { return LabelFile(arguments, *source, *corrections); });
  if (!file) return tl::unexpected(file.error());
  StageReport report =
      DescribeLabelling(file->clouds, file->marker_template, file->labelling, arguments.label);
  for (const std::string& warning : source->warnings) report.warnings.push_back(warning);
  const auto filled = WithProgress("filling gaps", [&] {
    return FillGaps(RecordingOf(*source, file->clouds, file->marker_template, file->labelling),
                    arguments.fill);
  });
  if (!filled) return tl::unexpected(filled.error());
  MarkerRecording labelled = filled->output;
  corrections->ClearFillsAcrossSplits(file->labelling, labelled);
  if (const auto limit = LimitExceeded(labelled, *format))
    return Fail(fmt::format("{} has {}; write another format", arguments.input, *limit));
  std::vector<StageReport> reports = {report, filled->report};
  if (!corrections->empty()) reports.push_back(corrections->Report());
  if (const auto written = WriteLabelled(arguments, *file, labelled, *format, reports); !written)
    return tl::unexpected(written.error());
  for (const std::string& loss : LossesOf(labelled, *format)) reports[0].warnings.push_back(loss);
  return reports;
}

}  // namespace

ExitCode LabelCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap label",
      "Names the markers of a recording that has no labels, or wrong ones, by where they\n"
      "sit on the head, and fills their short gaps. What was learnt of the speaker goes to\n"
      "OUT's stem + .template.toml, and labels further takes; the report to .report.json.",
      "articap label take01.c3d take01.labelled.c3d --map spectacles30");
  LabelArguments values;
  line.Argument("IN", values.input, "marker file; the names in it are not regarded");
  line.Argument("OUT", values.output, "marker file to write; its ending says the format");
  AddTemplateInput(line, values.naming);
  AddCorrectionsFlag(line, values.corrections);
  line.Stage("read", values.read);
  line.Stage("label", values.label);
  line.Stage("fill", values.fill, "fill");
  if (const auto exit = line.Parse(arguments)) return *exit;
  values.config = line.config_path();
  const auto reports = RunLabel(values);
  return reports ? line.Finish(*reports) : FailWith(reports.error());
}

}  // namespace articap
