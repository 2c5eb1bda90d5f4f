// SPDX-License-Identifier: MIT
#include "apps/session_import.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "apps/take_input.h"
#include "core/file_io.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// One channel of 8 bits at 100 Hz, 4 frames.
constexpr char kWav[] =
    "RIFF\x28\0\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0\x64\0\0\0\x64\0\0\0\x01\0\x08\0"
    "data\x04\0\0\0\x80\x80\x80\x80";

class SessionImportTest : public ::testing::Test {
 protected:
  SessionImportTest() {
    const fs::path demo = SourceFolder() / "recordings" / "demo";
    fs::copy_file(demo / "take.c3d", folder_ / "take.c3d");
    fs::copy_file(demo / "labels.TextGrid", folder_ / "labels.TextGrid");
    EXPECT_TRUE(WriteFile(folder_ / "sound.wav", std::string_view(kWav, sizeof kWav - 1)));
    EXPECT_TRUE(WriteFile(session_ / kSessionFileName, WriteSessionInfo({.speaker = "anna"})));
  }
  ~SessionImportTest() override { fs::remove_all(folder_); }

  Import Prepare(const std::vector<std::string>& names, const ImportOptions& options = {}) const {
    std::vector<std::string> paths;
    for (const std::string& name : names) paths.push_back((folder_ / name).string());
    return OrThrow(PrepareImport(paths, options));
  }

  const fs::path folder_ = MakeTemporaryFolder("articap_session_import_test");
  const fs::path session_ = folder_ / "session";
};

TEST_F(SessionImportTest, AFailureHalfWayLeavesNoTake) {
  const Import import = Prepare({"take.c3d", "sound.wav"});
  fs::remove(folder_ / "sound.wav");
  EXPECT_THAT(StoreTake(session_, import).error().message, HasSubstr("sound.wav"));
  EXPECT_TRUE(fs::is_empty(session_ / kTakesFolderName));
}

TEST_F(SessionImportTest, AnUnfinishedFolderIsNotTakenOver) {
  const fs::path begun = session_ / kTakesFolderName / "take" / "take.c3d.1.part";
  EXPECT_TRUE(WriteFile(begun, "half"));
  EXPECT_EQ(OrThrow(StoreTake(session_, Prepare({"take.c3d"}))).take.info.id, "take_v2");
  EXPECT_EQ(OrThrow(StoreTake(session_, Prepare({"take.c3d"}))).take.info.id, "take_v3");
  EXPECT_EQ(ReadFile(begun).value(), "half");
}

TEST_F(SessionImportTest, LabelsMoveWithTheAudio) {
  ImportOptions options;
  options.audio_offset = std::chrono::milliseconds(-250);
  const StoredTake take =
      OrThrow(StoreTake(session_, Prepare({"labels.TextGrid", "take.c3d", "sound.wav"}, options)))
          .take;
  EXPECT_THAT(VerifyTake(take), IsEmpty());
  EXPECT_EQ(take.FilesOf(FileRole::kMarkers)[0].offset.count(), 0);
  EXPECT_EQ(take.FilesOf(FileRole::kAudio)[0].offset, options.audio_offset);
  const TakeInput own = OrThrow(FindTakeInput(take.folder.string(), ""));
  EXPECT_EQ(own.markers, (take.folder / "take.c3d").string());
  EXPECT_EQ(own.labels, (take.folder / "labels.TextGrid").string());
  EXPECT_DOUBLE_EQ(own.labels_shift_s, -0.25);
  const TakeInput given = OrThrow(FindTakeInput(take.folder.string(), "other.TextGrid"));
  EXPECT_EQ(given.labels, "other.TextGrid");
  EXPECT_EQ(given.labels_shift_s, 0);
}

TEST_F(SessionImportTest, ATakeBringsTheMapAndTheRigOfItsSession) {
  const StoredTake take = OrThrow(StoreTake(session_, Prepare({"take.c3d"}))).take;
  EXPECT_EQ(OrThrow(FindTakeInput(take.folder.string(), "")).map, "");
  EXPECT_TRUE(WriteFile(session_ / "own.toml", "name = \"own\""));
  EXPECT_TRUE(WriteFile(session_ / kSessionFileName,
                        WriteSessionInfo({.speaker = "a", .map = "own.toml", .rig = "head"})));
  const TakeInput own = OrThrow(FindTakeInput(take.folder.string(), ""));
  EXPECT_EQ(own.map, (take.folder.parent_path().parent_path() / "own.toml").string());
  EXPECT_EQ(own.rig_folder, (take.folder.parent_path().parent_path() / "head").string());
  EXPECT_TRUE(WriteFile(session_ / kSessionFileName,
                        WriteSessionInfo({.speaker = "a", .map = "spectacles30"})));
  EXPECT_EQ(OrThrow(FindTakeInput(take.folder.string(), "")).map, "spectacles30");
}

TEST_F(SessionImportTest, AVideoComesWithItsSoundAndLabelsGoWithIt) {
  const std::string made =
      "cd '" + folder_.string() +
      "' && ffmpeg -nostdin -loglevel error -f lavfi -i testsrc=s=64x48:r=25:d=0.4 -itsoffset 0.1 "
      "-f lavfi -i sine=r=48000:d=0.2 -pix_fmt yuv420p -c:v libx264 -c:a pcm_s16le "
      "-movie_timescale 48000 left.mov 2>/dev/null";
  if (std::system(made.c_str()) != 0)
    GTEST_SKIP() << "the program ffmpeg, which makes the video, is not there";
  ImportOptions options;
  options.video_offset = std::chrono::milliseconds(-40);
  const StoredTake take =
      OrThrow(StoreTake(session_, Prepare({"left.mov", "labels.TextGrid"}, options))).take;
  EXPECT_EQ(take.info.id, "left");
  EXPECT_THAT(VerifyTake(take), IsEmpty());
  EXPECT_EQ(take.FilesOf(FileRole::kLabels)[0].offset, options.video_offset);
  const TakeFile video = take.VideoOf("left").at(0);
  EXPECT_EQ(video.offset, options.video_offset);
  EXPECT_EQ(video.rate_hz, 25);
  EXPECT_EQ(video.frames, 10);
  EXPECT_EQ(video.width, 64);
  const TakeFile sound = take.FilesOf(FileRole::kAudio).at(0);
  EXPECT_EQ(sound.name, "left.wav");
  EXPECT_EQ(sound.made_from, "left.mov");
  EXPECT_EQ(sound.offset, std::chrono::milliseconds(60));
  EXPECT_EQ(sound.frames, 9600);
}

TEST_F(SessionImportTest, NoFileTakesTheNameOfAnother) {
  fs::create_directory(folder_ / "other");
  fs::copy_file(folder_ / "sound.wav", folder_ / "other" / "SOUND.wav");
  const Import import = Prepare({"sound.wav", "other/SOUND.wav"});
  EXPECT_EQ(import.files[0].info.name, "sound.wav");
  EXPECT_EQ(import.files[1].info.name, "SOUND_2.wav");
  EXPECT_EQ(import.files[1].info.original_name, "SOUND.wav");
}

}  // namespace
}  // namespace articap
