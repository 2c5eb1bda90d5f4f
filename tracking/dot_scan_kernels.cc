// SPDX-License-Identifier: MIT
#include "tracking/dot_scan_kernels.h"

#include <algorithm>

#if defined(__x86_64__) || defined(__i386__)
#define ARTICAP_X86 1
#include <immintrin.h>
#endif

namespace articap {
namespace {

// The second largest of the four: what is above it is above three of them.
template <class Integer>
bool IsOutstanding(const ScanRow<Integer>& row, int x) {
  const int left = row.row[x - row.distance_x], right = row.row[x + row.distance_x];
  const int above = row.above[x], below = row.below[x];
  const int second = std::max(std::min(std::max(left, right), std::max(above, below)),
                              std::max(std::min(left, right), std::min(above, below)));
  return row.row[x] - second > row.margin;
}

template <class Integer>
void MarkOneByOne(const ScanRow<Integer>& row, std::uint32_t* words) {
  for (int first = 0; first < row.width; first += 32) {
    std::uint32_t word = 0;
    for (int i = 0; i < std::min(32, row.width - first); ++i)
      word |= static_cast<std::uint32_t>(IsOutstanding(row, first + i)) << i;
    words[first / 32] = word;
  }
}

#ifdef ARTICAP_X86

// The wider the words, the fewer the pixels; everything else is the same.
__attribute__((target("sse4.1"))) inline __m128i Load128(const void* from) {
  return _mm_loadu_si128(static_cast<const __m128i*>(from));
}

__attribute__((target("avx2"))) inline __m256i Load256(const void* from) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(from));
}

__attribute__((target("sse4.1"))) inline __m128i NotAbove8(const ScanRow<std::uint8_t>& row, int x,
                                                           __m128i margin) {
  const __m128i left = Load128(row.row + x - row.distance_x);
  const __m128i right = Load128(row.row + x + row.distance_x);
  const __m128i above = Load128(row.above + x), below = Load128(row.below + x);
  const __m128i second =
      _mm_max_epu8(_mm_min_epu8(_mm_max_epu8(left, right), _mm_max_epu8(above, below)),
                   _mm_max_epu8(_mm_min_epu8(left, right), _mm_min_epu8(above, below)));
  const __m128i excess = _mm_subs_epu8(_mm_subs_epu8(Load128(row.row + x), second), margin);
  return _mm_cmpeq_epi8(excess, _mm_setzero_si128());
}

__attribute__((target("sse4.1"))) inline __m128i NotAbove16(const ScanRow<std::uint16_t>& row,
                                                            int x, __m128i margin) {
  const __m128i left = Load128(row.row + x - row.distance_x);
  const __m128i right = Load128(row.row + x + row.distance_x);
  const __m128i above = Load128(row.above + x), below = Load128(row.below + x);
  const __m128i second =
      _mm_max_epu16(_mm_min_epu16(_mm_max_epu16(left, right), _mm_max_epu16(above, below)),
                    _mm_max_epu16(_mm_min_epu16(left, right), _mm_min_epu16(above, below)));
  const __m128i excess = _mm_subs_epu16(_mm_subs_epu16(Load128(row.row + x), second), margin);
  return _mm_cmpeq_epi16(excess, _mm_setzero_si128());
}

__attribute__((target("avx2"))) inline __m256i NotAbove8(const ScanRow<std::uint8_t>& row, int x,
                                                         __m256i margin) {
  const __m256i left = Load256(row.row + x - row.distance_x);
  const __m256i right = Load256(row.row + x + row.distance_x);
  const __m256i above = Load256(row.above + x), below = Load256(row.below + x);
  const __m256i second =
      _mm256_max_epu8(_mm256_min_epu8(_mm256_max_epu8(left, right), _mm256_max_epu8(above, below)),
                      _mm256_max_epu8(_mm256_min_epu8(left, right), _mm256_min_epu8(above, below)));
  const __m256i excess = _mm256_subs_epu8(_mm256_subs_epu8(Load256(row.row + x), second), margin);
  return _mm256_cmpeq_epi8(excess, _mm256_setzero_si256());
}

__attribute__((target("avx2"))) inline __m256i NotAbove16(const ScanRow<std::uint16_t>& row, int x,
                                                          __m256i margin) {
  const __m256i left = Load256(row.row + x - row.distance_x);
  const __m256i right = Load256(row.row + x + row.distance_x);
  const __m256i above = Load256(row.above + x), below = Load256(row.below + x);
  const __m256i second = _mm256_max_epu16(
      _mm256_min_epu16(_mm256_max_epu16(left, right), _mm256_max_epu16(above, below)),
      _mm256_max_epu16(_mm256_min_epu16(left, right), _mm256_min_epu16(above, below)));
  const __m256i excess = _mm256_subs_epu16(_mm256_subs_epu16(Load256(row.row + x), second), margin);
  return _mm256_cmpeq_epi16(excess, _mm256_setzero_si256());
}

__attribute__((target("sse4.1"))) std::uint32_t Word128(const ScanRow<std::uint8_t>& row, int x,
                                                        __m128i margin) {
  const auto low = static_cast<std::uint32_t>(_mm_movemask_epi8(NotAbove8(row, x, margin)));
  const auto high = static_cast<std::uint32_t>(_mm_movemask_epi8(NotAbove8(row, x + 16, margin)));
  return ~(low | high << 16);
}

__attribute__((target("sse4.1"))) std::uint32_t Word128(const ScanRow<std::uint16_t>& row, int x,
                                                        __m128i margin) {
  std::uint32_t word = 0;
  for (int part = 0; part < 2; ++part) {
    const __m128i both = _mm_packs_epi16(NotAbove16(row, x + 16 * part, margin),
                                         NotAbove16(row, x + 16 * part + 8, margin));
    word |= static_cast<std::uint32_t>(_mm_movemask_epi8(both)) << (16 * part);
  }
  return ~word;
}

__attribute__((target("avx2"))) std::uint32_t Word256(const ScanRow<std::uint8_t>& row, int x,
                                                      __m256i margin) {
  return ~static_cast<std::uint32_t>(_mm256_movemask_epi8(NotAbove8(row, x, margin)));
}

__attribute__((target("avx2"))) std::uint32_t Word256(const ScanRow<std::uint16_t>& row, int x,
                                                      __m256i margin) {
  // Packing goes by halves of the registers; the middle two quarters change places.
  const __m256i both = _mm256_permute4x64_epi64(
      _mm256_packs_epi16(NotAbove16(row, x, margin), NotAbove16(row, x + 16, margin)),
      _MM_SHUFFLE(3, 1, 2, 0));
  return ~static_cast<std::uint32_t>(_mm256_movemask_epi8(both));
}

__attribute__((target("sse4.1"))) __m128i Margin128(const ScanRow<std::uint8_t>& row) {
  return _mm_set1_epi8(static_cast<char>(row.margin));
}
__attribute__((target("sse4.1"))) __m128i Margin128(const ScanRow<std::uint16_t>& row) {
  return _mm_set1_epi16(static_cast<short>(row.margin));
}
__attribute__((target("avx2"))) __m256i Margin256(const ScanRow<std::uint8_t>& row) {
  return _mm256_set1_epi8(static_cast<char>(row.margin));
}
__attribute__((target("avx2"))) __m256i Margin256(const ScanRow<std::uint16_t>& row) {
  return _mm256_set1_epi16(static_cast<short>(row.margin));
}

template <class Integer>
__attribute__((target("sse4.1"))) void MarkBySse41(const ScanRow<Integer>& row,
                                                   std::uint32_t* words) {
  const __m128i margin = Margin128(row);
  for (int x = 0; x < row.width; x += 32) words[x / 32] = Word128(row, x, margin);
}

template <class Integer>
__attribute__((target("avx2"))) void MarkByAvx2(const ScanRow<Integer>& row, std::uint32_t* words) {
  const __m256i margin = Margin256(row);
  for (int x = 0; x < row.width; x += 32) words[x / 32] = Word256(row, x, margin);
}

#endif

}  // namespace

SimdLevel BestSimdLevel() {
#ifdef ARTICAP_X86
  if (__builtin_cpu_supports("avx2")) return SimdLevel::kAvx2;
  if (__builtin_cpu_supports("sse4.1")) return SimdLevel::kSse41;
#endif
  return SimdLevel::kNone;
}

const char* NameOf(SimdLevel level) {
  switch (level) {
    case SimdLevel::kNone:
      return "none";
    case SimdLevel::kSse41:
      return "SSE4.1";
    case SimdLevel::kAvx2:
      return "AVX2";
  }
  return "";
}

template <class Integer>
void MarkOutstanding(const ScanRow<Integer>& row, SimdLevel level, std::uint32_t* words) {
#ifdef ARTICAP_X86
  if (level != SimdLevel::kNone) {
    if (level == SimdLevel::kAvx2)
      MarkByAvx2(row, words);
    else
      MarkBySse41(row, words);
    // What lies behind the row's end is nothing.
    if (row.width % 32 != 0) words[row.width / 32] &= (1u << (row.width % 32)) - 1;
    return;
  }
#endif
  (void)level;
  MarkOneByOne(row, words);
}

template void MarkOutstanding(const ScanRow<std::uint8_t>& row, SimdLevel level,
                              std::uint32_t* words);
template void MarkOutstanding(const ScanRow<std::uint16_t>& row, SimdLevel level,
                              std::uint32_t* words);

}  // namespace articap
