// SPDX-License-Identifier: MIT
#include "render/label.h"

#include <gmock/gmock.h>

namespace articap {
namespace {

int DarkPixels(const Picture& picture) {
  int count = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) count += picture.pixel(x, y)[1] < 128;
  return count;
}

TEST(Label, TextIsDrawnInsideItsBoxAlone) {
  Picture picture = FilledPicture(60, 30, Eigen::Vector3f::Ones());
  DrawText(picture, "L", 10, 5, 2);
  // An L: seven points down and four more across, each 2 x 2 pixels.
  EXPECT_EQ(DarkPixels(picture), 4 * (7 + 4));
  EXPECT_LT(picture.pixel(10, 5)[0], 128);
  EXPECT_LT(picture.pixel(10 + TextWidth("L", 2) - 1, 5 + 13)[0], 128);
  EXPECT_GT(picture.pixel(9, 5)[0], 128);
}

TEST(Label, TextOverTheEdgeIsCutOff) {
  Picture picture = FilledPicture(8, 8, Eigen::Vector3f::Ones());
  DrawText(picture, "left\xC3\xA9 out", -9, -3, 1);
  DrawText(picture, "below", 2, 400, 1);
  EXPECT_LT(DarkPixels(picture), 64);
}

TEST(Label, SheetHoldsEveryPictureOnce) {
  std::vector<LabelledPicture> pictures;
  for (int i = 0; i < 5; ++i)
    pictures.push_back({"view", FilledPicture(20 + i, 10, Eigen::Vector3f(0.0f, 1.0f, 0.0f))});
  const Picture sheet = ContactSheet(pictures, 2);
  int green = 0;
  for (int y = 0; y < sheet.height; ++y)
    for (int x = 0; x < sheet.width; ++x)
      green += sheet.pixel(x, y)[0] == 0 && sheet.pixel(x, y)[1] == 255;
  EXPECT_EQ(green, 10 * (20 + 21 + 22 + 23 + 24));
}

TEST(Label, LongLabelsBreakInsteadOfRunningIntoTheNext) {
  const Picture white = FilledPicture(60, 10, Eigen::Vector3f::Ones());
  const auto dark_columns = [](const Picture& sheet, int from, int to) {
    int count = 0;
    for (int x = from; x < to; ++x)
      for (int y = 0; y < sheet.height; ++y) count += sheet.pixel(x, y)[0] < 128;
    return count;
  };
  const Picture short_labels = ContactSheet({{"ab", white}, {"", white}}, 2);
  const Picture long_labels = ContactSheet({{"ab_cd ef", white}, {"", white}}, 2);
  EXPECT_GT(long_labels.height, short_labels.height);
  EXPECT_EQ(long_labels.width, short_labels.width);
  EXPECT_GT(dark_columns(long_labels, 6, 66), 0);
  EXPECT_EQ(dark_columns(long_labels, 66, long_labels.width), 0);
}

}  // namespace
}  // namespace articap
