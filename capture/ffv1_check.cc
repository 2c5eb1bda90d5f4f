// SPDX-License-Identifier: MIT
#include "capture/ffv1_check.h"

#include <cstddef>

extern "C" {
#include <libavutil/crc.h>
}

namespace articap::libav {

bool Ffv1IsWhole(std::span<const std::uint8_t> packet) {
  constexpr std::size_t kFooterBytes = 8;
  const AVCRC* const table = av_crc_get_table(AV_CRC_32_IEEE);
  while (!packet.empty()) {
    if (packet.size() < kFooterBytes) return false;
    const std::uint8_t* const footer = packet.data() + packet.size() - kFooterBytes;
    const std::size_t size =
        (std::size_t{footer[0]} << 16 | std::size_t{footer[1]} << 8 | footer[2]) + kFooterBytes;
    if (size > packet.size()) return false;
    const auto slice = packet.last(size);
    if (av_crc(table, 0, slice.data(), size) != 0) return false;
    packet = packet.first(packet.size() - size);
  }
  return true;
}

}  // namespace articap::libav
