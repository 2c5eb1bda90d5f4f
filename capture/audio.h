// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/wav_writer.h"

namespace articap {

struct ExtractedAudio {
  WavFormat format;
  std::int64_t frames = 0;  // samples of every channel
  // Of the first sample after the first picture of the video, or after the file's own time 0 where
  // it holds no pictures.
  std::chrono::nanoseconds offset{0};
  std::vector<std::string> notes;  // what was found out and done, sentences
};

// Whether a video, or a file of sound, has any.
bool HasAudio(const std::filesystem::path& path);

// The sound of a video, or of a file of sound, as a WAV file. Parts are joined as OpenVideo() joins
// them.
//
// - Samples keep what the decoder gives: 16 bits (of 8 or 16), 24 or 32 bits, and, of codings that
//   are computed in floating point (AAC, MP3, Opus, AC-3, ...), floats, which neither round nor
//   clip.
// - What an encoder put before the first sample or behind the last one, and the file says so (edit
//   lists, codec delay), is not part of it.
// - The samples are contiguous: where the file's times leave a gap (of more than 20 ms), or a piece
//   is damaged, there is silence of that length, and a note.
// - The offset is the mean over the first 256 packets, since files round their times, Matroska to a
//   millisecond. Its error is below one sample where packets fall on different fractions.
Result<ExtractedAudio> ExtractAudio(const std::vector<std::filesystem::path>& parts,
                                    const std::filesystem::path& wav_path);

}  // namespace articap
