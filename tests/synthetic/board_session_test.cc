// SPDX-License-Identifier: MIT
#include "synthetic/board_session.h"

#include <gmock/gmock.h>

#include <map>

#include "tests/support/matchers.h"
#include "tests/support/result.h"

namespace articap {
namespace {

const CameraModel kSmall = {.width = 640, .height = 360, .focal_px = 900};

// How often each view shows the whole board.
std::map<std::string, int> WholeIn(const SyntheticCameras& cameras, int num_pictures) {
  const Studio studio(cameras);
  const BoardSession session = BoardSessionFor(cameras);
  const BoardPattern pattern = SquaresOf(session.board);
  std::map<std::string, int> whole;
  for (const Rigid3d& pose : OrThrow(BoardPosesOf(studio, session, num_pictures, 1)))
    for (const BoardTruth& truth : TruthOfBoard(studio, session.board, pattern, pose))
      whole[cameras.array.NameOf(truth.corners.view)] += truth.whole;
  return whole;
}

TEST(BoardSessionTest, EveryMirrorShowsTheBoardOftenEnough) {
  const auto one = WholeIn(MirrorSetUp(4, 2, kSmall), 12);
  EXPECT_GE(one.at("front"), 8);
  EXPECT_GE(one.at("front/left"), 8);
  const auto two = WholeIn(TwoMirrorSetUp(4, 2, kSmall), 18);
  EXPECT_GE(two.at("front"), 12);
  EXPECT_GE(two.at("front/left"), 6);
  EXPECT_GE(two.at("front/right"), 6);
}

TEST(BoardSessionTest, TwoCamerasOfARingShareEveryBoard) {
  int shown = 0;
  for (const auto& [view, whole] : WholeIn(RingOfCameras(4, 2, kSmall), 10)) shown += whole;
  EXPECT_GE(shown, 20);
}

TEST(BoardSessionTest, MoreBoardsBeginAsFewerDo) {
  const SyntheticCameras cameras = MirrorSetUp(4, 2, kSmall);
  const Studio studio(cameras);
  const BoardSession session = BoardSessionFor(cameras);
  const auto few = OrThrow(BoardPosesOf(studio, session, 4, 7));
  const auto many = OrThrow(BoardPosesOf(studio, session, 11, 7));
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_THAT(many[i], Rigid3dNear(few[i], 0, 0));
}

}  // namespace
}  // namespace articap
