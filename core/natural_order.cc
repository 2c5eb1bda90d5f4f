// SPDX-License-Identifier: MIT
#include "core/natural_order.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <utility>

namespace articap {
namespace {

bool IsDigit(char c) { return '0' <= c && c <= '9'; }

// The length of the number that a text begins with, and that number without leading zeros.
std::pair<std::size_t, std::string_view> LeadingNumber(std::string_view text) {
  const auto length =
      static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), IsDigit) - text.begin());
  std::string_view number = text.substr(0, length);
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return {length, number};
}

}  // namespace

bool NaturallyBefore(std::string_view first, std::string_view second) {
  const std::string_view whole_first = first, whole_second = second;
  while (!first.empty() && !second.empty()) {
    const auto [first_length, first_number] = LeadingNumber(first);
    const auto [second_length, second_number] = LeadingNumber(second);
    if (first_length == 0 || second_length == 0) {
      if (first[0] != second[0]) return first[0] < second[0];
      first.remove_prefix(1);
      second.remove_prefix(1);
      continue;
    }
    if (first_number != second_number)
      return std::pair(first_number.size(), first_number) <
             std::pair(second_number.size(), second_number);
    first.remove_prefix(first_length);
    second.remove_prefix(second_length);
  }
  // Only leading zeros tell them apart, or one goes on.
  return first.size() != second.size() ? first.size() < second.size() : whole_first < whole_second;
}

std::optional<std::int64_t> LastNumberIn(std::string_view file_name) {
  const std::string_view stem = file_name.substr(0, file_name.rfind('.'));
  const auto end = std::find_if(stem.rbegin(), stem.rend(), IsDigit);
  const auto begin = std::find_if_not(end, stem.rend(), IsDigit);
  constexpr std::ptrdiff_t kMostDigits = 17;
  if (begin == end || begin - end > kMostDigits) return std::nullopt;
  std::int64_t number = 0;
  std::from_chars(&*begin.base(), &*begin.base() + (begin - end), number);
  return number;
}

}  // namespace articap
