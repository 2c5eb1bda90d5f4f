// SPDX-License-Identifier: MIT
#include "apps/calibrate_input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "apps/camera_input.h"
#include "apps/progress.h"
#include "calib/board_finder.h"
#include "capture/open_frames.h"
#include "core/session.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

// "left03.jpg" -> 3: the last number in a picture's name.
std::optional<std::int64_t> NumberIn(const std::string& name) {
  const std::string stem = fs::path(name).stem().string();
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto last = std::find_if(stem.rbegin(), stem.rend(), is_digit);
  if (last == stem.rend()) return std::nullopt;
  const auto first = std::find_if_not(last, stem.rend(), is_digit);
  const std::string digits(first.base(), last.base());
  constexpr std::size_t kMostDigits = 17;
  if (digits.size() > kMostDigits) return std::nullopt;
  return std::stoll(digits);
}

// Cameras name pictures of one instant by one number, but not every camera has every picture.
void NumberByName(std::vector<SeenCamera>& cameras) {
  std::vector<std::vector<std::int64_t>> numbers;
  for (const SeenCamera& camera : cameras) {
    std::set<std::pair<std::int64_t, bool>> seen;
    numbers.emplace_back();
    for (const BoardSighting& sighting : camera.sightings.sightings) {
      const auto number = NumberIn(sighting.source);
      if (!number || !seen.insert({*number, sighting.mirrored}).second) return;
      numbers.back().push_back(*number);
    }
  }
  for (std::size_t i = 0; i < cameras.size(); ++i)
    for (std::size_t k = 0; k < numbers[i].size(); ++k)
      cameras[i].sightings.sightings[k].frame = numbers[i][k];
}

SeenCamera MakeSeenCamera(const std::string& name, const Sightings& found) {
  SeenCamera camera;
  camera.sightings.camera = name;
  camera.sightings.width = found.width;
  camera.sightings.height = found.height;
  camera.is_video = found.is_video;
  for (const FoundBoard& board : found.found) camera.sightings.sightings.push_back(board.sighting);
  // Of a video's thousands of frames nobody wants to read why each was not used.
  if (!found.is_video)
    for (const SetAside& picture : found.set_aside)
      camera.set_aside.push_back(
          fmt::format("{} is set aside: {}", picture.source, picture.reason));
  return camera;
}

Result<Sightings> LookForBoards(FrameSource& source, const BoardSpec& board,
                                const BoardInput& input) {
  return WithProgress("looking for the board in " + source.info().name, [&](Progress& progress) {
    return FindBoards(source, board, input.detect, [&](double part) { progress.SetPart(part); });
  });
}

Result<void> AddKnownLens(const BoardInput& input, SeenCamera& camera) {
  if (input.lenses.empty()) return {};
  const Result<CameraArray> lenses = ReadCameras(input.lenses, input.read);
  if (!lenses) return tl::unexpected(lenses.error());
  CameraSightings& of = camera.sightings;
  const Result<Lens> lens = LensFor(*lenses, input.lenses, of.camera, of.width, of.height);
  if (!lens) return tl::unexpected(lens.error());
  of.lens = *lens;
  return {};
}

// Of the videos the frames that any of them would choose.
void KeepChosenInstants(const BoardSpec& board, const ViewChoiceOptions& options,
                        const std::vector<Sightings>& found, std::vector<SeenCamera>& cameras) {
  std::set<std::int64_t> chosen;
  for (const Sightings& of_camera : found)
    for (const FoundBoard& view : ChooseViews(of_camera, board, options).views)
      chosen.insert(view.sighting.frame);
  for (SeenCamera& camera : cameras)
    std::erase_if(camera.sightings.sightings,
                  [&](const BoardSighting& sighting) { return !chosen.contains(sighting.frame); });
}

std::string NameOfPath(const std::string& path) {
  const fs::path clean = fs::path(path).lexically_normal();
  const fs::path last = clean.filename().empty() ? clean.parent_path() : clean;
  return fs::is_directory(last) ? last.filename().string() : last.stem().string();
}

// Of left01.jpg, left02.jpg: "left"; of one path its own name.
std::string CommonNameOf(const std::vector<std::string>& paths) {
  std::string common = NameOfPath(paths.front());
  if (paths.size() == 1) return common;
  for (const std::string& path : paths) {
    const std::string name = NameOfPath(path);
    const auto differ = std::mismatch(common.begin(), common.end(), name.begin(), name.end());
    common.erase(differ.first, common.end());
  }
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const auto last = std::find_if(common.rbegin(), common.rend(), is_letter);
  common.erase(last.base(), common.end());
  return common.empty() ? "camera" : common;
}

}  // namespace

void AddBoardInput(VerbLine& line, BoardInput& input) {
  line.Flag("--board", input.board, "BOARD",
            "chessboard:COLUMNSxROWS:SQUARE_MM (inner corners) or "
            "charuco:COLUMNSxROWS:SQUARE_MM:MARKER_MM[:DICTIONARY] (squares)")
      ->required();
  line.Flag("--lenses", input.lenses, "FILE", "a calibration whose lenses are known already");
  line.Stage("detect", input.detect, "detect");
  line.Stage("choose", input.choose, "choose");
  line.Stage("read", input.read);
}

Result<SeenCamera> SeeOneCamera(const BoardSpec& board, const BoardInput& input) {
  const std::vector<fs::path> paths(input.paths.begin(), input.paths.end());
  const auto source = OpenFrames(paths);
  if (!source) return tl::unexpected(source.error());
  Result<Sightings> found = LookForBoards(**source, board, input);
  if (!found) return tl::unexpected(found.error());
  if (found->is_video) found->found = ChooseViews(*found, board, input.choose).views;
  SeenCamera camera = MakeSeenCamera(SafeNameOf(CommonNameOf(input.paths)), *found);
  if (const auto known = AddKnownLens(input, camera); !known) return tl::unexpected(known.error());
  return camera;
}

Result<std::vector<NamedSource>> OpenCameras(const std::string& path) {
  std::vector<NamedSource> sources;
  if (!IsTakeFolder(path)) {
    auto source = OpenFrames({path});
    if (!source) return tl::unexpected(source.error());
    sources.push_back({SafeNameOf(NameOfPath(path)), *std::move(source)});
    return sources;
  }
  const Result<StoredTake> take = OpenTake(path);
  if (!take) return tl::unexpected(take.error());
  for (const std::string& name : take->cameras()) {
    auto source = OpenCamera(*take, name);
    if (!source) return tl::unexpected(source.error());
    sources.push_back({name, *std::move(source)});
  }
  if (sources.empty())
    return Fail(fmt::format("{}: the take holds no video; name one that does", path));
  return sources;
}

Result<std::vector<SeenCamera>> SeeCameras(const BoardSpec& board, const BoardInput& input,
                                           bool choose_views) {
  std::vector<SeenCamera> cameras;
  std::vector<Sightings> all_found;
  bool any_video = false;
  for (const std::string& path : input.paths) {
    Result<std::vector<NamedSource>> sources = OpenCameras(path);
    if (!sources) return tl::unexpected(sources.error());
    for (NamedSource& named : *sources) {
      Result<Sightings> found = LookForBoards(*named.source, board, input);
      if (!found) return tl::unexpected(found.error());
      cameras.push_back(MakeSeenCamera(named.name, *found));
      any_video = any_video || found->is_video;
      all_found.push_back(*std::move(found));
      if (const auto known = AddKnownLens(input, cameras.back()); !known)
        return tl::unexpected(known.error());
    }
  }
  std::set<std::string> names;
  for (const SeenCamera& camera : cameras)
    if (!names.insert(camera.sightings.camera).second)
      return Fail(fmt::format("two cameras are called {}; rename a folder or a video",
                              camera.sightings.camera));
  if (any_video && choose_views) KeepChosenInstants(board, input.choose, all_found, cameras);
  if (!any_video) NumberByName(cameras);
  return cameras;
}

Result<Lens> LensFor(const CameraArray& lenses, const std::string& file, const std::string& camera,
                     int width, int height) {
  const auto by_name = std::find_if(lenses.cameras.begin(), lenses.cameras.end(),
                                    [&](const Camera& c) { return c.name == camera; });
  if (by_name == lenses.cameras.end() && lenses.cameras.size() > 1) {
    std::vector<std::string> names;
    for (const Camera& known : lenses.cameras) names.push_back(known.name);
    return Fail(fmt::format("{}: holds no camera {}, only {}; rename one of them", file, camera,
                            fmt::join(names, ", ")));
  }
  const Camera& known = by_name != lenses.cameras.end() ? *by_name : lenses.cameras.front();
  if (known.width != width || known.height != height)
    return Fail(fmt::format(
        "{}: the pictures of {} have {}x{} px, but its lens was calibrated for {}x{}; a lens is "
        "right for one size only, calibrate it at this one",
        file, camera, width, height, known.width, known.height));
  return known.lens;
}

}  // namespace articap
