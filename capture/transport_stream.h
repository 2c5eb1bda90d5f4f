// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

namespace articap {

// Whether the second file of an MPEG transport stream goes on where the first was cut, perhaps
// within a picture, as camcorders cut a long recording: in each of its streams the packets are
// counted on, modulo 16 (ISO/IEC 13818-1, 2.4.3.3). False where each is a recording of its own.
bool TransportStreamGoesOn(const std::filesystem::path& first, const std::filesystem::path& second);
// The same of the bytes at the end of the first and at the beginning of the second.
bool TransportPacketsGoOn(std::string_view end_of_first, std::string_view start_of_second);

}  // namespace articap
