// SPDX-License-Identifier: MIT
#include "calib/view_choice.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/calib/board_picture.h"

namespace articap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const BoardSpec kBoard = ParseBoardSpec("chessboard:9x6:20").value();
const BoardPictureOptions kCamera;

BoardPose At(double x_mm, double y_mm, double z_mm, double pitch_rad, double yaw_rad) {
  BoardPose pose = BoardPose::Turned(pitch_rad, yaw_rad, 0);
  pose.middle_mm = {x_mm, y_mm, z_mm};
  return pose;
}

FoundBoard Found(std::int64_t frame, const BoardPose& pose, double edge_px = 2) {
  FoundBoard found;
  found.sighting.source = "frame " + std::to_string(frame);
  found.sighting.frame = frame;
  found.sighting.points_px = TrueCorners(kBoard, pose, kCamera);
  for (int corner = 0; corner < kBoard.num_corners(); ++corner)
    found.sighting.corners.push_back(corner);
  found.sigmas_px.assign(found.sighting.corners.size(), 0.02);
  found.quality = {.edge_px = edge_px, .contrast = 0.7, .saturated = 0, .spacing_px = 25};
  return found;
}

Sightings Seen(bool is_video, std::vector<FoundBoard> found) {
  Sightings sightings;
  sightings.camera = "cam1";
  sightings.width = kCamera.width;
  sightings.height = kCamera.height;
  sightings.is_video = is_video;
  sightings.pictures = static_cast<std::int64_t>(found.size());
  sightings.found = std::move(found);
  return sightings;
}

std::vector<std::int64_t> FramesOf(const ViewChoice& choice) {
  std::vector<std::int64_t> frames;
  for (const FoundBoard& view : choice.views) frames.push_back(view.sighting.frame);
  return frames;
}

TEST(ViewChoiceTest, DifferentPicturesAreAllKept) {
  const ViewChoice choice =
      ChooseViews(Seen(false, {Found(0, At(0, 0, 600, 0, 0)), Found(1, At(60, 0, 600, 0, 0)),
                               Found(2, At(0, 0, 600, 0.3, 0)), Found(3, At(0, 0, 600, -0.3, 0)),
                               Found(4, At(0, 0, 800, 0, 0))}),
                  kBoard);
  EXPECT_THAT(FramesOf(choice), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(choice.set_aside, IsEmpty());
}

TEST(ViewChoiceTest, ABoardThatRestsIsUsedOnce) {
  std::vector<FoundBoard> found;
  for (int frame = 0; frame < 50; ++frame) found.push_back(Found(frame, At(0, 0, 600, 0.2, 0)));
  found.push_back(Found(50, At(50, 0, 600, -0.2, 0)));
  found.push_back(Found(51, At(50, 0, 600, -0.2, 0)));
  const ViewChoice choice = ChooseViews(Seen(true, found), kBoard);
  EXPECT_EQ(choice.views.size(), 2U);
  ASSERT_EQ(choice.set_aside.size(), 50U);
  EXPECT_EQ(choice.set_aside[5].reason, "not needed beside frame 0");
}

// A minute of waving: the board goes to and fro, near and far, with rests.
TEST(ViewChoiceTest, OfAVideoTheStillAndDifferentFramesAreChosen) {
  std::vector<FoundBoard> found;
  for (int frame = 0; frame < 1500; ++frame) {
    const double phase = 0.02 * (frame - 20 * std::sin(frame / 20.0));  // rests every 126 frames
    found.push_back(Found(frame, At(80 * std::sin(phase), 50 * std::sin(1.7 * phase),
                                    650 + 150 * std::sin(0.6 * phase), 0.5 * std::sin(2.3 * phase),
                                    0.5 * std::cos(1.3 * phase))));
  }
  const Sightings sightings = Seen(true, found);
  const ViewChoice choice = ChooseViews(sightings, kBoard);
  EXPECT_EQ(choice.views.size(), 40U);
  EXPECT_EQ(choice.views.size() + choice.set_aside.size(), found.size());
  EXPECT_GT(choice.covered, 0.5);
  int moving = 0;
  for (const SetAside& aside : choice.set_aside)
    if (aside.reason.find("the board moves") != std::string::npos) ++moving;
  EXPECT_GT(moving, 100);
  for (const FoundBoard& view : choice.views) {
    const auto frame = static_cast<std::size_t>(view.sighting.frame);
    const auto motion_px = [&](std::size_t other) {
      return (found[frame].sighting.points_px[0] - found[other].sighting.points_px[0]).norm();
    };
    EXPECT_LT(std::min(frame > 0 ? motion_px(frame - 1) : INFINITY,
                       frame + 1 < found.size() ? motion_px(frame + 1) : INFINITY),
              6);
  }
}

TEST(ViewChoiceTest, BlurredPicturesAreSetAside) {
  const ViewChoice choice =
      ChooseViews(Seen(false, {Found(0, At(0, 0, 600, 0, 0)), Found(1, At(60, 0, 600, 0, 0), 6),
                               Found(2, At(0, 0, 700, 0.3, 0), 2.2)}),
                  kBoard);
  EXPECT_THAT(FramesOf(choice), ElementsAre(0, 2));
  ASSERT_EQ(choice.set_aside.size(), 1U);
  EXPECT_EQ(choice.set_aside[0].source, "frame 1");
  EXPECT_THAT(choice.set_aside[0].reason, HasSubstr("edges 6.0 px wide, of the sharpest 2.0"));
}

TEST(ViewChoiceTest, BothSightingsOfAFrameStayTogether) {
  FoundBoard in_mirror = Found(0, At(40, 0, 700, 0.3, 0).Reversed());
  in_mirror.sighting.mirrored = true;
  const ViewChoice choice = ChooseViews(
      Seen(false, {Found(0, At(-40, 0, 600, 0, 0)), in_mirror, Found(1, At(-40, 0, 500, 0.2, 0))}),
      kBoard, {.max_views = 1});
  EXPECT_THAT(FramesOf(choice), ElementsAre(0, 0));
  EXPECT_EQ(choice.set_aside.size(), 1U);
}

TEST(ViewChoiceTest, NothingIsChosenOfNothing) {
  const ViewChoice choice = ChooseViews(Seen(false, {}), kBoard);
  EXPECT_THAT(choice.views, IsEmpty());
  EXPECT_EQ(choice.covered, 0);
}

TEST(ViewChoiceTest, OptionsThatMakeNoSenseAreRefused) {
  EXPECT_TRUE(CheckOptions(ViewChoiceOptions()));
  EXPECT_FALSE(CheckOptions(ViewChoiceOptions{.max_views = 0}));
  EXPECT_FALSE(CheckOptions(ViewChoiceOptions{.max_blur_ratio = 0.5}));
  EXPECT_FALSE(CheckOptions(ViewChoiceOptions{.min_novelty = -1}));
}

}  // namespace
}  // namespace articap
