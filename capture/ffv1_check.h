// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace articap::libav {

// Whether a picture in FFV1 (version 3 or later, with checksums) is as it was written. Its slices
// end with their size (3 bytes), a status byte and a CRC-32 over all of it, and are found from the
// end of the packet (RFC 9043, 4.9). libav checks the sums too, but conceals damage without saying
// so. False also for pictures without checksums.
bool Ffv1IsWhole(std::span<const std::uint8_t> packet);

}  // namespace articap::libav
