// SPDX-License-Identifier: MIT
#include "tracking/anatomy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/alignment.h"
#include "core/landmarks.h"

namespace articap {
namespace {

constexpr int kMinLandmarksForTilt = 4;
constexpr int kMinLandmarksForMirror = 6;
constexpr int kMinOthersForPair = 5;

struct PairedFace {
  std::vector<Eigen::Vector3d> typical_mm;
  std::vector<Eigen::Vector3d> measured_mm;
};

PairedFace PairUp(const std::vector<PlacedLandmark>& landmarks) {
  PairedFace face;
  for (const PlacedLandmark& landmark : landmarks) {
    face.typical_mm.push_back(FindLandmark(landmark.landmark)->typical_mm);
    face.measured_mm.push_back(landmark.point_mm);
  }
  return face;
}

// "left_eye_outer" -> "right_eye_outer", "nose_left" -> "nose_right"; empty for all others.
std::string OppositeOf(const std::string& landmark) {
  const std::string_view left = "left";
  const std::size_t at = landmark.find(left);
  return at == std::string::npos ? "" : std::string(landmark).replace(at, left.size(), "right");
}

// Does exchanging two landmarks fit the rest of the face far better?
bool AreExchanged(const PairedFace& face, std::size_t left, std::size_t right) {
  std::vector<double> weights(face.typical_mm.size(), 1.0);
  weights[left] = weights[right] = 0;
  if (std::ssize(weights) - 2 < kMinOthersForPair) return false;
  // A mirrored face has every pair exchanged, and is named as such.
  const ReflectionTest others = DetectReflection(face.typical_mm, face.measured_mm, weights);
  if (others.is_reflected) return false;
  const Sim3d measured_from_typical = AlignSimilarity(face.typical_mm, face.measured_mm, weights);
  const Eigen::Vector3d left_mm = measured_from_typical * face.typical_mm[left];
  const Eigen::Vector3d right_mm = measured_from_typical * face.typical_mm[right];
  const double as_named = (face.measured_mm[left] - left_mm).squaredNorm() +
                          (face.measured_mm[right] - right_mm).squaredNorm();
  const double as_exchanged = (face.measured_mm[left] - right_mm).squaredNorm() +
                              (face.measured_mm[right] - left_mm).squaredNorm();
  return as_exchanged < as_named / 4;
}

}  // namespace

std::vector<PlacedLandmark> PlaceLandmarks(const MarkerSet& set,
                                           const std::vector<std::string>& names,
                                           const std::vector<Eigen::Vector3d>& points_mm) {
  std::vector<PlacedLandmark> landmarks;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const MarkerRole* role = set.Find(names[i]);
    if (!role || !FindLandmark(role->landmark) || !points_mm[i].allFinite()) continue;
    landmarks.push_back({names[i], role->landmark, points_mm[i]});
  }
  return landmarks;
}

AnatomyFindings CheckAnatomy(const std::vector<PlacedLandmark>& all_landmarks) {
  // Where spectacles sit differs from one frame to another.
  std::vector<PlacedLandmark> landmarks;
  std::ranges::copy_if(all_landmarks, std::back_inserter(landmarks), [](const auto& landmark) {
    return !landmark.landmark.starts_with("spectacles");
  });
  AnatomyFindings findings;
  findings.num_landmarks = static_cast<int>(landmarks.size());
  if (findings.num_landmarks < kMinLandmarksForTilt) return findings;
  const PairedFace face = PairUp(landmarks);
  const ReflectionTest test = DetectReflection(face.typical_mm, face.measured_mm);
  findings.rms_proper_mm = test.rms_proper;
  findings.rms_mirrored_mm = test.rms_reflected;
  findings.is_mirrored = test.is_reflected && findings.num_landmarks >= kMinLandmarksForMirror;
  const Sim3d measured_from_typical = AlignSimilarity(face.typical_mm, face.measured_mm);
  findings.tilt_rad =
      measured_from_typical.rotation.angularDistance(Eigen::Quaterniond::Identity());
  for (std::size_t left = 0; left < landmarks.size(); ++left)
    for (std::size_t right = 0; right < landmarks.size(); ++right)
      if (OppositeOf(landmarks[left].landmark) == landmarks[right].landmark &&
          AreExchanged(face, left, right))
        findings.exchanged.emplace_back(landmarks[left].marker, landmarks[right].marker);
  return findings;
}

std::string MirroredMessage(const AnatomyFindings& anatomy) {
  return fmt::format(
      "the markers show the mirror image of a face ({} landmarks lie {:.0f} mm RMS from an average "
      "face, {:.0f} mm from its mirror image): the data are mirrored or left-handed (use "
      "--mirror), "
      "or left and right are exchanged in all names",
      anatomy.num_landmarks, anatomy.rms_proper_mm, anatomy.rms_mirrored_mm);
}

void WarnOfExchangedNames(const AnatomyFindings& anatomy, StageReport& report) {
  for (const auto& [left, right] : anatomy.exchanged)
    report.warnings.push_back(
        fmt::format("'{}' and '{}' lie on each other's side of the face: left and right are "
                    "exchanged in their names, or in the map",
                    left, right));
}

}  // namespace articap
