// SPDX-License-Identifier: MIT
#include "synthetic/head_motion.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "synthetic/random_streams.h"
#include "synthetic/smooth_steps.h"

namespace articap {
namespace {

// Where the head turns, in the head frame: the upper neck.
const Eigen::Vector3d kPivotMm(0, -90, -25);

// Shares of the largest angle and way; the root of the sum of their squares is below 1, so that
// the total stays within the limits whatever the combination.
constexpr double kPitchShare = 0.5, kYawShare = 0.7, kRollShare = 0.35;
constexpr double kAcrossShare = 0.7, kUpShare = 0.4, kForwardShare = 0.5;

constexpr double kSwayHalfWidthS = 1.2;
constexpr double kNodHalfWidthS = 0.18;

// A new random target in -limit .. limit every one to three seconds.
SmoothSteps Sway(double limit, double duration_s, RandomGenerator& random) {
  SmoothSteps sway(kSwayHalfWidthS);
  double now_s = 0;
  while (now_s < duration_s) {
    now_s += random.Uniform(1, 3);
    sway.Add(now_s, limit * random.Uniform(-1, 1));
  }
  return sway;
}

// Down on every stressed vowel, by up to `limit`.
SmoothSteps Nods(const Utterances& utterances, double limit, RandomGenerator& random) {
  SmoothSteps nods(kNodHalfWidthS);
  for (const PhoneToken& token : utterances.phones) {
    const bool nod = token.phone && token.phone->vowel && token.stressed;
    nods.Add(token.end_s, nod ? limit * random.Uniform(0.2, 1) : 0);
  }
  return nods;
}

}  // namespace

void VisitOptions(SyntheticHeadMotionOptions& options, OptionVisitor& visit) {
  visit("head_rotation_deg", options.max_rotation_deg, "largest turn of the head; deg");
  visit("head_translation_mm", options.max_translation_mm, "largest movement of the neck; mm");
  visit("head_nod_deg", options.nod_deg, "largest nod on a stressed syllable; deg");
}

std::vector<Rigid3d> SynthesizeHeadMotion(const Utterances& utterances, int num_frames,
                                          double rate_hz, const SyntheticHeadMotionOptions& options,
                                          std::uint64_t seed) {
  RandomGenerator random(seed, random_streams::kHeadMotion);
  constexpr double kRadPerDeg = std::numbers::pi / 180;
  const double max_angle = options.max_rotation_deg * kRadPerDeg;
  const double max_way = options.max_translation_mm;
  const double max_nod = std::min(options.nod_deg * kRadPerDeg, kPitchShare * max_angle);
  const double duration_s = utterances.duration_s;
  const SmoothSteps pitch = Sway(kPitchShare * max_angle - max_nod, duration_s, random);
  const SmoothSteps yaw = Sway(kYawShare * max_angle, duration_s, random);
  const SmoothSteps roll = Sway(kRollShare * max_angle, duration_s, random);
  const SmoothSteps across = Sway(kAcrossShare * max_way, duration_s, random);
  const SmoothSteps up = Sway(kUpShare * max_way, duration_s, random);
  const SmoothSteps forward = Sway(kForwardShare * max_way, duration_s, random);
  const SmoothSteps nods = Nods(utterances, max_nod, random);

  std::vector<Rigid3d> motion;
  motion.reserve(num_frames);
  for (int frame = 0; frame < num_frames; ++frame) {
    const double time_s = frame / rate_hz;
    const Eigen::Quaterniond turn =
        Eigen::AngleAxisd(yaw.At(time_s), Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(pitch.At(time_s) + nods.At(time_s), Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(roll.At(time_s), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d way_mm(across.At(time_s), up.At(time_s), forward.At(time_s));
    motion.push_back({turn, kPivotMm + way_mm - turn * kPivotMm});
  }
  return motion;
}

}  // namespace articap
