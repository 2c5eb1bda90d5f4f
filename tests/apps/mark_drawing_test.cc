// SPDX-License-Identifier: MIT
#include "apps/mark_drawing.h"

#include <gmock/gmock.h>

#include <cstring>

namespace articap {
namespace {

MarkerMark MarkAt(int marker, const Eigen::Vector2d& place_px, bool is_seen = true) {
  MarkerMark mark;
  mark.marker = marker;
  mark.view = {0, -1};
  mark.place_px = place_px;
  if (is_seen) mark.dot_px = place_px;
  mark.diameter_px = 8;
  return mark;
}

// Pixels that are no shade of grey.
int ColouredPixels(const Picture& picture) {
  int count = 0;
  for (std::size_t i = 0; i < picture.rgb8.size(); i += 3)
    count += picture.rgb8[i] != picture.rgb8[i + 1] || picture.rgb8[i] != picture.rgb8[i + 2];
  return count;
}

Picture Drawn(const FrameMarks& marks, const MarkStyle& style, int camera = 0) {
  Picture picture = FilledPicture(200, 120, Eigen::Vector3f::Zero());
  DrawMarks(marks, camera, {}, style, picture);
  return picture;
}

TEST(MarkDrawingTest, MarksOfAnotherCameraAreNotDrawn) {
  FrameMarks marks;
  marks.markers = {MarkAt(0, {50, 50})};
  marks.spare_dots = {{0, {90, 90}, 8}};
  EXPECT_GT(ColouredPixels(Drawn(marks, {{"chin"}, {}, 1, false})), 50);
  EXPECT_EQ(Drawn(marks, {{"chin"}, {}, 1, false}, 1).rgb8,
            FilledPicture(200, 120, Eigen::Vector3f::Zero()).rgb8);
}

TEST(MarkDrawingTest, HighlightedMarkersHaveTheirOwnColour) {
  FrameMarks marks;
  marks.markers = {MarkAt(0, {50, 50})};
  const Picture plain = Drawn(marks, {{"chin"}, {}, 1, false});
  const Picture highlighted = Drawn(marks, {{"chin"}, {0}, 1, false});
  const std::uint8_t* const of_plain = plain.pixel(56, 50);
  const std::uint8_t* const of_highlighted = highlighted.pixel(56, 50);
  EXPECT_GT(of_plain[2], of_plain[0]) << "blue";
  EXPECT_GT(of_highlighted[0], of_highlighted[2]) << "orange";
}

TEST(MarkDrawingTest, HiddenMarkersAreCrossesNotRings) {
  FrameMarks marks;
  marks.markers = {MarkAt(0, {50, 50}, false)};
  const Picture picture = Drawn(marks, {{""}, {}, 1, false});
  EXPECT_GT(picture.pixel(50, 50)[0], 0);
  EXPECT_EQ(picture.pixel(56, 50)[0], 0);
}

// The names of dots in a row would lie on one another; all letters stay visible.
TEST(MarkDrawingTest, NamesKeepOffOneAnother) {
  FrameMarks one, both;
  const MarkStyle style = {{"upper_lip", "lower_lip"}, {}, 1, false};
  one.markers = {MarkAt(0, {60, 60})};
  both.markers = {MarkAt(0, {60, 60}), MarkAt(1, {74, 60})};
  FrameMarks far = both;
  far.markers[1] = MarkAt(1, {60, 20});
  EXPECT_GE(ColouredPixels(Drawn(both, style)), 0.97 * ColouredPixels(Drawn(far, style)));
}

TEST(MarkDrawingTest, FramesBecomePicturesWithSquarePixelsAndAllRows) {
  Image field(PixelFormat::kGray16, 3, 2);
  const std::uint16_t bright = 65535;
  std::memcpy(field.row(1) + 2, &bright, sizeof bright);
  Frame frame;
  frame.image = field.view();
  frame.picture_from_image = {{2, 2}, {0, 1}};  // twice as wide, a bottom field
  const Picture picture = PictureOf(frame, 0, 0, 6, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x) {
      // Row 1 of the field is row 3 of the picture; column 1 column 2, nearest from 1 to below 3.
      const bool is_bright = y >= 2 && x >= 1 && x < 3;
      EXPECT_EQ(picture.pixel(x, y)[1], is_bright ? 255 : 0) << x << ", " << y;
    }
}

TEST(MarkDrawingTest, BeyondAFrameIsDarkGrey) {
  const Image black(PixelFormat::kGray8, 4, 4);
  Frame frame;
  frame.image = black.view();
  const Picture picture = PictureOf(frame, 2, -1, 3, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      const bool is_beyond = y == 0 || x == 2;
      EXPECT_EQ(picture.pixel(x, y)[0] > 0, is_beyond) << x << ", " << y;
      EXPECT_LT(picture.pixel(x, y)[0], 100);
    }
}

}  // namespace
}  // namespace articap
