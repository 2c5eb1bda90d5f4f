// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "capture/cuts.h"
#include "core/result.h"

namespace articap {

// A channel of sound in pieces of a millisecond: what cutting needs of a long recording.
struct SoundEnvelope {
  static constexpr double kPiece_s = 0.001;
  struct Piece {
    float mean = 0;
    float mean_square = 0;
    float peak = 0;  // the largest amount; full scale is 1
  };
  std::vector<Piece> pieces;
};

// Sums samples up, of any number at a time. The last piece may be shorter.
class EnvelopeMeter {
 public:
  explicit EnvelopeMeter(double rate_hz) : rate_hz_(rate_hz) {}
  void Add(std::span<const float> samples);
  SoundEnvelope Finish();

 private:
  void ClosePiece();

  double rate_hz_;
  std::int64_t num_samples_ = 0;
  std::int64_t in_piece_ = 0;
  double sum_ = 0, sum_of_squares_ = 0;
  float peak_ = 0;
  SoundEnvelope envelope_;
};

// Of one channel (from 0) of a WAV file.
Result<SoundEnvelope> ReadEnvelope(const std::filesystem::path& path, int channel);

struct SpeechRule {
  double above_noise_db = 15;  // what is louder than the noise floor by this is speech
  double min_speech_s = 0.1;   // shorter ones are clicks
  double min_silence_s = 0.5;  // shorter ones are pauses within
};

// Stretches of speech between silences. The level is that of 10 ms at a time, without any constant
// part; the noise floor is the level that a tenth of the recording stays below, digital silence not
// counted. Empty where nothing stands out.
std::vector<Cut> FindSpeech(const SoundEnvelope& envelope, const SpeechRule& rule);

// Bursts of pulses: from the first to the last of pulses that follow one another within `gap_s`,
// to the millisecond. A pulse is where half of the channel's peak is exceeded, after it has fallen
// below a quarter of it. Empty where the peak does not stand out from the rest by a factor of 10.
std::vector<Cut> FindPulseBursts(const SoundEnvelope& envelope, double gap_s);

}  // namespace articap
