// SPDX-License-Identifier: MIT
#include "core/board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace articap {
namespace {

using testing::HasSubstr;

TEST(BoardTest, NamesReadBackAsTheSameBoard) {
  for (const char* text :
       {"chessboard:9x6:25", "chessboard:7x5:12.5", "charuco:7x5:12:9:DICT_4X4_50"}) {
    const auto board = ParseBoardSpec(text);
    ASSERT_TRUE(board) << board.error().message;
    EXPECT_EQ(NameOf(*board), text);
  }
  EXPECT_EQ(NameOf(ParseBoardSpec("charuco:7x5:12:9").value()), "charuco:7x5:12:9:DICT_5X5_250");
}

TEST(BoardTest, WhatIsNoBoardIsRefusedWithAnExample) {
  for (const char* text :
       {"", "board", "chessboard", "chessboard:9x6", "chessboard:9:25", "chessboard:9x6x3:25",
        "chessboard:9x6:0", "chessboard:9x6:-25", "chessboard:9x6:nan", "chessboard:9x6:25mm",
        "chessboard:2x6:25", "chessboard:999999999x6:25", "charuco:7x5:12", "charuco:7x5:12:12",
        "charuco:7x5:12:9:A:B", "chessboard:9x6:1e9"}) {
    const auto board = ParseBoardSpec(text);
    ASSERT_FALSE(board) << text;
    EXPECT_THAT(board.error().message, HasSubstr("chessboard:9x6:25")) << text;
  }
}

TEST(BoardTest, CornersAreCountedAsPeopleCountThem) {
  const BoardSpec chessboard = ParseBoardSpec("chessboard:9x6:25").value();
  EXPECT_EQ(chessboard.num_corners(), 54);
  EXPECT_EQ(chessboard.corner_in_board_mm(10), Eigen::Vector3d(25, 25, 0));
  const BoardSpec charuco = ParseBoardSpec("charuco:7x5:12:9").value();
  EXPECT_EQ(charuco.num_corners(), 24);
  EXPECT_EQ(charuco.corner_in_board_mm(23), Eigen::Vector3d(60, 36, 0));
}

TEST(BoardTest, OnlyChessboardsOfOneParityLookTheSameUpsideDown) {
  EXPECT_FALSE(ParseBoardSpec("chessboard:9x6:25")->is_ambiguous());
  EXPECT_TRUE(ParseBoardSpec("chessboard:9x7:25")->is_ambiguous());
  EXPECT_TRUE(ParseBoardSpec("chessboard:8x6:25")->is_ambiguous());
  EXPECT_FALSE(ParseBoardSpec("charuco:7x5:12:9")->is_ambiguous());
}

TEST(BoardTest, HalfOfTheSquaresAreDark) {
  const BoardPattern pattern = SquaresOf(ParseBoardSpec("chessboard:9x6:25").value());
  EXPECT_EQ(pattern.dark.size(), 35U);  // of 10 x 7
  EXPECT_EQ(pattern.dark[0].min_mm, Eigen::Vector2d(-25, -25));
  EXPECT_EQ(pattern.dark[0].max_mm, Eigen::Vector2d(0, 0));
  EXPECT_EQ(pattern.paper.min_mm, Eigen::Vector2d(-50, -50));
  EXPECT_EQ(pattern.paper.max_mm, Eigen::Vector2d(250, 175));
}

}  // namespace
}  // namespace articap
