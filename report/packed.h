// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace articap {

using Json = nlohmann::ordered_json;

std::string Base64(std::string_view bytes);

template <class Number>
std::string Base64Of(std::span<const Number> numbers) {
  return Base64({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
}

// Numbers as int16: {"offset", "scale", "data"}, where value = offset + scale * int16, base64,
// little-endian. What is not finite becomes -32768. The error is at most 1/130,000 of the span.
Json Quantized(std::span<const double> values);

// The least and the largest of every `bucket` values; NaN where a bucket has none.
struct Envelope {
  std::vector<double> low, high;
};
Envelope EnvelopeOf(std::span<const double> values, int bucket);

}  // namespace articap
