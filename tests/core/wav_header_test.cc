// SPDX-License-Identifier: MIT
#include "core/wav_header.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <sstream>
#include <string>

namespace articap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string Number(std::uint64_t value, int num_bytes) {
  std::string bytes;
  for (int i = 0; i < num_bytes; ++i) bytes += static_cast<char>(value >> 8 * i & 0xFF);
  return bytes;
}

std::string Chunk(const std::string& id, const std::string& content) {
  return id + Number(content.size(), 4) + content + std::string(content.size() % 2, '\0');
}

struct Format {
  int coding = 1;
  int channels = 2;
  int rate_hz = 48000;
  int bits = 16;
  std::string more;

  std::string Bytes() const {
    const int frame = channels * ((bits + 7) / 8);
    return Chunk("fmt ", Number(coding, 2) + Number(channels, 2) + Number(rate_hz, 4) +
                             Number(std::uint64_t(rate_hz) * frame, 4) + Number(frame, 2) +
                             Number(bits, 2) + more);
  }
};

// An extensible format's last part: valid bits, speakers, GUID.
std::string Extension(int coding) {
  return Number(22, 2) + Number(24, 2) + Number(3, 4) + Number(coding, 2) +
         std::string("\x00\x00\x00\x00\x10\x00\x80\x00\x00\xAA\x00\x38\x9B\x71", 14);
}

std::string Riff(const std::string& chunks) {
  return "RIFF" + Number(4 + chunks.size(), 4) + "WAVE" + chunks;
}

Result<WavHeader> Parse(const std::string& bytes) {
  std::istringstream stream(bytes);
  return ParseWavHeader(stream, "a.wav");
}

std::string FaultOf(const std::string& bytes) {
  const auto header = Parse(bytes);
  return header ? "" : header.error().message;
}

TEST(WavHeaderTest, PcmIsRead) {
  const auto header = Parse(Riff(Format{}.Bytes() + Chunk("data", std::string(40, 'x'))));
  ASSERT_TRUE(header) << header.error().message;
  EXPECT_EQ(header->sample_kind, WavHeader::SampleKind::kInteger);
  EXPECT_EQ(header->rate_hz, 48000);
  EXPECT_EQ(header->channels, 2);
  EXPECT_EQ(header->bits, 16);
  EXPECT_EQ(header->frames, 10);
  EXPECT_EQ(header->data_start, 44);
  EXPECT_DOUBLE_EQ(header->duration_s(), 10.0 / 48000);
  EXPECT_THAT(header->warnings, IsEmpty());
}

TEST(WavHeaderTest, FloatAndExtensibleAreRead) {
  const std::string data = Chunk("data", std::string(48, 'x'));
  const auto plain = Parse(Riff(Format{.coding = 3, .channels = 1, .bits = 32}.Bytes() + data));
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_EQ(plain->sample_kind, WavHeader::SampleKind::kFloat);
  EXPECT_EQ(plain->frames, 12);
  const auto extensible =
      Parse(Riff(Format{.coding = 0xFFFE, .bits = 24, .more = Extension(1)}.Bytes() + data));
  ASSERT_TRUE(extensible) << extensible.error().message;
  EXPECT_EQ(extensible->bits, 24);
  EXPECT_EQ(extensible->frames, 8);
}

TEST(WavHeaderTest, UnknownChunksAreSkippedAlsoOfOddSize) {
  const auto header = Parse(Riff(Chunk("bext", "odd") + Format{}.Bytes() + Chunk("LIST", "info") +
                                 Chunk("data", "12345678")));
  ASSERT_TRUE(header) << header.error().message;
  EXPECT_EQ(header->frames, 2);
}

TEST(WavHeaderTest, Rf64TakesItsSizeFromDs64) {
  const auto file = [](const std::string& ds64) {
    return "RF64" + Number(0xFFFFFFFF, 4) + "WAVE" + ds64 + Format{}.Bytes() + "data" +
           Number(0xFFFFFFFF, 4) + std::string(40, 'x') + Chunk("LIST", "after");
  };
  const auto header = Parse(file(Chunk("ds64", Number(100, 8) + Number(40, 8) + Number(10, 8))));
  ASSERT_TRUE(header) << header.error().message;
  EXPECT_EQ(header->frames, 10);
  EXPECT_THAT(header->warnings, IsEmpty());
  EXPECT_THAT(FaultOf(file("")), HasSubstr("ds64"));
  EXPECT_THAT(FaultOf(file(Chunk("ds64", "short"))), HasSubstr("ds64"));
  EXPECT_THAT(FaultOf(file(Chunk("ds64", std::string(24, '\xFF')))), HasSubstr("no file holds"));
}

TEST(WavHeaderTest, LostEndsAreWarnedOf) {
  const std::string start = Riff(Format{}.Bytes());
  const auto cut = Parse(start + "data" + Number(40, 4) + std::string(13, 'x'));
  ASSERT_TRUE(cut) << cut.error().message;
  EXPECT_EQ(cut->frames, 3);
  EXPECT_THAT(cut->warnings,
              ElementsAre(testing::AllOf(HasSubstr("a.wav"), HasSubstr("3 of the 10 frames"))));
  const auto piped = Parse(start + "data" + Number(0xFFFFFFFF, 4) + std::string(16, 'x'));
  ASSERT_TRUE(piped) << piped.error().message;
  EXPECT_EQ(piped->frames, 4);
  EXPECT_THAT(piped->warnings, ElementsAre(HasSubstr("pipe")));
  const auto killed = Parse(start + "data" + Number(0, 4) + std::string(16, 'x'));
  ASSERT_TRUE(killed) << killed.error().message;
  EXPECT_EQ(killed->frames, 0);
  EXPECT_THAT(killed->warnings, ElementsAre(HasSubstr("16 bytes follow")));
}

TEST(WavHeaderTest, EveryCutBeforeTheSamplesIsNamed) {
  const std::string whole = Riff(Format{}.Bytes() + Chunk("data", "12345678"));
  for (std::size_t size = 0; size < 44; ++size)
    EXPECT_THAT(FaultOf(whole.substr(0, size)), HasSubstr("a.wav: ")) << size;
}

TEST(WavHeaderTest, WhatIsNoSoundIsRefused) {
  const std::string data = Chunk("data", "12345678");
  const auto fault_of = [&](const Format& format) { return FaultOf(Riff(format.Bytes() + data)); };
  EXPECT_THAT(FaultOf("FORM....AIFF"), HasSubstr("no WAV"));
  EXPECT_THAT(FaultOf(Riff(data)), HasSubstr("before its format"));
  EXPECT_THAT(fault_of({.coding = 0x55}), HasSubstr("0x0055"));
  EXPECT_THAT(fault_of({.channels = 0}), HasSubstr("0 channels"));
  EXPECT_THAT(fault_of({.rate_hz = 0}), HasSubstr("0 samples a second"));
  EXPECT_THAT(fault_of({.coding = 3, .bits = 16}), HasSubstr("float samples of 16 bits"));
  EXPECT_THAT(fault_of({.coding = 0xFFFE, .more = "x"}), HasSubstr("too short"));
  EXPECT_THAT(fault_of({.coding = 0xFFFE, .more = std::string(24, 'x')}), HasSubstr("private"));
  std::string contradiction = Riff(Format{}.Bytes() + data);
  contradiction[32] = 3;  // bytes of a frame
  EXPECT_THAT(FaultOf(contradiction), HasSubstr("contradicts itself"));
}

}  // namespace
}  // namespace articap
