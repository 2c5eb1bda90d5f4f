// SPDX-License-Identifier: MIT
#include "fitting/displaced_markers.h"

#include <gmock/gmock.h>

#include <random>

namespace articap {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

// Virtual markers on a line, measured ones beside them with 0.2 mm of noise.
ShapeFit NoisyFit() {
  constexpr int kNumFrames = 100;
  const std::vector<std::string> names = {"a", "b", "c", "d", "e"};
  ShapeFit fit;
  fit.measured = RigTracks(names, kNumFrames, 60);
  fit.virtual_markers = RigTracks(names, kNumFrames, 60);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.2);
  for (int frame = 0; frame < kNumFrames; ++frame)
    for (int marker = 0; marker < fit.measured.num_markers(); ++marker) {
      const Eigen::Vector3d place(10 * marker, 0, 0);
      fit.virtual_markers.Set(frame, marker, place);
      fit.measured.Set(frame, marker,
                       place + Eigen::Vector3d{noise(random), noise(random), noise(random)});
    }
  return fit;
}

void Move(ShapeFit& fit, int frame, int marker, const Eigen::Vector3d& by_mm) {
  fit.measured.Set(frame, marker, fit.measured.position_mm(frame, marker) + by_mm);
}

TEST(DisplacedMarkers, NoiseIsNoDisplacement) {
  EXPECT_THAT(FindDisplacedMarkers(NoisyFit()), IsEmpty());
}

TEST(DisplacedMarkers, AMarkerGluedElsewhereIsFound) {
  ShapeFit fit = NoisyFit();
  for (int frame = 0; frame < fit.measured.num_frames(); ++frame) Move(fit, frame, 2, {0, 3, 4});
  EXPECT_THAT(
      FindDisplacedMarkers(fit),
      ElementsAre(testing::AllOf(Field(&DisplacedMarker::name, "c"),
                                 Field(&DisplacedMarker::distance_mm, DoubleNear(5, 0.1)))));
}

TEST(DisplacedMarkers, AMarkerThatMovesToAndFroIsNotDisplaced) {
  ShapeFit fit = NoisyFit();
  for (int frame = 0; frame < fit.measured.num_frames(); ++frame)
    Move(fit, frame, 2, {0, frame % 2 == 0 ? 5.0 : -5.0, 0});
  EXPECT_THAT(FindDisplacedMarkers(fit), IsEmpty());
}

TEST(DisplacedMarkers, AFitThatIsBadEverywhereIsNoDisplacement) {
  ShapeFit fit = NoisyFit();
  for (int frame = 0; frame < fit.measured.num_frames(); ++frame)
    for (int marker = 0; marker < fit.measured.num_markers(); ++marker)
      Move(fit, frame, marker, {0, 0, 4});
  EXPECT_THAT(FindDisplacedMarkers(fit), IsEmpty());
}

TEST(DisplacedMarkers, NothingMeasuredIsNoDisplacement) {
  EXPECT_THAT(FindDisplacedMarkers(ShapeFit()), IsEmpty());
}

}  // namespace
}  // namespace articap
