// SPDX-License-Identifier: MIT
#include "capture/pictures.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cstring>

#include "capture/media_kind.h"
#include "core/file_io.h"
#include "tests/capture/ffmpeg_files.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

// A PGM of 8 or 16 bits with these values, in rows of two.
std::string Pgm(const std::vector<int>& values, int max_value) {
  std::string bytes = fmt::format("P5\n2 {}\n{}\n", values.size() / 2, max_value);
  for (const int value : values) {
    if (max_value > 255) bytes += static_cast<char>(value >> 8);
    bytes += static_cast<char>(value & 255);
  }
  return bytes;
}

class PicturesTest : public testing::Test {
 protected:
  ~PicturesTest() override { fs::remove_all(folder_); }

  fs::path Write(const std::string& name, const std::string& bytes) const {
    EXPECT_TRUE(WriteFile(folder_ / name, bytes));
    return folder_ / name;
  }

  const fs::path folder_ = MakeTemporaryFolder("articap_pictures_test");
};

TEST_F(PicturesTest, GrayPicturesKeepTheirValues) {
  const auto source = OpenPictures({Write("a.pgm", Pgm({0, 50, 100, 255}, 255)),
                                    Write("b.pgm", Pgm({0, 258, 1000, 65535, 7, 8}, 65535))});
  const auto eight = OrThrow(source->Next());
  EXPECT_EQ(eight->name, "a.pgm");
  EXPECT_EQ(eight->index, 0);
  ASSERT_EQ(eight->image.format, PixelFormat::kGray8);
  EXPECT_EQ(eight->image.row(0)[1], 50);
  EXPECT_EQ(eight->image.row(1)[1], 255);
  const auto sixteen = OrThrow(source->Next());
  EXPECT_EQ(sixteen->name, "b.pgm");
  ASSERT_EQ(sixteen->image.format, PixelFormat::kGray16);
  EXPECT_EQ(sixteen->image.height, 3);
  std::array<std::uint16_t, 2> values{};
  std::memcpy(values.data(), sixteen->image.row(1), 4);
  EXPECT_THAT(values, ElementsAre(1000, 65535));
  EXPECT_FALSE(OrThrow(source->Next()));
  ASSERT_TRUE(source->Rewind());
  EXPECT_EQ(OrThrow(source->Next())->name, "a.pgm");
}

TEST_F(PicturesTest, AllUsualFormatsAreRead) {
  ARTICAP_NEEDS_FFMPEG();
  BarFilm film;
  film.num_frames = 1;
  const std::string bars = WriteBars(folder_, film);
  for (const char* name : {"gray -c:v png a.png", "gray16be -c:v png b.png", "rgb24 -c:v png c.png",
                           "yuvj420p -q:v 2 d.jpg", "gray -q:v 2 e.jpg", "rgb24 f.bmp",
                           "gray g.tif", "gray16le h.tiff", "gray i.pgm", "rgb24 j.ppm",
                           "rgba k.png", "pal8 l.bmp", "gray16be m.pgm"}) {
    SCOPED_TRACE(name);
    RunFfmpeg(folder_, bars + "-frames:v 1 -pix_fmt " + name);
    const fs::path path = folder_ / std::string(name).substr(std::string(name).rfind(' ') + 1);
    EXPECT_EQ(MediaKindOf(path), MediaKind::kPicture);
    for (const PixelColor color : {PixelColor::kLuma, PixelColor::kRgb}) {
      const auto source = OpenPictures({path}, color);
      const auto frame = OrThrow(source->Next());
      EXPECT_EQ(frame->image.width, film.width);
      EXPECT_EQ(frame->image.height, film.height);
      EXPECT_NEAR(BarAt(frame->image), BarOf(film, 0), 0.1);
      const bool deep = std::string(name).starts_with("gray16");
      EXPECT_EQ(frame->image.format, color == PixelColor::kRgb ? PixelFormat::kRgb8
                                     : deep                    ? PixelFormat::kGray16
                                                               : PixelFormat::kGray8);
      const int level = color == PixelColor::kRgb ? frame->image.row(30)[3 * 16]
                        : deep                    ? frame->image.row(30)[2 * 16 + 1]
                                                  : frame->image.row(30)[16];
      const bool has_palette = std::string(name).starts_with("pal8");
      EXPECT_NEAR(level, 230, has_palette ? 25 : 3);  // a palette is coarse
    }
  }
}

TEST_F(PicturesTest, ABrokenPictureIsNamedAndTheNextOneComes) {
  ARTICAP_NEEDS_FFMPEG();
  BarFilm film;
  film.num_frames = 1;
  const std::string bars = WriteBars(folder_, film);
  const fs::path good = Write("good.pgm", Pgm({1, 2, 3, 4}, 255));
  for (const char* name : {"a.png", "a.jpg", "a.tif", "a.bmp", "a.pgm"}) {
    SCOPED_TRACE(name);
    RunFfmpeg(folder_, bars + "-frames:v 1 -pix_fmt " +
                           (std::string(name) == "a.jpg" ? "yuvj420p " : "gray ") + name);
    std::string bytes = OrThrow(ReadFile(folder_ / name));
    const fs::path cut = Write(std::string("cut_") + name, bytes.substr(0, bytes.size() / 2));
    const auto source = OpenPictures({cut, folder_ / "none.png", Write("empty.png", ""),
                                      Write("text.png", "not a picture"), good});
    for (const char* broken : {"cut_", "none.png", "empty.png", "text.png"}) {
      const auto frame = source->Next();
      ASSERT_FALSE(frame) << broken;
      EXPECT_THAT(frame.error().message, HasSubstr(broken));
    }
    EXPECT_EQ(OrThrow(source->Next())->name, "good.pgm");
    EXPECT_FALSE(OrThrow(source->Next()));
  }
}

TEST_F(PicturesTest, AFolderIsReadInTheOrderOfItsNumbers) {
  for (const char* name : {"left10.pgm", "left2.pgm", "left1.pgm"}) Write(name, Pgm({1, 2}, 255));
  Write("notes.txt", "the board was bent");
  std::vector<std::string> names;
  for (const fs::path& path : OrThrow(PicturesIn(folder_)))
    names.push_back(path.filename().string());
  EXPECT_THAT(names, ElementsAre("left1.pgm", "left2.pgm", "left10.pgm"));
  Write("left3.pgm", "");
  EXPECT_THAT(OrThrow(PicturesIn(folder_)), Contains(folder_ / "left3.pgm"))
      << "a picture that was lost is not passed over in silence";
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(PicturesIn(folder_ / "empty").error().message, HasSubstr("no pictures"));
  EXPECT_THAT(PicturesIn(folder_ / "none").error().message, HasSubstr("none: cannot be read"));
}

}  // namespace
}  // namespace articap
