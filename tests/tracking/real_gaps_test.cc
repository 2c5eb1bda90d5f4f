// SPDX-License-Identifier: MIT
// Gaps cut at random into recordings of a real face; see ARTICAP_TEST_DATA in
// tests/support/test_data.h. The table of docs/tracking.md is what these tests print.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "core/marker_io.h"
#include "core/marker_set.h"
#include "tests/support/test_data.h"
#include "tests/tracking/gap_cuts.h"
#include "tracking/fill_gaps.h"

namespace articap {
namespace {

struct RealTake {
  StageTracks tracks;
  std::vector<int> face;
  std::vector<int> references;
};

const MarkerSet& AnimfaceSet() {
  static const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / "animface.toml").value();
  return set;
}

RealTake ReadTake(const std::string& file, double noise_mm = 0) {
  RealTake take{ReadMarkers(TestDataPath(file)).value().tracks, {}, {}};
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto noise = [&] { return noise_mm * normal(random); };
  for (int marker = 0; marker < take.tracks.num_markers(); ++marker) {
    const MarkerRole* role = AnimfaceSet().Find(take.tracks.names()[marker]);
    (role && role->head_reference ? take.references : take.face).push_back(marker);
    for (int frame = 0; frame < take.tracks.num_frames() && noise_mm > 0; ++frame) {
      const Eigen::Vector3d error_mm{noise(), noise(), noise()};
      take.tracks.Set(frame, marker, take.tracks.position_mm(frame, marker) + error_mm);
    }
  }
  return take;
}

void CutAndFill(const RealTake& take, const std::vector<int>& markers, int length, int together,
                unsigned seed, GapErrors& errors) {
  std::mt19937 random(seed);
  const CutTake cut = CutGaps(take.tracks, markers, length, together, random);
  const auto filled = FillGaps(cut.tracks, {.longest_s = 1});
  ASSERT_TRUE(filled) << filled.error().message;
  errors.Add(take.tracks, cut.gaps, filled->output);
}

void Print(const std::string& what, int length, const GapErrors& errors) {
  std::cout << fmt::format(
      "{:<22} {:2} frames {:4} gaps: linear {:.4f} cubic {:.4f} spline {:.4f} filled {:.4f} mm, "
      "{:.3f} of cubic, normalised {:.2f}, {} far off\n",
      what, length, errors.gaps, errors.Rms(errors.linear_mm2), errors.Rms(errors.cubic_mm2),
      errors.Rms(errors.spline_mm2), errors.Rms(errors.filled_mm2),
      errors.Rms(errors.filled_mm2) / errors.Rms(errors.cubic_mm2), errors.NormalisedRms(),
      errors.far_off);
}

// From the longest gap that interpolation does well to the longest that is filled.
class RealGapsTest : public testing::TestWithParam<int> {
 protected:
  // At 5 frames never worse than cubic interpolation, from 15 on at most 0.6 times its error; and
  // the estimated errors are right.
  static void Expect(const GapErrors& errors) {
    EXPECT_EQ(errors.left, 0);
    const double ratio = GetParam() >= 15 ? 0.6 : 1.0;
    EXPECT_LE(errors.Rms(errors.filled_mm2), ratio * errors.Rms(errors.cubic_mm2));
    EXPECT_LE(errors.Rms(errors.filled_mm2), ratio * errors.Rms(errors.spline_mm2));
    EXPECT_GE(errors.NormalisedRms(), 0.7);
    EXPECT_LE(errors.NormalisedRms(), 1.4);
    EXPECT_LE(errors.far_off, 0.02 * errors.gaps);
  }
};

TEST_P(RealGapsTest, OneFaceMarkerAtATime) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  for (const std::string file : {"animface/jaw.trc", "animface/cheeks.trc"}) {
    const RealTake take = ReadTake(file);
    GapErrors errors;
    for (const unsigned seed : {1, 2, 3, 4, 5, 6, 7, 8})
      CutAndFill(take, take.face, GetParam(), 1, seed, errors);
    Print(file, GetParam(), errors);
    Expect(errors);
  }
}

TEST_P(RealGapsTest, FiveFaceMarkersAtATime) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  for (const std::string file : {"animface/jaw.trc", "animface/cheeks.trc"}) {
    const RealTake take = ReadTake(file);
    GapErrors errors;
    for (const unsigned seed : {9, 10}) CutAndFill(take, take.face, GetParam(), 5, seed, errors);
    Print(file + " five", GetParam(), errors);
    Expect(errors);
  }
}

TEST_P(RealGapsTest, ReferencesOnSkin) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  const RealTake take = ReadTake("animface/jaw.trc");
  GapErrors errors;
  for (const unsigned seed : {11, 12, 13, 14})
    CutAndFill(take, take.references, GetParam(), 1, seed, errors);
  Print("references of jaw.trc", GetParam(), errors);
  Expect(errors);
}

// The recordings are smooth curves; a camera's are not.
TEST_P(RealGapsTest, WithNoise) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  const RealTake take = ReadTake("animface/jaw.trc", 0.1);
  GapErrors errors;
  for (const unsigned seed : {15, 16, 17, 18})
    CutAndFill(take, take.face, GetParam(), 1, seed, errors);
  Print("jaw.trc, 0.1 mm noise", GetParam(), errors);
  Expect(errors);
}

INSTANTIATE_TEST_SUITE_P(Frames, RealGapsTest, testing::Values(2, 5, 15, 30, 60));

}  // namespace
}  // namespace articap
