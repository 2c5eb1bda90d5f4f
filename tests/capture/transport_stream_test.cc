// SPDX-License-Identifier: MIT
#include "capture/transport_stream.h"

#include <gmock/gmock.h>

#include <string>

namespace articap {
namespace {

// Packets of two streams in turn, counted from `first` on, each after `stamp_bytes` more.
std::string Packets(int count, int first, int stamp_bytes) {
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    bytes += std::string(static_cast<std::size_t>(stamp_bytes), '\0') + "\x47\x01";
    bytes += static_cast<char>(i % 2);
    bytes += static_cast<char>(0x10 | ((first + i / 2) % 16));
    bytes += std::string(184, 'x');
  }
  return bytes;
}

TEST(TransportStreamTest, PacketsThatAreCountedOnGoOn) {
  for (const int stamp_bytes : {0, 4}) {
    const std::string first = Packets(20, 9, stamp_bytes);  // counts to 18
    EXPECT_TRUE(TransportPacketsGoOn(first, Packets(20, 19, stamp_bytes)));
    EXPECT_FALSE(TransportPacketsGoOn(first, Packets(20, 0, stamp_bytes)));
    // The end of a large file is read from within a packet.
    EXPECT_TRUE(TransportPacketsGoOn(first.substr(77), Packets(20, 19, stamp_bytes)));
  }
}

TEST(TransportStreamTest, WithoutPacketsNothingGoesOn) {
  EXPECT_FALSE(TransportPacketsGoOn("", ""));
  EXPECT_FALSE(TransportPacketsGoOn(Packets(20, 9, 0), std::string(5000, 'x')));
}

}  // namespace
}  // namespace articap
