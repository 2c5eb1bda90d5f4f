// SPDX-License-Identifier: MIT
#include "synthetic/lip_gauge.h"

#include <array>
#include <string_view>

#include "synthetic/attachment.h"

namespace articap {
namespace {

constexpr std::string_view kUpperSeamLandmark = "upper_lip_seam";
constexpr std::string_view kLowerSeamLandmark = "lower_lip_seam";
constexpr int kBisections = 48;  // from a whole range to double precision

}  // namespace

std::optional<LipGauge> LipGauge::Create(const FaceRig& rig) {
  const auto upper = rig.FindLandmark(kUpperSeamLandmark);
  const auto lower = rig.FindLandmark(kLowerSeamLandmark);
  if (!upper || !lower) return std::nullopt;
  const auto upper_marker = AttachToVertex(rig, *upper);
  const auto lower_marker = AttachToVertex(rig, *lower);
  if (!upper_marker || !lower_marker) return std::nullopt;
  return LipGauge(rig, *upper_marker, *lower_marker);
}

LipGauge::LipGauge(const FaceRig& rig, const VirtualMarker& upper, const VirtualMarker& lower)
    : evaluator_(rig, std::array{upper, lower}),
      ranges_(rig.definition().parameters),
      lower_lip_(rig.FindParameter("lower_lip_depression")),
      jaw_(rig.FindParameter("jaw_rotation")) {
  neutral_gap_mm_ = OpeningMm(Eigen::VectorXd::Zero(rig.num_parameters()));
}

double LipGauge::OpeningMm(const Eigen::VectorXd& parameters) const {
  const auto pose =
      evaluator_.PoseOf({parameters.data(), static_cast<std::size_t>(parameters.size())});
  return (evaluator_.Position(pose, 0) - evaluator_.Position(pose, 1)).y() - neutral_gap_mm_;
}

void LipGauge::SetOpening(double opening_mm, Eigen::VectorXd* parameters) const {
  if (lower_lip_) {
    const RigParameter& range = ranges_[*lower_lip_];
    SetOpeningBy(*lower_lip_, range.min, range.max, opening_mm, parameters);
  }
  constexpr double kReachedMm = 1e-6;
  if (jaw_ && std::abs(OpeningMm(*parameters) - opening_mm) > kReachedMm)
    SetOpeningBy(*jaw_, 0, ranges_[*jaw_].max, opening_mm, parameters);
}

void LipGauge::SetOpeningBy(int parameter, double low, double high, double opening_mm,
                            Eigen::VectorXd* parameters) const {
  double& value = (*parameters)[parameter];
  for (int i = 0; i < kBisections; ++i) {
    value = 0.5 * (low + high);
    (OpeningMm(*parameters) < opening_mm ? low : high) = value;
  }
}

}  // namespace articap
