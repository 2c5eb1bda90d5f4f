// SPDX-License-Identifier: MIT
#include "core/session.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <limits>

#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kHash = "0123456789abcdef";

SessionInfo SmallSession() {
  return {.speaker = "\u00c5sa \"the\" speaker",
          .map = "maps/own.toml",
          .rig = "head",
          .notes = "line one\nline \\ two\x01"};
}

TakeFile FileOf(FileRole role, const std::string& name, std::int64_t size_bytes) {
  TakeFile file;
  file.role = role;
  file.name = name;
  file.digest = {kHash, size_bytes};
  file.original_name = "\u00c9:\t" + name;
  return file;
}

TakeInfo SmallTake() {
  TakeFile markers = FileOf(FileRole::kMarkers, "take.c3d", 5'000'000'000);
  markers.rate_hz = 59.94005994005994;
  markers.markers = 35;
  markers.frames = 571;
  TakeFile audio = FileOf(FileRole::kAudio, "take.wav", 0);
  audio.offset = std::chrono::nanoseconds(-1'500'000'001);
  audio.rate_hz = 48000;
  audio.channels = 2;
  audio.frames = 456960;
  TakeFile labels = FileOf(FileRole::kLabels, "take.TextGrid", 77);
  labels.offset = std::chrono::nanoseconds(std::numeric_limits<std::int64_t>::max());
  TakeFile video = FileOf(FileRole::kVideo, "00001.MTS", 12);
  video.offset = std::chrono::nanoseconds(-20'000'000);
  video.rate_hz = 50;
  video.camera = "left";
  video.width = 1920;
  video.height = 1080;
  video.frames = 475;
  TakeFile next = video;
  next.name = "00002.MTS";
  next.part = 2;
  TakeFile sound = audio;
  sound.name = "00001.wav";
  sound.made_from = "00001.MTS";
  const TakeFile original = FileOf(FileRole::kOriginal, "take.mp3", 5);
  TakeInfo take;
  take.id = "take_v2";
  take.files = {markers, audio, labels, video, next, sound, original};
  return take;
}

TEST(SessionTomlTest, SessionsSurviveByteForByte) {
  for (const SessionInfo& session : {SmallSession(), SessionInfo{.speaker = "anna"}}) {
    const std::string text = WriteSessionInfo(session);
    const SessionInfo read = OrThrow(ParseSessionInfo(text, "session.toml"));
    EXPECT_EQ(read.speaker, session.speaker);
    EXPECT_EQ(read.map, session.map);
    EXPECT_EQ(read.rig, session.rig);
    EXPECT_EQ(read.notes, session.notes);
    EXPECT_EQ(WriteSessionInfo(read), text);
  }
}

TEST(SessionTomlTest, TakesSurviveByteForByte) {
  TakeInfo take = SmallTake();
  for (const auto& start : {std::optional<std::int64_t>(), {1'700'000'000'123'456'789}}) {
    take.clock_start_unix_ns = start;
    const std::string text = WriteTakeInfo(take);
    const TakeInfo read = OrThrow(ParseTakeInfo(text, "take.toml"));
    EXPECT_EQ(WriteTakeInfo(read), text);
    EXPECT_EQ(read.clock_start_unix_ns, start);
    ASSERT_THAT(read.files, SizeIs(7));
    EXPECT_EQ(read.files[0].rate_hz, take.files[0].rate_hz);
    EXPECT_EQ(read.files[0].digest.size_bytes, 5'000'000'000);
    EXPECT_EQ(read.files[1].offset, take.files[1].offset);
    EXPECT_EQ(read.files[2].role, FileRole::kLabels);
    EXPECT_EQ(read.files[2].offset, take.files[2].offset);
    EXPECT_EQ(read.files[4].camera, "left");
    EXPECT_EQ(read.files[4].part, 2);
    EXPECT_EQ(read.files[4].height, 1080);
    EXPECT_EQ(read.files[5].made_from, "00001.MTS");
    EXPECT_EQ(read.files[6].role, FileRole::kOriginal);
  }
}

// The message where `what` is replaced in a file that is right.
template <class Parse>
std::string FaultWith(std::string text, const std::string& what, const std::string& instead,
                      const Parse& parse) {
  const std::size_t place = text.find(what);
  EXPECT_NE(place, std::string::npos) << what;
  text.replace(place, what.size(), instead);
  const auto read = parse(text, "x.toml");
  return read ? "" : read.error().message;
}

TEST(SessionTomlTest, PartsOfTakesSurviveByteForByte) {
  TakeInfo take = SmallTake();
  take.part = {.of = "take",
               .start = std::chrono::nanoseconds(-5),
               .end = std::chrono::nanoseconds(std::numeric_limits<std::int64_t>::max())};
  const std::string text = WriteTakeInfo(take);
  const TakeInfo read = OrThrow(ParseTakeInfo(text, "take.toml"));
  EXPECT_EQ(read.part, take.part);
  EXPECT_EQ(WriteTakeInfo(read), text);
  const auto fault_with = [&](const std::string& what, const std::string& instead) {
    return FaultWith(text, what, instead, ParseTakeInfo);
  };
  EXPECT_THAT(fault_with("part_of = \"take\"", "part_of = \"take_v2\""), HasSubstr("itself"));
  EXPECT_THAT(fault_with("part_of = \"take\"", "part_of = \"../x\""), HasSubstr("'part_of'"));
  EXPECT_THAT(fault_with("part_of = \"take\"", ""), HasSubstr("'start_ns' is said"));
  EXPECT_THAT(fault_with("start_ns = -5", ""), HasSubstr("'start_ns' is missing"));
  EXPECT_THAT(fault_with("end_ns = 9223372036854775807", "end_ns = -5"), HasSubstr("not later"));
}

TEST(SessionTomlTest, FaultsOfSessionsAreNamed) {
  const auto fault_with = [](const std::string& what, const std::string& instead) {
    return FaultWith(WriteSessionInfo(SmallSession()), what, instead, ParseSessionInfo);
  };
  EXPECT_THAT(fault_with("notes", "note"), HasSubstr("x.toml: 'note' is no key"));
  EXPECT_THAT(fault_with("format = 1", "format = 2\nnew = 1"), HasSubstr("'format' is 2"));
  EXPECT_THAT(fault_with("format = 1", "format = \"1\""), HasSubstr("'format'"));
  EXPECT_THAT(fault_with("speaker", "#"), HasSubstr("'speaker' is missing"));
  for (const char* path : {"../own.toml", "/etc/own.toml", "maps//own.toml", "maps/", "", ".",
                           "maps/../own.toml", "a\\\\b", "c:own"})
    EXPECT_THAT(fault_with("maps/own.toml", path), HasSubstr("x.toml: 'map' is")) << path;
}

TEST(SessionTomlTest, FaultsOfTakesAreNamed) {
  const auto fault_with = [](const std::string& what, const std::string& instead) {
    return FaultWith(WriteTakeInfo(SmallTake()), what, instead, ParseTakeInfo);
  };
  EXPECT_THAT(fault_with("xxh3", "md5"), HasSubstr("x.toml, file 1: 'md5' is no key"));
  for (const char* hash : {"0123456789abcde", "0123456789ABCDEF", "0123456789abcdeg", ""})
    EXPECT_THAT(fault_with(kHash, hash), HasSubstr("x.toml, file 1: 'xxh3' is")) << hash;
  for (const char* name : {"../x", "/etc/passwd", "..", ".hidden", "-f", "a/b", "take.toml",
                           "take.wav", "", "nul\\u0000"})
    EXPECT_THAT(fault_with("\"take.c3d\"", '"' + std::string(name) + '"'), HasSubstr("'name' is"))
        << name;
  EXPECT_THAT(fault_with("take_v2", ".."), HasSubstr("x.toml: 'id' is"));
  EXPECT_THAT(fault_with("complete", "begun"), HasSubstr("'state' is \"begun\""));
  EXPECT_THAT(fault_with("\"audio\"", "\"film\""), HasSubstr("file 2: 'role' is \"film\""));
  EXPECT_THAT(fault_with("part = 2", "part = 3"), HasSubstr("file 5: 'part' is 3"));
  EXPECT_THAT(fault_with("part = 1", "part = 0"), HasSubstr("file 4: 'part' is 0"));
  EXPECT_THAT(fault_with("camera = \"left\"", "camera = \"a b\""), HasSubstr("'camera' is"));
  EXPECT_THAT(fault_with("width = 1920", "width = 0"), HasSubstr("'width' is 0"));
  EXPECT_THAT(fault_with("made_from = \"00001.MTS\"", "made_from = \"take.wav\""),
              HasSubstr("file 6: 'made_from' is \"take.wav\""));
  EXPECT_THAT(fault_with("size_bytes = 0", "size_bytes = -1"), HasSubstr("'size_bytes' is -1"));
  EXPECT_THAT(fault_with("offset_ns = 0", "offset_ns = 0.5"), HasSubstr("'offset_ns'"));
  EXPECT_THAT(fault_with("rate_hz = 48000.0", "rate_hz = nan"), HasSubstr("file 2: 'rate_hz'"));
  EXPECT_THAT(fault_with("rate_hz = 48000.0", "rate_hz = 0"), HasSubstr("file 2: 'rate_hz'"));
  EXPECT_THAT(fault_with("channels = 2", "markers = 2"), HasSubstr("'markers' is no key"));
  EXPECT_THAT(fault_with("channels = 2", "channels = 0"), HasSubstr("'channels' is 0"));
}

TEST(SafeNameTest, NamesBecomeSafe) {
  EXPECT_EQ(SafeNameOf("take-01.c3d"), "take-01.c3d");
  EXPECT_EQ(SafeNameOf("Take 01 (b).c3d"), "Take_01__b_.c3d");
  EXPECT_EQ(SafeNameOf("\u00c5sa.wav"), "_sa.wav");
  EXPECT_EQ(SafeNameOf("../../etc"), "_._.._etc");
  EXPECT_EQ(SafeNameOf("-rf"), "_rf");
  EXPECT_EQ(SafeNameOf("\u00c5\u00c4"), "take");
  EXPECT_EQ(SafeNameOf(""), "take");
  for (const std::string& name : {std::string(300, 'x'), std::string("\x80.\xff"),
                                  std::string("..."), std::string("a\0b", 3)})
    EXPECT_TRUE(IsSafeName(SafeNameOf(name))) << SafeNameOf(name);
}

class RecordingTest : public testing::Test {
 protected:
  RecordingTest() {
    EXPECT_TRUE(WriteFile(folder_ / "session.toml", WriteSessionInfo({.speaker = "a"})));
  }
  ~RecordingTest() override { fs::remove_all(folder_); }

  fs::path TakeFolder(const std::string& id) const { return folder_ / "takes" / id; }

  void AddTake(const std::string& id) const {
    TakeInfo take = SmallTake();
    take.id = id;
    for (TakeFile& file : take.files) {
      const std::string bytes = "bytes of " + file.name;
      EXPECT_TRUE(WriteFile(TakeFolder(id) / file.name, bytes));
      file.digest = {HashOf(bytes), static_cast<std::int64_t>(bytes.size())};
    }
    EXPECT_TRUE(WriteFile(TakeFolder(id) / "take.toml", WriteTakeInfo(take)));
  }

  const fs::path folder_ = MakeTemporaryFolder("articap_session_test");
};

TEST_F(RecordingTest, TakesComeInOrderWithTheirFiles) {
  for (const char* id : {"take10", "take2", "take2_v2", "a", "take02"}) AddTake(id);
  fs::create_directories(TakeFolder("unfinished"));
  const Recording recording = OrThrow(OpenSession(folder_));
  std::vector<std::string> ids;
  for (const StoredTake& take : recording.takes()) ids.push_back(take.info.id);
  EXPECT_THAT(ids, ElementsAre("a", "take02", "take2", "take2_v2", "take10"));
  ASSERT_THAT(recording.unfinished(), SizeIs(1));
  EXPECT_EQ(recording.unfinished()[0].filename(), "unfinished");
  const StoredTake* const take = recording.Find("take10");
  ASSERT_NE(take, nullptr);
  EXPECT_EQ(recording.Find("take1"), nullptr);
  const auto audio = take->FilesOf(FileRole::kAudio);
  ASSERT_THAT(audio, SizeIs(2));  // the second is a video's sound
  EXPECT_TRUE(take->PathOf(audio[0]).is_absolute());
  EXPECT_EQ(ReadFile(take->PathOf(audio[0])).value(), "bytes of take.wav");
}

TEST_F(RecordingTest, ACamerasPartsAreOneVideo) {
  AddTake("t");
  const StoredTake take = OrThrow(OpenTake(TakeFolder("t")));
  EXPECT_THAT(take.cameras(), ElementsAre("left"));
  const auto video = take.VideoOf("left");
  ASSERT_THAT(video, SizeIs(2));
  EXPECT_EQ(video[1].name, "00002.MTS");
  EXPECT_THAT(take.VideoOf("right"), IsEmpty());
}

TEST_F(RecordingTest, APartHasTheFilesOfTheWhole) {
  AddTake("whole");
  TakeInfo part = OrThrow(OpenTake(TakeFolder("whole"))).info;
  part.id = "whole_01";
  part.part = {.of = "whole",
               .start = std::chrono::milliseconds(-500),
               .end = std::chrono::milliseconds(9600)};
  EXPECT_TRUE(WriteFile(TakeFolder("whole_01") / "take.toml", WriteTakeInfo(part)));
  const StoredTake take = OrThrow(OpenTake(TakeFolder("whole_01")));
  EXPECT_THAT(VerifyTake(take), IsEmpty());
  EXPECT_EQ(ReadFile(take.PathOf(take.info.files[0])).value(), "bytes of take.c3d");
  // The markers last 571 frames from 0 on; the audio of 9.52 s begins at -1.5 s.
  EXPECT_NEAR(take.DurationOf_s(take.info.files[0]), 571 / 59.94005994005994, 1e-9);
  EXPECT_NEAR(take.DurationOf_s(take.info.files[1]), 9.52 - 1, 1e-6);
  fs::remove(TakeFolder("whole") / "take.c3d");
  EXPECT_THAT(VerifyTake(take), ElementsAre(HasSubstr("takes/whole/take.c3d is missing")));
}

TEST_F(RecordingTest, EveryChangeOfAFileIsNamed) {
  AddTake("t");
  const StoredTake take = OrThrow(OpenTake(TakeFolder("t")));
  EXPECT_THAT(VerifyTake(take), IsEmpty());
  EXPECT_TRUE(WriteFile(TakeFolder("t") / "take.c3d", "bytes of take.c3D"));
  EXPECT_TRUE(WriteFile(TakeFolder("t") / "take.wav", "bytes of take.wav "));
  fs::remove(TakeFolder("t") / "take.TextGrid");
  EXPECT_THAT(VerifyTake(take),
              ElementsAre(AllOf(HasSubstr("takes/t/take.c3d"), HasSubstr("altered")),
                          HasSubstr("takes/t/take.wav has 18 bytes, and had 17"),
                          HasSubstr("takes/t/take.TextGrid is missing")));
}

TEST_F(RecordingTest, WhatIsNoSessionOrTakeIsRefused) {
  EXPECT_THAT(OpenSession(folder_ / "none").error().message, HasSubstr("no such folder"));
  EXPECT_THAT(OpenSession(folder_.parent_path()).error().message, HasSubstr("no session.toml"));
  AddTake("t");
  fs::rename(TakeFolder("t"), TakeFolder("renamed"));
  EXPECT_THAT(OpenSession(folder_).error().message,
              AllOf(HasSubstr("\"t\""), HasSubstr("\"renamed\"")));
  EXPECT_TRUE(WriteFile(TakeFolder("renamed") / "take.toml", "format = 1"));
  EXPECT_THAT(OpenSession(folder_).error().message,
              AllOf(HasSubstr("renamed/take.toml"), HasSubstr("'id' is missing")));
}

TEST_F(RecordingTest, CopiesAreTheSameAndNeverReplaceAnything) {
  const fs::path from = folder_ / "from", to = folder_ / "to";
  const std::string bytes(3'000'001, 'b');
  EXPECT_TRUE(WriteFile(from, bytes));
  const FileDigest digest = OrThrow(CopyFile(from, to));
  EXPECT_EQ(digest, (FileDigest{HashOf(bytes), 3'000'001}));
  EXPECT_EQ(OrThrow(DigestOf(to)), digest);
  EXPECT_THAT(CopyFile(from, to).error().message, HasSubstr("there already"));
  EXPECT_THAT(CopyFile(folder_ / "none", folder_ / "new").error().message, HasSubstr("none"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 3);  // with session.toml
}

}  // namespace
}  // namespace articap
