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
#include "capture/pictures.h"
#include "core/natural_order.h"
#include "core/session.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

// Cameras name pictures of one instant by one number, but not every camera has every picture.
void NumberByName(std::vector<SeenCamera>& cameras) {
  std::vector<std::vector<std::int64_t>> numbers;
  for (const SeenCamera& camera : cameras) {
    std::set<std::pair<std::int64_t, bool>> seen;
    numbers.emplace_back();
    for (const BoardSighting& sighting : camera.sightings.sightings) {
      const auto number = LastNumberIn(sighting.source);
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
          picture.source.empty()
              ? picture.reason
              : fmt::format("{} is set aside: {}", picture.source, picture.reason));
  return camera;
}

// "the board moves" of "the board moves: 4.2 px from frame to frame".
std::string KindOf(const std::string& reason) {
  return reason.substr(0, std::min({reason.find(':'), reason.find(" ("), reason.find(" beside ")}));
}

std::size_t CountFrames(const std::vector<FoundBoard>& boards) {
  std::set<std::int64_t> frames;
  for (const FoundBoard& board : boards) frames.insert(board.sighting.frame);
  return frames.size();
}

// "board.mp4: of 120 frames 90 show the board, 12 chosen; the others: the board moves (78), ..."
std::string FatesOfFrames(const Sightings& found, const ViewChoice& choice) {
  std::map<std::string, int> counts;
  for (const auto* list : {&found.set_aside, &choice.set_aside})
    for (const SetAside& frame : *list) ++counts[KindOf(frame.reason)];
  std::vector<std::string> others;
  for (const auto& [kind, count] : counts) others.push_back(fmt::format("{} ({})", kind, count));
  return fmt::format("{}: of {} frames {} show the board, {} chosen{}{}",
                     fs::path(found.camera).filename().string(), found.pictures,
                     CountFrames(found.found), CountFrames(choice.views),
                     others.empty() ? "" : "; the others: ", fmt::join(others, ", "));
}

Result<Sightings> LookForBoards(FrameSource& source, const BoardSpec& board,
                                const BoardInput& input) {
  return WithProgress("looking for the board in " + source.info().name, [&](Progress& progress) {
    return FindBoards(source, board, input.detect, [&](double part) { progress.SetPart(part); });
  });
}

Result<void> AddKnownLens(const KnownLenses& lenses, bool only_camera, SeenCamera& camera) {
  if (lenses.cameras.empty()) return {};
  CameraSightings& of = camera.sightings;
  const Result<Lens> lens = lenses.LensFor(of.camera, only_camera, of.width, of.height);
  if (!lens) return tl::unexpected(lens.error());
  of.lens = *lens;
  return {};
}

// Of the videos the frames that any of them would choose.
void KeepChosenInstants(const std::vector<ViewChoice>& choices, std::vector<SeenCamera>& cameras) {
  std::set<std::int64_t> chosen;
  for (const ViewChoice& choice : choices)
    for (const FoundBoard& view : choice.views) chosen.insert(view.sighting.frame);
  for (SeenCamera& camera : cameras)
    std::erase_if(camera.sightings.sightings,
                  [&](const BoardSighting& sighting) { return !chosen.contains(sighting.frame); });
}

std::string NameOfPath(const std::string& path) {
  const fs::path clean = fs::path(path).lexically_normal();
  const fs::path last = clean.filename().empty() ? clean.parent_path() : clean;
  return fs::is_directory(last) ? last.filename().string() : last.stem().string();
}

// Of left01.jpg, left02.jpg: "left"; of one path its own name, of a take that of its camera.
std::string CommonNameOf(const std::vector<std::string>& paths) {
  if (paths.size() == 1 && IsTakeFolder(paths[0]))
    if (const Result<StoredTake> take = OpenTake(paths[0]); take && !take->cameras().empty())
      return take->cameras().front();
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

// The sources of one path: one camera, or those of a take.
Result<void> OpenPath(const std::string& path, std::vector<NamedSource>& sources) {
  if (!IsTakeFolder(path)) {
    auto source = OpenFrames({path});
    if (!source) return tl::unexpected(source.error());
    sources.push_back({SafeNameOf(NameOfPath(path)), *std::move(source)});
    return {};
  }
  const Result<StoredTake> take = OpenTake(path);
  if (!take) return tl::unexpected(take.error());
  if (take->cameras().empty())
    return Fail(fmt::format("{}: the take holds no video; name one that does", path));
  for (const std::string& name : take->cameras()) {
    auto source = OpenCamera(*take, name);
    if (!source) return tl::unexpected(source.error());
    sources.push_back({name, *std::move(source)});
  }
  return {};
}

}  // namespace

void AddBoardInput(VerbLine& line, BoardInput& input) {
  line.Flag("--board", input.board, "BOARD",
            "chessboard:COLUMNSxROWS:SQUARE_MM (inner corners) or "
            "charuco:COLUMNSxROWS:SQUARE_MM:MARKER_MM[:DICTIONARY] (squares)")
      ->required();
  line.Flag("--lenses", input.lenses, "FILE,...", "calibrations whose lenses are known already");
  line.Stage("detect", input.detect, "detect");
  line.Stage("choose", input.choose, "choose");
  line.Stage("read", input.read);
}

Result<SeenCamera> SeeOneCamera(const BoardSpec& board, const BoardInput& input) {
  const std::vector<fs::path> paths(input.paths.begin(), input.paths.end());
  const auto source = OpenFrames(paths);
  if (!source) return tl::unexpected(source.error());
  const Result<KnownLenses> lenses = ReadLenses(input.lenses, input.read);
  if (!lenses) return tl::unexpected(lenses.error());
  Result<Sightings> found = LookForBoards(**source, board, input);
  if (!found) return tl::unexpected(found.error());
  std::vector<std::string> notes = (*source)->info().notes;
  if (found->is_video) {
    ViewChoice choice = ChooseViews(*found, board, input.choose);
    notes.push_back(FatesOfFrames(*found, choice));
    found->found = std::move(choice.views);
  }
  SeenCamera camera = MakeSeenCamera(SafeNameOf(CommonNameOf(input.paths)), *found);
  camera.notes = std::move(notes);
  if (const auto known = AddKnownLens(*lenses, true, camera); !known)
    return tl::unexpected(known.error());
  return camera;
}

Result<std::vector<NamedSource>> OpenCameras(const std::vector<std::string>& paths) {
  std::vector<NamedSource> sources;
  for (const std::string& path : paths)
    if (const auto opened = OpenPath(path, sources); !opened) return tl::unexpected(opened.error());
  std::set<std::string> names;
  for (const NamedSource& source : sources)
    if (!names.insert(source.name).second)
      return Fail(
          fmt::format("two cameras are called {}; rename a folder or a video", source.name));
  return sources;
}

Result<std::vector<SeenCamera>> SeeCameras(const BoardSpec& board, const BoardInput& input,
                                           bool choose_views) {
  const Result<std::vector<NamedSource>> sources = OpenCameras(input.paths);
  if (!sources) return tl::unexpected(sources.error());
  const Result<KnownLenses> lenses = ReadLenses(input.lenses, input.read);
  if (!lenses) return tl::unexpected(lenses.error());
  std::vector<SeenCamera> cameras;
  std::vector<ViewChoice> choices;
  for (const NamedSource& named : *sources) {
    const Result<Sightings> found = LookForBoards(*named.source, board, input);
    if (!found) return tl::unexpected(found.error());
    SeenCamera& camera = cameras.emplace_back(MakeSeenCamera(named.name, *found));
    if (const auto known = AddKnownLens(*lenses, sources->size() == 1, camera); !known)
      return tl::unexpected(known.error());
    if (camera.is_video != cameras.front().is_video)
      return Fail(fmt::format(
          "{} and {}: one is a video, the other separate pictures, so that nobody knows which were "
          "taken together; give one kind",
          cameras.front().sightings.camera, named.name));
    camera.notes = named.source->info().notes;
    if (!camera.is_video || !choose_views) continue;
    choices.push_back(ChooseViews(*found, board, input.choose));
    camera.notes.push_back(FatesOfFrames(*found, choices.back()));
  }
  if (!choices.empty()) KeepChosenInstants(choices, cameras);
  if (!cameras.empty() && !cameras.front().is_video) NumberByName(cameras);
  return cameras;
}

Result<KnownLenses> ReadLenses(const std::vector<std::string>& files,
                               const CameraReadOptions& options) {
  KnownLenses known{{}, fmt::format("{}", fmt::join(files, ", "))};
  std::set<std::string> names;
  for (const std::string& file : files) {
    const Result<CameraArray> array = ReadCameras(file, options);
    if (!array) return tl::unexpected(array.error());
    for (const Camera& camera : array->cameras) {
      if (!names.insert(camera.name).second)
        return Fail(fmt::format("{}: two lenses are called {}; rename one in its file", known.files,
                                camera.name));
      known.cameras.push_back(camera);
    }
  }
  return known;
}

Result<Lens> KnownLenses::LensFor(const std::string& camera, bool only_camera, int width,
                                  int height) const {
  const bool any_name = only_camera && cameras.size() == 1;
  const auto known = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const Camera& c) { return any_name || c.name == camera; });
  if (known == cameras.end()) {
    std::vector<std::string> names;
    for (const Camera& other : cameras) names.push_back(other.name);
    return Fail(
        fmt::format("{}: no lens is called {}, only {}; rename one of them, or name "
                    "another file besides, after a comma",
                    files, camera, fmt::join(names, ", ")));
  }
  if (known->width != width || known->height != height)
    return Fail(fmt::format(
        "{}: the pictures of {} have {}x{} px, but its lens was calibrated for {}x{}; a lens is "
        "right for one size only, calibrate it at this one",
        files, camera, width, height, known->width, known->height));
  return known->lens;
}

std::vector<fs::path> InputFiles(const std::vector<std::string>& paths,
                                 const std::vector<std::string>& lenses) {
  std::vector<fs::path> files(lenses.begin(), lenses.end());
  for (const fs::path path : paths) {
    files.push_back(path);
    if (IsTakeFolder(path)) {
      files.push_back(path / "take.toml");
      if (const Result<StoredTake> take = OpenTake(path))
        for (const TakeFile& file : take->info.files) files.push_back(take->PathOf(file));
    } else if (fs::is_directory(path)) {
      if (const auto pictures = PicturesIn(path))
        files.insert(files.end(), pictures->begin(), pictures->end());
    }
  }
  return files;
}

}  // namespace articap
