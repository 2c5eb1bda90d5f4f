// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "capture/cuts.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"
#include "core/session.h"

namespace articap {

struct SplitOptions {
  double pad_s = 0.1;          // added before and behind every part, as far as the recording goes
  double gap_s = 1;            // pulses farther apart than this belong to two bursts
  double above_noise_db = 15;  // what is louder than the noise floor by this is speech
  double min_speech_s = 0.1;
  double min_silence_s = 0.5;
};

void VisitOptions(SplitOptions& options, OptionVisitor& visit);

// By what a take is cut: one of these.
struct SplitRule {
  std::string tier;       // the labelled intervals of this tier of its labels
  std::string times;      // a file of times (ParseCuts), on the session clock
  int pulse_channel = 0;  // bursts of pulses on this channel of its audio, from 1
  bool silence = false;   // speech between silences on the first channel of its audio
};

// Where the take is to be cut, on its session clock, before anything is added.
Result<std::vector<Cut>> FindCuts(const StoredTake& take, const SplitRule& rule,
                                  const SplitOptions& options);

// Makes a take of every cut: takes/<id>_01, or <id>_01_<name>. All, or none on failure. The report
// names them with their times.
Result<StageReport> SplitTake(const StoredTake& take, const std::vector<Cut>& cuts,
                              const SplitOptions& options);

}  // namespace articap
