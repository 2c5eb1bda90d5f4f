// SPDX-License-Identifier: MIT
#include "capture/open_frames.h"

#include <gmock/gmock.h>

#include "core/file_io.h"
#include "tests/capture/ffmpeg_files.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

class OpenFramesTest : public testing::Test {
 protected:
  void SetUp() override { ARTICAP_NEEDS_FFMPEG(); }
  ~OpenFramesTest() override { fs::remove_all(folder_); }

  // A take whose cameras show the film from 1 s on.
  fs::path MakeTake(const std::string& id, const std::vector<std::string>& cameras,
                    const std::optional<TakePart>& part = {}) const {
    const fs::path take_folder = folder_ / "takes" / id;
    const fs::path files = part ? folder_ / "takes" / part->of : take_folder;
    fs::create_directories(take_folder);
    TakeInfo take;
    take.id = id;
    take.part = part;
    for (const std::string& camera : cameras) {
      TakeFile file;
      file.role = FileRole::kVideo;
      file.name = camera + ".mkv";
      file.camera = camera;
      file.offset = std::chrono::seconds(1);
      file.rate_hz = film_.rate_hz;
      file.width = film_.width;
      file.height = film_.height;
      if (!part) RunFfmpeg(files, WriteBars(files, film_) + "-c:v ffv1 " + file.name);
      file.digest = OrThrow(DigestOf(files / file.name));
      take.files.push_back(file);
    }
    EXPECT_TRUE(WriteFile(take_folder / kTakeFileName, WriteTakeInfo(take)));
    return take_folder;
  }

  const fs::path folder_ = MakeTemporaryFolder("articap_open_frames_test");
  const BarFilm film_ = {};
};

TEST_F(OpenFramesTest, ContentDecides) {
  RunFfmpeg(folder_, WriteBars(folder_, film_) + "-frames:v 12 pic%d.png");
  RunFfmpeg(folder_, WriteBars(folder_, film_) + "-c:v ffv1 -f matroska film.dat");
  fs::create_directory(folder_ / "pictures");
  for (int i = 1; i <= 12; ++i) {
    const std::string name = "pic" + std::to_string(i) + ".png";
    fs::rename(folder_ / name, folder_ / "pictures" / name);
  }
  const auto pictures = OrThrow(OpenFrames({folder_ / "pictures"}));
  const SeenFilm seen = ReadAll(*pictures);
  ASSERT_THAT(seen.frames, SizeIs(12));
  for (int i = 0; i < 12; ++i) EXPECT_EQ(seen.frames[i].bar_px, BarOf(film_, i));
  EXPECT_THAT(ReadAll(*OrThrow(OpenFrames({folder_ / "film.dat"}))).frames, SizeIs(20));
  const fs::path one = folder_ / "pictures" / "pic3.png";
  EXPECT_EQ(OrThrow(OrThrow(OpenFrames({one}))->Next())->name, "pic3.png");
  EXPECT_THAT(OpenFrames({one, folder_ / "film.dat"}).error().message,
              AllOf(HasSubstr("pic3.png is a picture"), HasSubstr("film.dat a video")));
  EXPECT_THAT(OpenFrames({folder_ / "none"}).error().message, HasSubstr("none"));
  EXPECT_THAT(OpenFrames({}).error().message, HasSubstr("named"));
}

TEST_F(OpenFramesTest, ATakesFolderIsItsCamera) {
  const SeenFilm seen = ReadAll(*OrThrow(OpenFrames({MakeTake("one", {"left"})})));
  ASSERT_THAT(seen.frames, SizeIs(20));
  EXPECT_EQ(seen.frames[0].time_s, 1);
  EXPECT_THAT(OpenFrames({MakeTake("two", {"left", "right"})}).error().message,
              AllOf(HasSubstr("2 cameras"), HasSubstr("left, right")));
  EXPECT_THAT(OpenFrames({MakeTake("none", {})}).error().message, HasSubstr("no camera"));
  const StoredTake take = OrThrow(OpenTake(folder_ / "takes" / "two"));
  EXPECT_TRUE(OpenCamera(take, "right"));
  EXPECT_THAT(OpenCamera(take, "top").error().message, HasSubstr("no camera top"));
  ASSERT_TRUE(WriteFile(take.folder / "right.mkv", "altered"));
  EXPECT_THAT(OpenCamera(take, "right").error().message, HasSubstr("takes/two/right.mkv"));
}

TEST_F(OpenFramesTest, OfAPartComesWhatLiesInIt) {
  MakeTake("whole", {"left"});
  const TakePart part = {.of = "whole",
                         .start = std::chrono::milliseconds(1100),
                         .end = std::chrono::milliseconds(1200)};
  const auto source = OrThrow(OpenFrames({MakeTake("whole_01", {"left"}, part)}));
  for (int round = 0; round < 2; ++round) {
    const SeenFilm seen = ReadAll(*source);
    ASSERT_THAT(seen.frames, SizeIs(5));
    EXPECT_EQ(seen.frames[0].bar_px, BarOf(film_, 5));
    EXPECT_DOUBLE_EQ(seen.frames[4].time_s, 1.18);
    ASSERT_TRUE(source->Rewind());
  }
}

}  // namespace
}  // namespace articap
