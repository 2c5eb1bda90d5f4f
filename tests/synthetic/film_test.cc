// SPDX-License-Identifier: MIT
#include "synthetic/film.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "rig/default_head/default_head.h"
#include "synthetic/board_session.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

FilmOptions Small() {
  FilmOptions options;
  options.width = 320;
  options.height = 180;
  // Nothing but the dots is bright, so that the light is theirs.
  options.look.retro_reflective = true;
  options.look.dot_diameter_mm = 6;
  return options;
}

SensorOptions Noiseless() {
  SensorOptions sensor;
  sensor.format = PixelFormat::kGray16;
  sensor.noise = false;
  sensor.blur_px = 0;
  return sensor;
}

// A speaker who is silent and whose head moves fast.
FilmedSpeaker MakeSpeaker(const FilmOptions& options) {
  const FaceRig head = OrThrow(MakeDefaultHead());
  const MarkerSet set =
      WithDots(OrThrow(ReadMarkerSet(SourceFolder() / "maps" / "mirror6.toml")), options.look);
  SyntheticTakeOptions take;
  take.speaker_ahead = true;
  take.speech.num_sentences = 1;
  take.speech.rest_s = 0.2;
  take.speech.effort = 0;
  take.speech.rate_hz = 10;
  take.head.max_rotation_deg = 25;
  return FilmedSpeaker(head, OrThrow(SynthesizeTake(head, set, take)), options.look);
}

Studio MakeStudio(const FilmOptions& options) {
  return Studio(OrThrow(CamerasByName("ring1", 0, 1, CameraModelOf(options))));
}

Film MakeFilm(const FilmOptions& options, const SensorOptions& sensor, std::uint64_t seed = 1) {
  return Film(MakeSpeaker(options), MakeStudio(options), options, sensor, seed);
}

struct CsvDot {
  int frame = 0;
  double time_s = 0;
  std::string view, marker;
  Eigen::Vector2d center_px;
  double visible = 0;
};

std::vector<CsvDot> ParseDots(const std::string& text) {
  std::vector<CsvDot> dots;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    dots.push_back({std::stoi(row.at(0)),
                    std::stod(row.at(1)),
                    row.at(2),
                    row.at(3),
                    {std::stod(row.at(4)), std::stod(row.at(5))},
                    std::stod(row.at(6))});
  }
  return dots;
}

// The middle of what is bright around a place.
Eigen::Vector2d BrightNear(const Image& image, const Eigen::Vector2d& near_px, int reach_px) {
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  double light = 0;
  const auto middle_x = static_cast<int>(std::lround(near_px.x()));
  const auto middle_y = static_cast<int>(std::lround(near_px.y()));
  for (int y = middle_y - reach_px; y <= middle_y + reach_px; ++y)
    for (int x = middle_x - reach_px; x <= middle_x + reach_px; ++x) {
      std::uint16_t value = 0;
      std::memcpy(&value, image.view().row(y) + 2 * x, sizeof value);
      const double over = std::max(0.0, value / 65535.0 - 0.1);
      sum_px += over * Eigen::Vector2d(x, y);
      light += over;
    }
  return sum_px / light;
}

TEST(FilmTest, TheSameSeedGivesTheSamePictures) {
  const Film once = MakeFilm(Small(), MachineVision());
  const Film again = MakeFilm(Small(), MachineVision());
  const Film other = MakeFilm(Small(), MachineVision(), 2);
  const Image picture = once.Picture(7, 0);
  EXPECT_EQ(picture.bytes, again.Picture(7, 0).bytes);
  EXPECT_NE(picture.bytes, other.Picture(7, 0).bytes) << "other noise";
  EXPECT_NE(picture.bytes, once.Picture(8, 0).bytes);
  EXPECT_EQ(once.DotsOf(7), again.DotsOf(7));
}

TEST(FilmTest, TheTableOfDotsIsOfThePictures) {
  const Film film = MakeFilm(Small(), Noiseless());
  const std::vector<CsvDot> dots = ParseDots(film.DotsOf(4));
  ASSERT_EQ(dots.size(), 6u);
  EXPECT_EQ(dots[0].frame, 5);
  EXPECT_DOUBLE_EQ(dots[0].time_s, 0.4);
  EXPECT_EQ(dots[0].view, "camera1");
  EXPECT_EQ(dots[0].marker, "nose");
  const Image picture = film.Picture(4, 0);
  // BrightNear() loses up to a tenth of a pixel in each of the twelve on the edge of a dot of 4 px
  // (SD 0.03): some 0.015 px a coordinate, and this is four times that.
  constexpr double kThreshold_px = 0.06;
  for (const CsvDot& dot : dots) {
    EXPECT_EQ(dot.visible, 1);
    EXPECT_LT((BrightNear(picture, dot.center_px, 4) - dot.center_px).norm(), kThreshold_px);
  }
}

// How far dots go from one frame to the next.
double FastestStep(const Film& film, int frame) {
  const std::vector<CsvDot> now = ParseDots(film.DotsOf(frame));
  const std::vector<CsvDot> next = ParseDots(film.DotsOf(frame + 1));
  double fastest_px = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    fastest_px = std::max(fastest_px, (next[i].center_px - now[i].center_px).norm());
  return fastest_px;
}

int FastestFrame(const Film& film) {
  int fastest = 1;
  for (int frame = 2; frame + 2 < film.num_frames(); ++frame)
    if (FastestStep(film, frame) > FastestStep(film, fastest)) fastest = frame;
  return fastest;
}

TEST(FilmTest, AShutterThatIsOpenLongSmearsDotsAboutTheirPlace) {
  FilmOptions options = Small();
  const Film sharp = MakeFilm(options, Noiseless());
  const int frame = FastestFrame(sharp);
  ASSERT_GT(FastestStep(sharp, frame), 1.5) << "px a frame";
  options.shutter_s = 0.05;
  options.blur_instants = 9;
  const Film smeared = MakeFilm(options, Noiseless());
  const Image sharp_picture = sharp.Picture(frame, 0), smeared_picture = smeared.Picture(frame, 0);
  EXPECT_NE(sharp_picture.bytes, smeared_picture.bytes);
  int compared = 0;
  for (const CsvDot& dot : ParseDots(sharp.DotsOf(frame))) {
    if (dot.visible < 1) continue;
    EXPECT_LT((BrightNear(smeared_picture, dot.center_px, 5) - dot.center_px).norm(), 0.1);
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

// A dot in row y has the time of that row.
TEST(FilmTest, ARollingShutterHasATimeForEveryRow) {
  FilmOptions options = Small();
  const FilmedSpeaker speaker = MakeSpeaker(options);
  const Studio studio = MakeStudio(options);
  const int frame = FastestFrame(MakeFilm(options, Noiseless()));
  options.readout_s = 0.1;  // a whole frame
  options.readout_bands = 90;
  const Image picture = MakeFilm(options, Noiseless()).Picture(frame, 0);
  const auto truth_at = [&](double at_frame, int dot) {
    return TruthOfDots(studio, speaker.At(at_frame, studio))[0][dot];
  };
  double most_moved_px = 0;
  for (int dot = 0; dot < 6; ++dot) {
    const DotTruth middle = truth_at(frame, dot);
    DotTruth expected = middle;
    for (int round = 0; round < 4; ++round)
      expected = truth_at(frame + expected.center_px.y() / (options.height - 1) - 0.5, dot);
    if (expected.visible < 1) continue;
    EXPECT_LT((BrightNear(picture, expected.center_px, 5) - expected.center_px).norm(), 0.06);
    most_moved_px = std::max(most_moved_px, (expected.center_px - middle.center_px).norm());
  }
  EXPECT_GT(most_moved_px, 0.4);
}

TEST(FilmTest, ImpossibleFilmsAreRefused) {
  FilmOptions options;
  options.shutter_s = 0.05;
  EXPECT_THAT(CheckOptions(options, 25).has_value(), false);
  EXPECT_THAT(CheckOptions(options, 25).error().message, testing::HasSubstr("shutter_s"));
  options = {};
  options.width = 3;
  EXPECT_THAT(CheckOptions(options, 25).error().message, testing::HasSubstr("width"));
  options = {};
  options.readout_bands = 100000;
  EXPECT_THAT(CheckOptions(options, 25).error().message, testing::HasSubstr("readout_bands"));
  EXPECT_FALSE(CamerasByName("ring99", 0, 1, {}));
  EXPECT_FALSE(CamerasByName("cube", 0, 1, {}));
  EXPECT_EQ(OrThrow(CamerasByName("ring4", 0, 1, {})).array.cameras.size(), 4u);
}

}  // namespace
}  // namespace articap
