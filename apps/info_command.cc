// SPDX-License-Identifier: MIT
#include "apps/marker_input.h"
#include "apps/progress.h"
#include "apps/verbs.h"
#include "core/camera_io.h"
#include "core/io/marker_info.h"

namespace articap {
namespace {

ExitCode DescribeCameraFile(const VerbLine& line, const std::string& path,
                            const std::string& unit) {
  const Result<CameraReading> reading = ReadCameraFile(path, {.unit = unit, .size = {}});
  if (!reading) return FailWith(reading.error());
  StageReport report = DescribeCameras(reading->array, path);
  report.warnings = reading->warnings;
  return line.Finish({report});
}

}  // namespace

ExitCode InfoCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap info",
                "What is in a marker file: markers, rate, frames, gaps, units; or in a file of\n"
                "calibrated cameras: pictures, lenses, places, mirrors.",
                "articap info take01.c3d");
  std::string path;
  MarkerReadOptions read_options;
  line.Argument("FILE", path,
                "marker file: C3D, TRC, Qualisys TSV, CSV (Nexus, Motive, plain); or cameras: "
                "calibration.toml, OpenCV's .yml, Qualisys' .qca.txt");
  line.Stage("read", read_options);
  if (const auto exit = line.Parse(arguments)) return *exit;

  if (MayHoldCameras(path)) return DescribeCameraFile(line, path, read_options.unit);
  const Result<MarkerRecording> recording =
      WithProgress("reading " + path, [&] { return ReadMarkers(path, read_options); });
  if (!recording) return FailWith(recording.error());
  return line.Finish({DescribeRecording(*recording, path)});
}

}  // namespace articap
