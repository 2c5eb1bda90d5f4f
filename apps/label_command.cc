// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "apps/marker_input.h"
#include "apps/output_names.h"
#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/review_outputs.h"
#include "apps/template_input.h"
#include "apps/verbs.h"
#include "tracking/fill_gaps.h"
#include "tracking/labelled_markers.h"
#include "tracking/learn_template.h"

namespace articap {
namespace {

struct LabelArguments {
  std::string input, output, config;
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

Result<std::vector<StageReport>> RunLabel(const LabelArguments& arguments) {
  if (const auto checked = CheckOptions(arguments.fill); !checked)
    return tl::unexpected(checked.error());
  const Result<MarkerFormat> format = MarkerFormatOf(arguments.output);
  if (!format) return tl::unexpected(format.error());
  const Result<MarkerRecording> source = ReadMarkers(arguments.input, arguments.read);
  if (!source) return tl::unexpected(source.error());
  const PointClouds clouds = CloudsOf(*source);
  const Result<MarkerTemplate> marker_template = WithProgress("labelling", [&] {
    return TemplateFor(arguments.naming, clouds, AttitudesOfLaboratories(), arguments.label);
  });
  if (!marker_template) return tl::unexpected(marker_template.error());
  const Labelling labelling = WithProgress(
      "labelling", [&] { return LabelClouds(clouds, *marker_template, arguments.label); });
  StageReport report = DescribeLabelling(clouds, *marker_template, labelling, arguments.label);
  for (const std::string& warning : source->warnings) report.warnings.push_back(warning);
  const auto filled = WithProgress("filling gaps", [&] {
    return FillGaps(RecordingOf(*source, clouds, *marker_template, labelling), arguments.fill);
  });
  if (!filled) return tl::unexpected(filled.error());
  const MarkerRecording& labelled = filled->output;
  if (const auto limit = LimitExceeded(labelled, *format))
    return Fail(fmt::format("{} has {}; write another format", arguments.input, *limit));
  OutputSet outputs;
  outputs.Add(arguments.output, FormatMarkers(labelled, *format));
  const TakeReview review = ReviewOf(clouds, labelling, labelled);
  AddReview(arguments.output, review, DoubtsOf(review, labelling, labelled.tracks),
            {report, filled->report}, outputs);
  if (arguments.naming.known.empty())
    outputs.Add(Beside(arguments.output, ".template.toml"), WriteMarkerTemplate(*marker_template));
  if (const auto allowed = outputs.RefuseToOverwrite(
          {arguments.input, arguments.naming.known, arguments.naming.layout, arguments.config});
      !allowed)
    return tl::unexpected(allowed.error());
  if (const auto written = outputs.Commit(); !written) return tl::unexpected(written.error());
  for (const std::string& loss : LossesOf(labelled, *format)) report.warnings.push_back(loss);
  return std::vector<StageReport>{report, filled->report};
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
  line.Stage("read", values.read);
  line.Stage("label", values.label);
  line.Stage("fill", values.fill, "fill");
  if (const auto exit = line.Parse(arguments)) return *exit;
  values.config = line.config_path();
  const auto reports = RunLabel(values);
  return reports ? line.Finish(*reports) : FailWith(reports.error());
}

}  // namespace articap
