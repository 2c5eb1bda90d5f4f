// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/marker_io.h"

// The formats behind ReadMarkers() and FormatMarkers(), one source each.
namespace articap {

Result<MarkerRecording> ReadC3d(std::span<const std::byte> bytes, const std::string& source_name,
                                const MarkerReadOptions& options);
std::string WriteC3d(const MarkerRecording& recording);
// Which of the format's 8 and 16 bit counts would overflow, or nothing.
std::optional<std::string> C3dLimitExceeded(const MarkerRecording& recording);
// What WriteC3d() rounds residuals to, in mm.
float C3dResidualStep(const MarkerRecording& recording);

using TextReader = Result<MarkerRecording>(std::string_view text, const std::string& source_name,
                                           const MarkerReadOptions& options);
TextReader ReadTrc;
TextReader ReadQualisysTsv;
TextReader ReadNexusCsv;
TextReader ReadMotiveCsv;
TextReader ReadPlainCsv;

using TextWriter = std::string(const MarkerRecording& recording);
TextWriter WriteTrc;
TextWriter WriteQualisysTsv;
TextWriter WriteNexusCsv;
TextWriter WriteMotiveCsv;
TextWriter WritePlainCsv;

}  // namespace articap
