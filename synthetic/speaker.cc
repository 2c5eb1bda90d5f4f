// SPDX-License-Identifier: MIT
#include "synthetic/speaker.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <numbers>

#include "rig/virtual_marker_evaluator.h"
#include "synthetic/attachment.h"
#include "synthetic/random_streams.h"

namespace articap {
namespace {

std::string NamesOf(const std::vector<IdentitySlider>& sliders) {
  std::string names;
  for (const IdentitySlider& slider : sliders) names += (names.empty() ? "" : ", ") + slider.name;
  return names.empty() ? "none" : names;
}

// "name=value" into the sliders.
Result<void> SetSlider(const std::string& text, const FaceRig& rig, Eigen::VectorXd* identity) {
  const std::vector<IdentitySlider>& sliders = rig.definition().identity_sliders;
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  const auto slider = std::find_if(sliders.begin(), sliders.end(),
                                   [&](const IdentitySlider& s) { return s.name == name; });
  if (slider == sliders.end())
    return Fail(fmt::format("the rig '{}' has no identity slider '{}'; it has: {}",
                            rig.definition().name, name, NamesOf(sliders)));
  double value = 0;
  const char* begin = text.data() + std::min(equals + 1, text.size());
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(begin, end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end)
    return Fail(fmt::format("identity '{}' is not of the form name=value", text));
  if (!(value >= slider->min && value <= slider->max))
    return Fail(fmt::format("identity slider '{}' is {}, outside of its range {} to {}", name,
                            value, slider->min, slider->max));
  (*identity)[slider - sliders.begin()] = value;
  return {};
}

Result<Eigen::VectorXd> ChooseIdentity(const FaceRig& rig, const SyntheticTakeOptions& options) {
  const std::vector<IdentitySlider>& sliders = rig.definition().identity_sliders;
  RandomGenerator random(options.seed, random_streams::kIdentity);
  Eigen::VectorXd identity(static_cast<int>(sliders.size()));
  for (std::size_t i = 0; i < sliders.size(); ++i) {
    const double half_range = 0.5 * (sliders[i].max - sliders[i].min);
    identity[i] = std::clamp(options.identity_spread * half_range * random.Normal(), sliders[i].min,
                             sliders[i].max);
  }
  for (const std::string& text : options.identity)
    if (auto set = SetSlider(text, rig, &identity); !set) return tl::unexpected(set.error());
  return identity;
}

Result<void> CheckOptions(const SyntheticTakeOptions& options) {
  const auto refuse = [](const char* name, double value, const char* rule) {
    return Fail(fmt::format("{} is {}; it must be {}", name, value, rule));
  };
  const SyntheticSpeechOptions& speech = options.speech;
  if (speech.num_sentences < 0) return refuse("sentences", speech.num_sentences, "0 or more");
  if (!(speech.rate_hz >= 10 && speech.rate_hz <= 10000))
    return refuse("rate_hz", speech.rate_hz, "between 10 and 10000");
  if (!(speech.tempo >= 0.25 && speech.tempo <= 4))
    return refuse("tempo", speech.tempo, "between 0.25 and 4");
  if (!(speech.pause_s >= 0.05)) return refuse("pause_s", speech.pause_s, "at least 0.05");
  if (!(speech.rest_s >= 0)) return refuse("rest_s", speech.rest_s, "0 or more");
  if (!(speech.effort >= 0 && speech.effort <= 1))
    return refuse("effort", speech.effort, "between 0 and 1");
  if (!(options.speaker_scale >= 0.5 && options.speaker_scale <= 2))
    return refuse("speaker_scale", options.speaker_scale, "between 0.5 and 2");
  if (!(options.head.max_rotation_deg >= 0 && options.head.max_rotation_deg <= 90))
    return refuse("head_rotation_deg", options.head.max_rotation_deg, "between 0 and 90");
  return {};
}

// The mean attitude of the head in a room whose z points up, 1.2 m above the floor.
Rigid3d StageFromMeanHead(std::uint64_t seed) {
  RandomGenerator random(seed, random_streams::kStage);
  constexpr double kPi = std::numbers::pi;
  constexpr double kMaxTilt = 8 * kPi / 180;
  const double heading = random.Uniform(-kPi, kPi);
  const double tilt = random.Uniform(-kMaxTilt, kMaxTilt);
  const double lean = random.Uniform(-kMaxTilt, kMaxTilt);
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(kPi / 2 + tilt, Eigen::Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitZ());
  const double x_mm = random.Uniform(-250, 250);
  const double y_mm = random.Uniform(-250, 250);
  return {rotation, {x_mm, y_mm, 1200 + random.Uniform(-80, 80)}};
}

HeadPoseTrack TruePose(const std::vector<Rigid3d>& moved_from_mean,
                       const SyntheticTakeOptions& options) {
  const Rigid3d stage_from_mean =
      options.speaker_ahead ? Rigid3d() : StageFromMeanHead(options.seed);
  HeadPoseTrack track;
  track.mode = StabilizationMode::kRigid;
  track.rate_hz = options.speech.rate_hz;
  for (const Rigid3d& moved : moved_from_mean)
    track.poses.push_back({(stage_from_mean * moved).Inverse(), 0, HeadPoseStatus::kOk});
  return track;
}

StageTracks MoveMarkers(const FaceRig& speaker, const SyntheticTake& take) {
  const VirtualMarkerEvaluator evaluator(speaker, take.true_attachments);
  const Sim3d head_from_rig = take.rig_from_head.Inverse();
  std::vector<std::string> names;
  for (const VirtualMarker& attachment : take.true_attachments) names.push_back(attachment.name);
  StageTracks tracks(std::move(names), take.truth.num_frames(), take.truth.rate_hz);
  std::vector<double> parameters(take.truth.num_parameters());
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    for (int i = 0; i < take.truth.num_parameters(); ++i)
      parameters[i] = take.truth.values(frame, i);
    const auto pose = evaluator.PoseOf(parameters);
    const Rigid3d stage_from_head = take.true_pose.poses[frame].head_from_stage.Inverse();
    for (int marker = 0; marker < tracks.num_markers(); ++marker)
      tracks.Set(frame, marker,
                 stage_from_head * (head_from_rig * evaluator.Position(pose, marker)));
  }
  return tracks;
}

}  // namespace

void VisitOptions(SyntheticTakeOptions& options, OptionVisitor& visit) {
  visit("seed", options.seed, "the same seed and options give the same take, bit by bit");
  VisitOptions(options.speech, visit);
  VisitOptions(options.head, visit);
  visit("identity", options.identity, "sliders of the speaker, name=value; others are random");
  visit("identity_spread", options.identity_spread,
        "SD of random identity sliders, as a fraction of their ranges; 0: the average head");
  visit("speaker_scale", options.speaker_scale, "size of the speaker's head against the rig's");
  visit("misplacement_mm", options.misplacement_mm,
        "how far beside its landmark a marker may be glued; mm");
  visit("speaker_ahead", options.speaker_ahead,
        "the stage is the speaker's: origin in the head, x to its left, y up, z forward; else a "
        "room with z up. Video always has it so");
}

Eigen::VectorXd SyntheticTake::identity_values() const {
  Eigen::VectorXd values(static_cast<int>(identity.size()));
  for (std::size_t i = 0; i < identity.size(); ++i) values[i] = identity[i].value;
  return values;
}

Result<SyntheticTake> SynthesizeTake(const FaceRig& rig, const MarkerSet& marker_set,
                                     const SyntheticTakeOptions& options) {
  if (auto valid = CheckOptions(options); !valid) return tl::unexpected(valid.error());
  const auto identity = ChooseIdentity(rig, options);
  if (!identity) return tl::unexpected(identity.error());
  const FaceRig speaker = rig.WithIdentity(*identity);
  RandomGenerator attachment_random(options.seed, random_streams::kAttachment);
  auto attachments = AttachMarkers(speaker, marker_set, options.misplacement_mm, attachment_random);
  if (!attachments) return tl::unexpected(attachments.error());

  SyntheticSpeech speech = SynthesizeSpeech(speaker, options.speech, options.seed);
  const std::vector<Rigid3d> motion =
      SynthesizeHeadMotion(speech.utterances, speech.track.num_frames(), options.speech.rate_hz,
                           options.head, options.seed);

  SyntheticTake take;
  take.truth = std::move(speech.track);
  take.labels = LabelsOf(speech.utterances);
  take.true_pose = TruePose(motion, options);
  take.rig_from_head.scale = 1 / options.speaker_scale;
  take.rig_name = rig.definition().name;
  for (int i = 0; i < identity->size(); ++i)
    take.identity.push_back({rig.definition().identity_sliders[i].name, (*identity)[i]});
  take.true_attachments = *std::move(attachments);
  take.marker_set = marker_set;
  if (options.speaker_ahead && marker_set.axes) take.marker_set.axes = DeclaredAxes{};
  take.options = EchoOptions(options);
  take.markers.tracks = MoveMarkers(speaker, take);
  take.markers.source_unit = "mm";
  return take;
}

}  // namespace articap
