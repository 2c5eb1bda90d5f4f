// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "synthetic/phones.h"
#include "synthetic/random.h"

namespace articap {

// A phone in time, or a pause.
struct PhoneToken {
  const PhoneModel* phone = nullptr;  // null for a pause
  double begin_s = 0;
  double end_s = 0;
  bool stressed = false;
  int word = -1;  // index into Utterances::words; -1 for a pause

  double center_s() const { return 0.5 * (begin_s + end_s); }
  std::string_view name() const { return phone ? phone->name : kSilence; }
};

struct WordToken {
  std::string spelling;  // its phones in lower case, syllables joined by hyphens
  double begin_s = 0;
  double end_s = 0;
};

struct Utterances {
  std::vector<PhoneToken> phones;  // without gaps, from 0 to duration_s
  std::vector<WordToken> words;
  double duration_s = 0;
};

struct UtteranceOptions {
  int num_sentences = 3;
  double tempo = 1;       // 1: as Klatt's rules have it; 2: compressible parts half as long
  double lead_in_s = 1;   // rest before the first sentence and after the last
  double pause_s = 0.65;  // mean length of the pauses between sentences
};

// Sentences of five to eight nonsense words, dealt from a deck of phones, so that each dozen of
// seconds holds every sound; timed by Klatt's rule
//   duration = minimum + (inherent - minimum) * percentage,
// the percentage from stress, the end of the sentence, and chance.
Utterances ComposeUtterances(const UtteranceOptions& options, RandomGenerator& random);

}  // namespace articap
