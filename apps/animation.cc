// SPDX-License-Identifier: MIT
#include "apps/animation.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/file_io.h"
#include "rig/io/gltf_export.h"

namespace articap {
namespace {

constexpr double kDefaultLengthS = 10;

// Rows of the window; the number of those held over from the frame before goes to *num_held.
Eigen::MatrixXd RowsWithoutGaps(const ParameterTrack& track, const FrameWindow& window,
                                int* num_held) {
  Eigen::MatrixXd rows = track.values.middleRows(window.first, window.count);
  *num_held = 0;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    if (rows.row(row).allFinite()) continue;
    if (row > 0)
      rows.row(row) = rows.row(row - 1);
    else
      rows.row(row).setZero();
    ++*num_held;
  }
  return rows;
}

// The exporter writes to a path; the bytes are wanted, to be put in place with the other outputs.
class ScratchFile {
 public:
  ScratchFile()
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("articap.{}.animation.glb", ::getpid())) {}
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

Result<StageResult<std::string>> AnimationOf(const ParameterTrack& track, const FaceRig& speaker,
                                             const std::optional<FrameWindow>& window) {
  FrameWindow frames;
  frames.count =
      std::min(track.num_frames(), static_cast<int>(kDefaultLengthS * track.rate_hz) + 1);
  if (window) frames = *window;
  int num_held = 0;
  RigAnimation animation;
  animation.rate_hz = track.rate_hz;
  animation.parameters = RowsWithoutGaps(track, frames, &num_held);
  const ScratchFile scratch;
  const Result<ExportReport> exported = ExportGlb(speaker, animation, scratch.path());
  if (!exported) return tl::unexpected(exported.error());
  Result<std::string> bytes = ReadFile(scratch.path());
  if (!bytes) return tl::unexpected(bytes.error());

  StageReport report;
  report.stage = "animation";
  report.verdict = fmt::format("{} frames from {:.3f} s", frames.count,
                               SecondsOf(TimeOfFrame(frames.first, track.rate_hz, track.start)));
  report.figures = {{"largest_deviation_mm", exported->largest_deviation_mm}};
  if (num_held > 0)
    report.warnings.push_back(fmt::format(
        "{} frames have no parameters; the animation holds the frame before", num_held));
  return StageResult<std::string>{std::move(*bytes), std::move(report)};
}

}  // namespace articap
