// SPDX-License-Identifier: MIT
#include "capture/sound_events.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <utility>

#include "core/wav_writer.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kRate_hz = 44100;
using Spans = std::vector<std::pair<double, double>>;

bool IsIn(const Spans& spans, double time_s) {
  for (const auto& [start_s, end_s] : spans)
    if (start_s <= time_s && time_s < end_s) return true;
  return false;
}

// A hum of 200 Hz in the spans, over noise and a constant part.
std::vector<float> Hum(const Spans& spans, double duration_s, double noise, double constant) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  std::vector<float> samples;
  for (int i = 0; i < duration_s * kRate_hz; ++i) {
    const double time_s = i / kRate_hz;
    const double hum = IsIn(spans, time_s) ? 0.2 * std::sin(1256.6 * time_s) : 0;
    samples.push_back(static_cast<float>(constant + hum + noise * normal(random)));
  }
  return samples;
}

SoundEnvelope EnvelopeOf(const std::vector<float>& samples) {
  EnvelopeMeter meter(kRate_hz);
  const std::span<const float> all(samples);
  meter.Add(all.first(1000));  // in pieces of no particular length
  meter.Add(all.subspan(1000));
  return meter.Finish();
}

// To the grid on which levels are taken.
void ExpectCuts(const std::vector<Cut>& cuts, const Spans& spans, double tolerance_s) {
  ASSERT_THAT(cuts, SizeIs(spans.size()));
  for (std::size_t i = 0; i < spans.size(); ++i) {
    EXPECT_NEAR(cuts[i].start_s, spans[i].first, tolerance_s);
    EXPECT_NEAR(cuts[i].end_s, spans[i].second, tolerance_s);
  }
}

TEST(SoundEventsTest, PiecesAreMilliseconds) {
  const SoundEnvelope envelope = EnvelopeOf(Hum({{1, 2}}, 3, 0, 0.25));
  ASSERT_THAT(envelope.pieces, SizeIs(3000));
  EXPECT_NEAR(envelope.pieces[500].mean, 0.25, 1e-6);
  EXPECT_NEAR(envelope.pieces[500].mean_square, 0.0625, 1e-6);
  EXPECT_EQ(envelope.pieces[999].peak, 0.25);
  EXPECT_GT(envelope.pieces[1001].peak, 0.35);
  EXPECT_EQ(envelope.pieces[2001].peak, 0.25);
}

TEST(SoundEventsTest, SpeechLiesBetweenSilences) {
  // The second has a pause within, the third is a click.
  const Spans spans = {{1, 2}, {3, 3.5}, {3.8, 4.2}, {5, 5.04}};
  for (const double noise : {0.0, 0.001, 0.01})
    ExpectCuts(FindSpeech(EnvelopeOf(Hum(spans, 7, noise, 0.1)), {}), {{1, 2}, {3, 4.2}}, 0.011);
  SpeechRule rule;
  rule.min_speech_s = 0.01;
  rule.min_silence_s = 0.2;
  ExpectCuts(FindSpeech(EnvelopeOf(Hum(spans, 7, 0.001, 0)), rule), spans, 0.011);
}

TEST(SoundEventsTest, WithoutSpeechThereIsNone) {
  EXPECT_THAT(FindSpeech(EnvelopeOf(Hum({}, 3, 0.01, 0.1)), {}), IsEmpty());
  EXPECT_THAT(FindSpeech(EnvelopeOf(Hum({}, 3, 0, 0)), {}), IsEmpty());
  EXPECT_THAT(FindSpeech({}, {}), IsEmpty());
}

TEST(SoundEventsTest, PulsesMakeBursts) {
  // 5 ms long, 40 ms apart, of either sign; one misses.
  std::vector<float> samples = Hum({}, 8, 0.003, 0);
  for (const double start_s : {1.0, 1.04, 1.12, 4.0, 4.04, 6.5})
    for (int i = 0; i < 220; ++i)
      samples[static_cast<std::size_t>(start_s * kRate_hz) + i] += start_s > 4 ? -0.7F : 0.8F;
  const SoundEnvelope envelope = EnvelopeOf(samples);
  const Spans bursts = {{1, 1.125}, {4, 4.045}, {6.5, 6.505}};
  ExpectCuts(FindPulseBursts(envelope, 1), bursts, 0.0015);
  ExpectCuts(FindPulseBursts(envelope, 2.6), {{1, 1.125}, {4, 6.505}}, 0.0015);
  EXPECT_THAT(FindPulseBursts(EnvelopeOf(Hum({}, 3, 0.1, 0)), 1), IsEmpty());
  EXPECT_THAT(FindPulseBursts({}, 1), IsEmpty());
}

TEST(SoundEventsTest, AChannelOfAFileIsRead) {
  const fs::path folder = MakeTemporaryFolder("articap_sound_events_test");
  const fs::path path = folder / "a.wav";
  WavWriter writer =
      OrThrow(WavWriter::Create(path, {WavHeader::SampleKind::kInteger, 16, 2, 8000}));
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(writer.Write({"\x00\x40\x00\x00", 4}));  // 0.5 and 0
  ASSERT_TRUE(writer.Finish());
  ASSERT_THAT(OrThrow(ReadEnvelope(path, 0)).pieces, SizeIs(2));
  EXPECT_EQ(OrThrow(ReadEnvelope(path, 0)).pieces[1].peak, 0.5);
  EXPECT_EQ(OrThrow(ReadEnvelope(path, 1)).pieces[1].peak, 0);
  EXPECT_THAT(ReadEnvelope(path, 2).error().message, HasSubstr("no channel 3"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace articap
