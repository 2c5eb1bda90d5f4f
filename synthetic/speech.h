// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "core/options.h"
#include "core/parameter_track.h"
#include "core/text_grid.h"
#include "rig/face_rig.h"
#include "synthetic/utterance.h"

namespace articap {

struct SyntheticSpeechOptions {
  int num_sentences = 3;
  double rate_hz = 60;     // frames a second
  double tempo = 1;        // of the phones; 1 is a careful reader
  double pause_s = 0.65;   // mean pause between sentences
  double rest_s = 1;       // exact rest (all parameters 0) before the first sentence
  double effort = 1;       // how far targets reach: 1 uses most of every parameter's range
  double variation = 1;    // how much a phone differs from one time to the next; 0: not at all
  double asymmetry = 0.2;  // how much more the stronger side's mouth corner moves
};
void VisitOptions(SyntheticSpeechOptions& options, OptionVisitor& visit);

struct SyntheticSpeech {
  ParameterTrack track;  // all of the rig's parameters; those that speech does not move stay 0
  Utterances utterances;
};

// Speech-like movements of the rig's articulatory parameters: smooth (three continuous
// derivatives), within the ranges, with co-articulation, and with lips that meet on this very rig
// in P, B and M.
SyntheticSpeech SynthesizeSpeech(const FaceRig& rig, const SyntheticSpeechOptions& options,
                                 std::uint64_t seed);

// The tiers "words" and "phones"; pauses are words without a label, and the phone SIL.
TextGrid LabelsOf(const Utterances& utterances);

}  // namespace articap
