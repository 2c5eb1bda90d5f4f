// SPDX-License-Identifier: MIT
#include "tracking/exchange_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace articap {
namespace {

const std::vector<Eigen::Vector3d> kShape = {
    {70, 3, -70}, {55, 12, -5}, {0, 8, 12}, {-55, 12, -5}, {-70, 3, -70}};

StageTracks TracksWithExchange(int first, int second, int num_references) {
  StageTracks tracks({"a", "b", "c", "d", "e"}, 4, 60, 100);
  for (int frame = 0; frame < 4; ++frame)
    for (int i = 0; i < num_references; ++i) {
      const int at = frame < 2 ? i : i == first ? second : i == second ? first : i;
      tracks.Set(frame, i, kShape[at] + Eigen::Vector3d(10, 20, 30));
    }
  return tracks;
}

TEST(ExchangeCheckTest, NamesThePairAndTheFrame) {
  const ReferenceModel model{{0, 1, 2, 3, 4}, kShape, std::vector<double>(5, 0.2)};
  const StageTracks tracks = TracksWithExchange(1, 4, 5);
  EXPECT_THAT(FindExchangesInFrames(tracks, model, std::vector<int>{0, 1, 2, 3}, 1.0),
              testing::ElementsAre(
                  testing::AllOf(testing::HasSubstr("'b' and 'e' are exchanged in 2 of the 4"),
                                 testing::HasSubstr("frame 102"))));
  EXPECT_THAT(FindExchangesInFrames(tracks, model, std::vector<int>{0, 1}, 1.0),
              testing::IsEmpty());
  EXPECT_THAT(FindExchangesInFrames(tracks, model, std::vector<int>{}, 1.0), testing::IsEmpty());
}

TEST(ExchangeCheckTest, ThreeReferencesSayNothing) {
  const ReferenceModel model{{0, 1, 2, 3, 4}, kShape, std::vector<double>(5, 0.2)};
  EXPECT_THAT(FindExchangesInFrames(TracksWithExchange(1, 2, 3), model, std::vector<int>{2, 3}, 1),
              testing::IsEmpty());
}

}  // namespace
}  // namespace articap
