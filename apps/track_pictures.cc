// SPDX-License-Identifier: MIT
#include "apps/track_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "apps/mark_drawing.h"
#include "apps/progress.h"
#include "capture/video_writer.h"
#include "core/statistics.h"
#include "render/draw.h"
#include "render/label.h"

namespace articap {
namespace {

constexpr int kCell_px = 240;  // of a view in the picture of a doubt
constexpr int kGap_px = 4;
const Eigen::Vector3f kWhite = Eigen::Vector3f::Ones();

double SecondsOnArray(const PicturedTake& take, int camera, SessionTime time) {
  return SecondsOf(time) + take.array.cameras[camera].time_offset_s;
}

// How large dots are in a camera's pictures of a frame; 8 px where there are none.
double UsualDiameter_px(const FrameMarks& marks, int camera) {
  constexpr double kOtherwise_px = 8;
  std::vector<double> diameters_px;
  for (const MarkerMark& mark : marks.markers)
    if (mark.dot_px && mark.view.camera == camera) diameters_px.push_back(mark.diameter_px);
  return diameters_px.empty() ? kOtherwise_px : MedianOf(std::move(diameters_px));
}

// About twelve dots wide.
Magnification MagnificationAround(const Eigen::Vector2d& place_px, double diameter_px) {
  constexpr double kDotsWide = 12;
  const int zoom = std::clamp(static_cast<int>(kCell_px / (kDotsWide * diameter_px)), 1, 6);
  const int half = kCell_px / zoom / 2;
  return {static_cast<int>(std::lround(place_px.x())) - half,
          static_cast<int>(std::lround(place_px.y())) - half, zoom};
}

std::vector<int> MarkersOf(const Doubt& doubt) {
  return doubt.other < 0 ? std::vector{doubt.marker} : std::vector{doubt.marker, doubt.other};
}

// A view of a doubt, in a frame of its camera.
Picture Cell(const PicturedTake& take, const Doubt& doubt, const FrameMarks& marks,
             const MarkerMark& mark, const Frame& frame) {
  const Magnification shown =
      MagnificationAround(mark.place_px, UsualDiameter_px(marks, mark.view.camera));
  const int size = kCell_px / shown.zoom;
  Picture cell = Enlarged(PictureOf(frame, shown.left, shown.top, size, size), shown.zoom);
  DrawMarks(marks, mark.view.camera, shown, {take.names, MarkersOf(doubt), 1, true}, cell);
  DrawEdgedText(cell, take.array.NameOf(mark.view), 4, 4, 1, kWhite);
  return cell;
}

// Two cells to a row.
Picture Composed(const std::vector<Picture>& cells) {
  constexpr int kColumns = 2, kPitch_px = kCell_px + kGap_px;
  const int rows = std::max(1, (static_cast<int>(cells.size()) + kColumns - 1) / kColumns);
  Picture picture = FilledPicture(kColumns * kPitch_px - kGap_px, rows * kPitch_px - kGap_px,
                                  Eigen::Vector3f::Constant(0.2F));
  for (int i = 0; i < static_cast<int>(cells.size()); ++i)
    Paste(picture, cells[i], i % kColumns * kPitch_px, i / kColumns * kPitch_px);
  return picture;
}

// Calls use(frame) for the frames of a video until it says that it has enough, or the video ends. A
// fault in the video was reported when it was first read.
template <class Use>
void ReadFrames(FrameSource& source, const Use& use) {
  while (true) {
    Result<std::optional<Frame>> frame = source.Next();
    if (!frame || !*frame || !use(**frame)) return;
  }
}

std::string FrameText(const PicturedTake& take, int instant) {
  return fmt::format("frame {}  {:.2f} s", take.first_frame + instant, instant / take.rate_hz);
}

// What is not read off the picture itself.
void DrawCaption(const PicturedTake& take, int instant, int scale, Picture& picture) {
  DrawEdgedText(picture, FrameText(take, instant), 4 * scale, 4 * scale, scale, kWhite);
  const char* const kLegend = "ring: dot found, grey: nobody's   cross: hidden, expected here";
  DrawEdgedText(picture, kLegend, 4 * scale, picture.height - 11 * scale, scale, kWhite);
}

// Outlines of the parts of a camera's picture that views have to themselves, with their names.
void DrawRegions(const CameraArray& array, int camera, const Magnification& shown,
                 Picture& picture) {
  const Eigen::Vector3f color(0.05F, 0.3F, 0.05F);
  for (const View& view : array.views()) {
    const auto& region = array.RegionOf(view);
    if (view.camera != camera || !region) continue;
    const Eigen::Vector2d near = shown(Eigen::Vector2d(region->left, region->top));
    const Eigen::Vector2d far =
        shown(Eigen::Vector2d(region->left + region->width - 1, region->top + region->height - 1));
    for (const Eigen::Vector2d& corner : {near, far}) {
      DrawLine(picture, corner, {near.x(), far.y()}, 1, color);
      DrawLine(picture, corner, {far.x(), near.y()}, 1, color);
    }
    const Eigen::Vector2i text_px = near.cast<int>() + Eigen::Vector2i(4, 24);
    DrawEdgedText(picture, array.NameOf(view), text_px.x(), text_px.y(), 2, kWhite);
  }
}

// The frames of a camera that show doubts: which doubts each.
std::multimap<std::int64_t, int> PicturesWanted(const PicturedTake& take,
                                                const std::vector<Doubt>& doubts, int camera) {
  std::multimap<std::int64_t, int> wanted;
  for (int i = 0; i < static_cast<int>(doubts.size()); ++i)
    wanted.emplace(take.PictureAt(camera, doubts[i].frame), i);
  return wanted;
}

}  // namespace

void VisitOptions(ShowOptions& options, OptionVisitor& visit) {
  visit("doubtful", options.doubtful, "places of doubt on the contact sheet; 0: no sheet");
  visit("overlay", options.overlay, "write videos with what was found in them");
  visit("overlay_crf", options.overlay_crf, "their quality: 0 best to 51 worst");
  visit("memory_mb", options.memory_mb,
        "what pictures kept for these may take; longer videos are read twice; MB");
}

Result<void> CheckOptions(const ShowOptions& options) {
  constexpr int kMost = 200;
  if (options.doubtful < 0 || options.doubtful > kMost)
    return Fail(
        fmt::format("doubtful is {}; it must lie between 0 and {}", options.doubtful, kMost));
  if (!(options.overlay_crf >= 0 && options.overlay_crf <= 51))
    return Fail(
        fmt::format("overlay_crf is {}; it must lie between 0 and 51", options.overlay_crf));
  if (options.memory_mb < 0)
    return Fail(fmt::format("memory_mb is {}; it must not be negative", options.memory_mb));
  return {};
}

std::size_t RoomForPictures(const ShowOptions& options) {
  constexpr std::size_t kMegabyte = 1'000'000;
  return options.doubtful > 0 || options.overlay ? kMegabyte * options.memory_mb : 0;
}

std::int64_t PicturedTake::PictureAt(int camera, int instant) const {
  const double time_s = SecondsOf(TimeOfFrame(instant, rate_hz, start));
  const auto later = [&](const DotPicture& a, const DotPicture& b) {
    return std::abs(SecondsOnArray(*this, camera, a.time) - time_s) <
           std::abs(SecondsOnArray(*this, camera, b.time) - time_s);
  };
  const std::vector<DotPicture>& pictures = videos[camera].pictures;
  const auto nearest = std::min_element(pictures.begin(), pictures.end(), later);
  return nearest == pictures.end() ? -1 : nearest->index;
}

int PicturedTake::InstantOf(int camera, SessionTime time) const {
  const double since_start_s = SecondsOnArray(*this, camera, time) - SecondsOf(start);
  return std::clamp(static_cast<int>(std::lround(since_start_s * rate_hz)), 0,
                    marks.num_frames() - 1);
}

Result<std::vector<Picture>> DoubtPictures(const PicturedTake& take,
                                           const std::vector<Doubt>& doubts) {
  auto sources = take.open();
  if (!sources) return tl::unexpected(sources.error());
  std::vector<std::vector<Picture>> cells(doubts.size());
  for (int camera = 0; camera < static_cast<int>(sources->size()); ++camera) {
    auto wanted = PicturesWanted(take, doubts, camera);
    FrameSource& source = *(*sources)[camera].source;
    ReadFrames(source, [&](const Frame& frame) {
      const auto [first, end] = wanted.equal_range(frame.index);
      if (first == end) return !wanted.empty();
      for (auto it = first; it != end; ++it) {
        const Doubt& doubt = doubts[it->second];
        const FrameMarks marks = take.marks.At(doubt.frame);
        for (const MarkerMark& mark : marks.markers)
          if (mark.marker == doubt.marker && mark.view.camera == camera)
            cells[it->second].push_back(Cell(take, doubt, marks, mark, frame));
      }
      wanted.erase(first, end);
      return !wanted.empty();
    });
  }
  std::vector<Picture> pictures;
  pictures.reserve(doubts.size());
  for (const std::vector<Picture>& views : cells) pictures.push_back(Composed(views));
  return pictures;
}

Picture DoubtSheet(const PicturedTake& take, const std::vector<Doubt>& doubts,
                   const std::vector<Picture>& pictures) {
  constexpr int kColumns = 4;
  std::vector<LabelledPicture> labelled;
  for (std::size_t i = 0; i < pictures.size(); ++i)
    labelled.push_back({fmt::format("{}, {}: {}", take.names[doubts[i].marker],
                                    FrameText(take, doubts[i].frame), doubts[i].why),
                        pictures[i]});
  return ContactSheet(labelled, kColumns);
}

Result<void> WriteOverlay(const PicturedTake& take, int camera, double crf,
                          const std::filesystem::path& path) {
  constexpr int kLinesToRead = 700;
  auto sources = take.open();
  if (!sources) return tl::unexpected(sources.error());
  FrameSource& source = *(*sources)[camera].source;
  const FrameSourceInfo info = source.info();
  const int zoom = info.height < kLinesToRead ? 2 : 1;
  VideoFormat format;
  format.codec = VideoCodec::kH264;
  format.container = VideoContainer::kMp4;
  format.crf = crf;
  format.pixels = PixelFormat::kRgb8;
  // H.264 wants even sizes.
  format.width = info.width * zoom / 2 * 2;
  format.height = info.height * zoom / 2 * 2;
  format.rate = ClosestRate(take.videos[camera].rate_hz);
  auto writer = VideoWriter::Create(path, format);
  if (!writer) return tl::unexpected(writer.error());
  Result<void> written;
  ReadFrames(source, [&](const Frame& frame) {
    const int instant = take.InstantOf(camera, frame.time);
    Picture picture = PictureOf(frame, 0, 0, info.width, info.height);
    if (zoom > 1) picture = Enlarged(picture, zoom);
    DrawRegions(take.array, camera, {0, 0, zoom}, picture);
    DrawMarks(take.marks.At(instant), camera, {0, 0, zoom}, {take.names, {}, 2, false}, picture);
    DrawCaption(take, instant, 2, picture);
    written =
        (*writer)->Write({PixelFormat::kRgb8, format.width, format.height,
                          3 * static_cast<std::ptrdiff_t>(picture.width), picture.rgb8.data()});
    return written.has_value();
  });
  return written ? (*writer)->Finish() : written;
}

}  // namespace articap
