// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <optional>

#include "apps/display_units.h"
#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/rig_input.h"
#include "apps/verbs.h"
#include "core/binding.h"
#include "fitting/bind.h"
#include "render/label.h"
#include "render/rig_view.h"
#include "rig/pose_text.h"

namespace articap {
namespace {

enum class Sheet { kNone, kParameters, kIdentity };

struct RigRenderOptions {
  FaceView view = FaceView::kFront;
  Sheet sheet = Sheet::kNone;  // many small pictures instead of one
  bool mouth = false;          // the lower face instead of the whole head
  bool spectacles = true;      // where the rig has some
  bool landmarks = false;      // a red dot at each
  int width_px = 640;          // of one picture
  int height_px = 720;
  int samples_per_side = 4;  // a pixel averages the square of this many rays
  int num_threads = 2;
};

void VisitOptions(RigRenderOptions& options, OptionVisitor& visit) {
  visit.Enumeration("view", options.view, {"front", "three_quarter", "side"},
                    "where the camera stands");
  visit.Enumeration("sheet", options.sheet, {"none", "parameters", "identity"},
                    "a contact sheet of every parameter, or identity slider, at its extremes");
  visit("mouth", options.mouth, "the lower face instead of the whole head");
  visit("spectacles", options.spectacles, "show the spectacles");
  visit("landmarks", options.landmarks, "a red dot at every landmark");
  visit("width_px", options.width_px, "width of a picture; px");
  visit("height_px", options.height_px, "height of a picture; px");
  visit("samples_per_side", options.samples_per_side, "rays per pixel and direction");
  visit("num_threads", options.num_threads, "threads");
}

struct RigPose {
  FaceRig rig;  // with its identity
  Eigen::VectorXd parameters;
  std::vector<RenderSphere> markers;
};

PinholeView CameraOf(const FaceRig& rig, const RigRenderOptions& options) {
  if (!options.mouth) return HeadCamera(rig, options.view, options.width_px, options.height_px);
  constexpr double kSideYawRad = 1.5707963267948966;
  const double yaw_rad = options.view == FaceView::kFront  ? 0
                         : options.view == FaceView::kSide ? kSideYawRad
                                                           : kSideYawRad / 2;
  return MouthCamera(rig, yaw_rad, 0, options.width_px, options.height_px);
}

Picture PictureOf(const RigPose& pose, const RigRenderOptions& options) {
  RigViewOptions view;
  view.show_spectacles = options.spectacles;
  view.show_landmarks = options.landmarks;
  view.markers = pose.markers;
  RenderOptions render;
  render.samples_per_side = options.samples_per_side;
  render.num_threads = options.num_threads;
  return Render(SceneOf(pose.rig, pose.parameters, view), CameraOf(pose.rig, options), render);
}

std::string ExtremeLabel(const RigParameter& parameter, double value) {
  return fmt::format("{} {:.3g} {}", parameter.name, DisplayValueOf(value, parameter.unit),
                     DisplayUnitOf(parameter.unit));
}

// The neutral face, then every parameter alone at both ends of its range.
Picture ParameterSheet(const RigPose& neutral, const RigRenderOptions& options) {
  std::vector<LabelledPicture> pictures = {{"neutral", PictureOf(neutral, options)}};
  for (int index = 0; index < neutral.rig.num_parameters(); ++index) {
    const RigParameter& parameter = neutral.rig.definition().parameters[index];
    for (const double value : {parameter.min, parameter.max}) {
      if (value == 0) continue;
      RigPose extreme = neutral;
      extreme.parameters[index] = value;
      pictures.push_back({ExtremeLabel(parameter, value), PictureOf(extreme, options)});
    }
  }
  return ContactSheet(pictures, 4);
}

// The average head, then every slider alone at both ends of its range.
Picture IdentitySheet(const RigPose& neutral, const RigRenderOptions& options) {
  std::vector<LabelledPicture> pictures = {{"average", PictureOf(neutral, options)}};
  const std::vector<IdentitySlider>& sliders = neutral.rig.definition().identity_sliders;
  for (std::size_t index = 0; index < sliders.size(); ++index)
    for (const double value : {sliders[index].min, sliders[index].max}) {
      Eigen::VectorXd identity = neutral.rig.identity();
      identity[static_cast<Eigen::Index>(index)] = value;
      const RigPose extreme = {neutral.rig.WithIdentity(identity), neutral.parameters, {}};
      pictures.push_back(
          {fmt::format("{} {:.3g}", sliders[index].name, value), PictureOf(extreme, options)});
    }
  return ContactSheet(pictures, 4);
}

struct PoseArguments {
  std::string rig_folder, binding;
  std::vector<std::string> pose, identity;
};

// The pose and identity of a binding, with the markers that it was tied to over the face.
Result<RigPose> BoundPose(const FaceRig& rig, const std::string& path) {
  const Result<Binding> binding = ReadBinding(path);
  if (!binding) return tl::unexpected(binding.error());
  Result<FaceRig> speaker = RigOfBinding(*binding, rig);
  if (!speaker) return tl::unexpected(speaker.error());
  const Result<Eigen::VectorXd> parameters = ReferenceParameters(*binding, *speaker);
  if (!parameters) return tl::unexpected(parameters.error());
  RigPose bound = {std::move(*speaker), *parameters, {}};
  constexpr double kMarkerRadiusMm = 2;  // the paper's markers are 4 mm wide
  const Eigen::Vector3f marker_color(0.05f, 0.25f, 0.9f);
  for (const NamedPoint& point : binding->reference_pose.points)
    bound.markers.push_back({.center_mm = binding->rig_from_head * point.point_in_head_mm,
                             .radius_mm = kMarkerRadiusMm,
                             .color = marker_color});
  return bound;
}

Result<RigPose> PoseOf(const PoseArguments& arguments) {
  Result<FaceRig> rig = ChooseRig(arguments.rig_folder);
  if (!rig) return tl::unexpected(rig.error());
  if (!arguments.binding.empty()) return BoundPose(*rig, arguments.binding);
  Result<FaceRig> own = WithIdentityText(*rig, arguments.identity);
  if (!own) return tl::unexpected(own.error());
  const auto parameters = ParsePose(*own, arguments.pose);
  if (!parameters) return tl::unexpected(parameters.error());
  return RigPose{std::move(*own), *parameters, {}};
}

}  // namespace

ExitCode RigRenderCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap rig render", "A picture of any pose and identity of a rig.",
                "articap rig render open.png --pose jaw_rotation=10deg,lip_rounding=3mm "
                "--view three_quarter");
  std::string output;
  PoseArguments pose_arguments;
  RigRenderOptions options;
  line.Argument("OUT", output, "PNG file to write");
  line.Flag("--rig", pose_arguments.rig_folder, "DIR", "folder of a rig; else the default head");
  line.Flag("--pose", pose_arguments.pose, "NAME=VALUE,...",
            "parameters, rotations in deg or rad, lengths in mm");
  line.Flag("--identity", pose_arguments.identity, "NAME=VALUE,...", "identity sliders");
  line.Flag("--binding", pose_arguments.binding, "FILE",
            "the reference pose of a binding, with the markers over it; instead of --pose");
  line.Stage("render", options);
  if (const auto exit = line.Parse(arguments)) return *exit;
  if (!pose_arguments.binding.empty() &&
      (!pose_arguments.pose.empty() || !pose_arguments.identity.empty()))
    return FailWith(ExitCode::kWrongUsage,
                    "--binding brings its own pose and identity; leave --pose and --identity out");
  constexpr int kMaxSidePx = 8192;
  if (options.width_px < 1 || options.height_px < 1 || options.samples_per_side < 1 ||
      options.width_px > kMaxSidePx || options.height_px > kMaxSidePx)
    return FailWith(
        ExitCode::kWrongUsage,
        fmt::format("a picture is 1 to {} px a side, with at least one sample", kMaxSidePx));

  const Result<RigPose> pose = PoseOf(pose_arguments);
  if (!pose) return FailWith(pose.error());
  const Picture picture = WithProgress("rendering", [&] {
    if (options.sheet == Sheet::kParameters) return ParameterSheet(*pose, options);
    if (options.sheet == Sheet::kIdentity) return IdentitySheet(*pose, options);
    return PictureOf(*pose, options);
  });
  const Result<std::string> png = EncodePng(picture);
  if (!png) return FailWith(png.error());
  OutputSet outputs;
  outputs.Add(output, *png);
  if (const auto written = outputs.Commit(); !written) return FailWith(written.error());
  StageReport report;
  report.stage = "render";
  report.verdict = fmt::format("{} x {} px written to {}", picture.width, picture.height, output);
  report.texts = {{"rig", pose->rig.definition().name}};
  report.options = EchoOptions(options);
  return line.Finish({report});
}

}  // namespace articap
