// SPDX-License-Identifier: MIT
#include "capture/sound_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/wav_header.h"
#include "core/wav_samples.h"

namespace articap {
namespace {

constexpr int kPiecesPerLevel = 10;
constexpr double kLevel_s = kPiecesPerLevel * SoundEnvelope::kPiece_s;

// Of 10 ms at a time, dB of full scale; the constant part of each is taken off.
std::vector<double> LevelsOf(const SoundEnvelope& envelope) {
  constexpr double kSmallest = 1e-12;  // -120 dB, below what 16 bits hold
  std::vector<double> levels_db;
  for (std::size_t i = 0; i + kPiecesPerLevel <= envelope.pieces.size(); i += kPiecesPerLevel) {
    double mean = 0, mean_square = 0;
    for (std::size_t piece = i; piece < i + kPiecesPerLevel; ++piece) {
      mean += envelope.pieces[piece].mean / kPiecesPerLevel;
      mean_square += envelope.pieces[piece].mean_square / kPiecesPerLevel;
    }
    levels_db.push_back(10 * std::log10(std::max(mean_square - mean * mean, kSmallest)));
  }
  return levels_db;
}

// Digital silence where there is nothing else.
double NoiseFloorOf_db(const std::vector<double>& levels_db) {
  constexpr double kDigitalSilence_db = -110;
  std::vector<double> heard;
  for (const double level_db : levels_db)
    if (level_db > kDigitalSilence_db) heard.push_back(level_db);
  if (heard.empty()) return kDigitalSilence_db;
  const auto tenth = heard.begin() + static_cast<std::ptrdiff_t>(heard.size() / 10);
  std::nth_element(heard.begin(), tenth, heard.end());
  return *tenth;
}

}  // namespace

void EnvelopeMeter::Add(std::span<const float> samples) {
  for (const float sample : samples) {
    // The piece in which a sample's time lies, so that pieces never drift.
    const auto piece = static_cast<std::int64_t>(static_cast<double>(num_samples_) /
                                                 (rate_hz_ * SoundEnvelope::kPiece_s));
    while (piece > static_cast<std::int64_t>(envelope_.pieces.size())) ClosePiece();
    sum_ += sample;
    sum_of_squares_ += static_cast<double>(sample) * sample;
    peak_ = std::max(peak_, std::abs(sample));
    ++in_piece_;
    ++num_samples_;
  }
}

// A piece without a sample, at rates below 1 kHz, is as the one before.
void EnvelopeMeter::ClosePiece() {
  SoundEnvelope::Piece piece;
  if (in_piece_ > 0) {
    const auto count = static_cast<double>(in_piece_);
    piece = {static_cast<float>(sum_ / count), static_cast<float>(sum_of_squares_ / count), peak_};
  } else if (!envelope_.pieces.empty()) {
    piece = envelope_.pieces.back();
  }
  envelope_.pieces.push_back(piece);
  sum_ = sum_of_squares_ = 0;
  peak_ = 0;
  in_piece_ = 0;
}

SoundEnvelope EnvelopeMeter::Finish() {
  if (in_piece_ > 0) ClosePiece();
  return std::move(envelope_);
}

Result<SoundEnvelope> ReadEnvelope(const std::filesystem::path& path, int channel) {
  const Result<WavHeader> header = ReadWavHeader(path);
  if (!header) return tl::unexpected(header.error());
  if (channel < 0 || channel >= header->channels)
    return Fail(fmt::format("{}: has no channel {}; there are {}", path.string(), channel + 1,
                            header->channels));
  EnvelopeMeter meter(static_cast<double>(header->rate_hz));
  const auto read = ReadWavChannel(path, *header, channel,
                                   [&](std::span<const float> samples) { meter.Add(samples); });
  if (!read) return tl::unexpected(read.error());
  return meter.Finish();
}

std::vector<Cut> FindSpeech(const SoundEnvelope& envelope, const SpeechRule& rule) {
  const std::vector<double> levels_db = LevelsOf(envelope);
  const double threshold_db = NoiseFloorOf_db(levels_db) + rule.above_noise_db;
  std::vector<Cut> loud;
  for (std::size_t i = 0; i < levels_db.size(); ++i) {
    if (levels_db[i] < threshold_db) continue;
    const double start_s = static_cast<double>(i) * kLevel_s;
    if (loud.empty() || start_s - loud.back().end_s >= rule.min_silence_s)
      loud.push_back({start_s, start_s, {}});
    loud.back().end_s = start_s + kLevel_s;
  }
  std::erase_if(loud, [&](const Cut& cut) { return cut.end_s - cut.start_s < rule.min_speech_s; });
  return loud;
}

std::vector<Cut> FindPulseBursts(const SoundEnvelope& envelope, double gap_s) {
  constexpr double kStandsOut = 10;
  double peak = 0, sum = 0;
  for (const SoundEnvelope::Piece& piece : envelope.pieces) {
    peak = std::max<double>(peak, piece.peak);
    sum += std::sqrt(piece.mean_square);
  }
  std::vector<Cut> bursts;
  if (!(peak * static_cast<double>(envelope.pieces.size()) > kStandsOut * sum)) return bursts;
  bool is_on = false;
  for (std::size_t i = 0; i < envelope.pieces.size(); ++i) {
    const double amount = envelope.pieces[i].peak;
    const double time_s = static_cast<double>(i) * SoundEnvelope::kPiece_s;
    if (!is_on && amount > peak / 2) {
      is_on = true;
      if (bursts.empty() || time_s - bursts.back().end_s > gap_s)
        bursts.push_back({time_s, time_s, {}});
    }
    if (is_on) bursts.back().end_s = time_s + SoundEnvelope::kPiece_s;
    if (amount < peak / 4) is_on = false;
  }
  return bursts;
}

}  // namespace articap
