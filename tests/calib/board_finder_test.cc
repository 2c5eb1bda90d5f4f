// SPDX-License-Identifier: MIT
#include "calib/board_finder.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/calib/board_picture.h"
#include "tests/support/result.h"

namespace articap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Shot {
  std::string name;
  Image image;
  FrameStatus status = FrameStatus::kGood;
  std::string failure;  // instead of a picture
};

// Pictures in memory.
class Shots : public FrameSource {
 public:
  Shots(std::vector<Shot> shots, double rate_hz) : shots_(std::move(shots)) {
    info_.name = "cam1";
    info_.rate_hz = rate_hz;
    info_.frames = static_cast<std::int64_t>(shots_.size());
  }

  const FrameSourceInfo& info() const override { return info_; }
  Result<std::optional<Frame>> Next() override {
    if (next_ == shots_.size()) return std::optional<Frame>();
    const Shot& shot = shots_[next_++];
    if (!shot.failure.empty()) return Fail(shot.failure);
    Frame frame;
    frame.index = index_++;
    frame.name = shot.name;
    frame.status = shot.status;
    frame.image = shot.image.view();
    return std::optional(frame);
  }
  Result<void> Rewind() override {
    next_ = 0;
    index_ = 0;
    return {};
  }

 private:
  FrameSourceInfo info_;
  std::vector<Shot> shots_;
  std::size_t next_ = 0;
  std::int64_t index_ = 0;
};

const BoardSpec kBoard = ParseBoardSpec("chessboard:5x4:20").value();
const BoardPictureOptions kSmall{
    .width = 320,
    .height = 240,
    .lens = {.fx_px = 500, .fy_px = 500, .cx_px = 159.5, .cy_px = 119.5}};

Image PictureAt(double x_mm) {
  BoardPose pose = BoardPose::Turned(0.1, 0.2, 0.05);
  pose.middle_mm.x() = x_mm;
  return PictureOf(kBoard, pose, kSmall);
}

TEST(BoardFinderTest, EveryPictureIsFoundOrSetAsideWithItsReason) {
  const Image blank(PixelFormat::kGray8, 320, 240), other(PixelFormat::kGray8, 322, 240);
  Shots source({{"a.png", PictureAt(0)},
                {"b.png", blank},
                {"c.png", other},
                {"d.png", PictureAt(20)},
                {"", {}, FrameStatus::kGood, "e.png: not a picture"},
                {"f.png", PictureAt(0)},
                {"g.png", PictureAt(40), FrameStatus::kCorrupt},
                {"h.png", PictureAt(-20)}},
               0);
  std::vector<double> parts;
  const Sightings sightings =
      OrThrow(FindBoards(source, kBoard, {}, [&](double part) { parts.push_back(part); }));
  EXPECT_EQ(sightings.width, 320);
  EXPECT_EQ(sightings.height, 240);
  EXPECT_EQ(sightings.pictures, 7);
  EXPECT_FALSE(sightings.is_video);
  std::vector<std::string> names;
  for (const FoundBoard& found : sightings.found) names.push_back(found.sighting.source);
  EXPECT_THAT(names, ElementsAre("a.png", "d.png", "h.png"));
  EXPECT_EQ(sightings.found[1].sighting.frame, 3);
  EXPECT_EQ(sightings.found[1].sighting.points_px.size(), 20U);
  EXPECT_THAT(
      sightings.set_aside,
      ElementsAre(SetAside{"b.png", "no board found"},
                  SetAside{"c.png", "322 x 240 px, the others 320 x 240; one camera has one size"},
                  SetAside{"", "e.png: not a picture"},
                  SetAside{"f.png", "the same picture as a.png"},
                  SetAside{"g.png", "damaged: not all of it could be decoded"}));
  ASSERT_EQ(parts.size(), 7U);
  EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
}

TEST(BoardFinderTest, TheSizeIsThatOfMostPictures) {
  BoardPictureOptions large = kSmall;
  large.width = 330;
  const Image odd = PictureOf(kBoard, BoardPose::Turned(0.1, 0.2, 0.05), large);
  Shots source({{"a.png", odd}, {"b.png", PictureAt(0)}, {"c.png", PictureAt(20)}}, 0);
  const Sightings sightings = OrThrow(FindBoards(source, kBoard));
  EXPECT_EQ(sightings.width, 320);
  EXPECT_EQ(sightings.found.size(), 2U);
  ASSERT_EQ(sightings.set_aside.size(), 1U);
  EXPECT_EQ(sightings.set_aside[0].source, "a.png");
  EXPECT_THAT(sightings.set_aside[0].reason, HasSubstr("330 x 240 px, the others 320 x 240"));
}

TEST(BoardFinderTest, TheResultIsTheSameEveryTime) {
  std::vector<Shot> shots;
  for (int i = 0; i < 20; ++i) shots.push_back({"", PictureAt(3 * i - 30)});
  Shots source(std::move(shots), 25);
  const Sightings first = OrThrow(FindBoards(source, kBoard));
  ASSERT_TRUE(source.Rewind());
  const Sightings second = OrThrow(FindBoards(source, kBoard));
  ASSERT_EQ(first.found.size(), 20U);
  EXPECT_EQ(first.found[7].sighting.source, "cam1, frame 7");
  EXPECT_TRUE(first.is_video);
  for (std::size_t i = 0; i < first.found.size(); ++i)
    EXPECT_EQ(first.found[i].sighting.points_px, second.found[i].sighting.points_px);
}

TEST(BoardFinderTest, WhatCannotBeReadFailsWithItsReason) {
  Shots broken({{"", {}, FrameStatus::kGood, "cam1.mp4: no key frame"},
                {"", {}, FrameStatus::kGood, "cam1.mp4: no key frame"}},
               25);
  const auto unreadable = FindBoards(broken, kBoard);
  ASSERT_FALSE(unreadable);
  EXPECT_EQ(unreadable.error().message, "cam1.mp4: no key frame");
  Shots empty({}, 0);
  const auto nothing = FindBoards(empty, kBoard);
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().message, HasSubstr("cam1: holds no picture"));
  BoardSpec unknown = ParseBoardSpec("charuco:7x5:12:9:DICT_MINE").value();
  EXPECT_FALSE(FindBoards(empty, unknown));
}

}  // namespace
}  // namespace articap
