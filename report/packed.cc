// SPDX-License-Identifier: MIT
#include "report/packed.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace articap {

static_assert(std::endian::native == std::endian::little, "the page reads little-endian numbers");

std::string Base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Json Quantized(std::span<const double> values) {
  constexpr std::int16_t kMissing = std::numeric_limits<std::int16_t>::min();
  constexpr double kLargest = std::numeric_limits<std::int16_t>::max();
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const bool has_values = low <= high;
  const double offset = has_values ? low / 2 + high / 2 : 0;
  const double half_span = has_values ? high / 2 - low / 2 : 0;
  const double scale = half_span > 0 ? half_span / kLargest : 1;
  std::vector<std::int16_t> codes;
  codes.reserve(values.size());
  for (const double value : values)
    codes.push_back(std::isfinite(value)
                        ? static_cast<std::int16_t>(std::lround((value - offset) / scale))
                        : kMissing);
  return {{"offset", offset},
          {"scale", scale},
          {"data", Base64Of(std::span<const std::int16_t>(codes))}};
}

Envelope EnvelopeOf(std::span<const double> values, int bucket) {
  Envelope envelope;
  for (std::size_t begin = 0; begin < values.size(); begin += static_cast<std::size_t>(bucket)) {
    const std::size_t end = std::min(values.size(), begin + static_cast<std::size_t>(bucket));
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = low;
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isfinite(values[i])) continue;
      if (!(low <= values[i])) low = values[i];
      if (!(high >= values[i])) high = values[i];
    }
    envelope.low.push_back(low);
    envelope.high.push_back(high);
  }
  return envelope;
}

}  // namespace articap
