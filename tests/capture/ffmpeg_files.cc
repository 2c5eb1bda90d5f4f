// SPDX-License-Identifier: MIT
#include "tests/capture/ffmpeg_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "core/file_io.h"

namespace articap {
namespace {

// Of a pixel, 0 to 255.
int LevelAt(const BarFilm& film, int number, int x, int y) {
  const int bar = kFirstBar_px + film.step_px * number;
  if (x >= bar && x < bar + kBarWidth_px) return 230;
  return 20 + (x + y) / 8;
}

int LevelOf(const ImageView& image, int x, int y) {
  const std::uint8_t* const row = image.row(y);
  switch (image.format) {
    case PixelFormat::kGray8:
      return row[x];
    case PixelFormat::kGray16: {
      std::uint16_t value = 0;
      std::memcpy(&value, row + 2 * x, sizeof value);
      return value >> 8;
    }
    case PixelFormat::kRgb8:
      break;
  }
  return row[3 * x + 1];
}

}  // namespace

bool HasFfmpeg() { return std::system("ffmpeg -version >/dev/null 2>&1") == 0; }

void RunFfmpeg(const std::filesystem::path& folder, const std::string& arguments) {
  const std::string command =
      fmt::format("cd '{}' && ffmpeg -nostdin -hide_banner -loglevel error -y {} 2>ffmpeg.log",
                  folder.string(), arguments);
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error(command + "\n" + ReadFile(folder / "ffmpeg.log").value_or(""));
}

std::string WriteBars(const std::filesystem::path& folder, const BarFilm& film) {
  std::string bytes;
  for (int number = 0; number < film.num_frames; ++number)
    for (int y = 0; y < film.height; ++y)
      for (int x = 0; x < film.width; ++x) {
        const int level = LevelAt(film, number, x, y);
        if (film.gray16) bytes += static_cast<char>(17 * y % 256);  // the low byte
        bytes += static_cast<char>(level);
      }
  std::ofstream(folder / "bars.gray", std::ios::binary) << bytes;
  return fmt::format("-f rawvideo -pix_fmt {} -s {}x{} -r {} -i bars.gray ",
                     film.gray16 ? "gray16le" : "gray", film.width, film.height, film.rate_hz);
}

double BarAt(const ImageView& image, bool along_y) {
  int darkest = 255, brightest = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      darkest = std::min(darkest, LevelOf(image, x, y));
      brightest = std::max(brightest, LevelOf(image, x, y));
    }
  double sum = 0, count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (2 * LevelOf(image, x, y) > darkest + brightest) {
        sum += along_y ? y : x;
        ++count;
      }
  return sum / count;
}

SeenFilm ReadAll(FrameSource& source, bool along_y) {
  SeenFilm seen;
  while (true) {
    const Result<std::optional<Frame>> frame = source.Next();
    if (!frame) {
      seen.errors.push_back(frame.error().message);
      if (seen.errors.size() > 1000) throw std::runtime_error("errors without end");
      continue;
    }
    if (!*frame) return seen;
    const Frame& shown = **frame;
    EXPECT_EQ(shown.index, static_cast<std::int64_t>(seen.frames.size()));
    seen.frames.push_back({SecondsOf(shown.time), BarAt(shown.image, along_y), shown.status,
                           shown.picture_from_image, shown.image.width, shown.image.height,
                           shown.image.format});
  }
}

}  // namespace articap
