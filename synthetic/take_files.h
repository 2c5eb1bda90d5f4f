// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "synthetic/noise.h"
#include "synthetic/speaker.h"

namespace articap {

struct OutputFile {
  std::string name;
  std::string bytes;
};

// What a synthetic take is on disk:
//   take.c3d          the markers, with their noise and faults
//   markers.toml      the marker map to bind and fit with
//   labels.TextGrid   words and phones
//   truth.csv         the parameters (core/parameter_track.h)
//   truth.pose.csv    head_from_stage (core/head_pose.h)
//   truth.toml        rig, identity, attachments, options, counts of the faults
//   truth.faults.csv  frame,marker,fault: the outliers and swaps; what is missing shows in the take
// The same take gives the same bytes. further: options of what else was made of the take, for
// truth.toml.
struct NamedOptions {
  std::string table;
  std::vector<std::pair<std::string, std::string>> options;
};
std::vector<OutputFile> FilesOf(const SyntheticTake& take, const DisturbedRecording& recorded,
                                const SyntheticNoiseOptions& noise,
                                const std::vector<NamedOptions>& further = {});

}  // namespace articap
