// SPDX-License-Identifier: MIT
#include "tests/support/spoken_take.h"

#include <utility>

#include "core/head_pose.h"
#include "core/marker_set.h"
#include "rig/default_head/default_head.h"
#include "synthetic/noise.h"
#include "tests/support/test_data.h"

namespace articap {

const FaceRig& DefaultHead() {
  static const FaceRig rig = MakeDefaultHead().value();
  return rig;
}

SpokenTake MakeSpokenTake(const SpokenTakeOptions& wanted) {
  const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml").value();
  SyntheticTakeOptions options;
  options.seed = wanted.seed;
  options.speech.num_sentences = wanted.num_sentences;
  if (!wanted.own_identity) options.identity_spread = 0;
  SyntheticTake take = SynthesizeTake(DefaultHead(), set, options).value();
  const auto recorded = AddNoise(take.markers, {.noise_mm = wanted.noise_mm}, wanted.seed);
  HeadTracks tracks = ToHead(recorded.markers.tracks, take.true_pose);
  return {std::move(take), std::move(tracks)};
}

}  // namespace articap
