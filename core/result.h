// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace articap {

// A failure of the world (a file, a device, a user's choice). The message says what was found,
// where (file, line, frame, marker), and what to do about it. Bugs are ARTICAP_CHECKs; numerical
// outcomes are fields of a StageReport.
struct Error {
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

// `return Fail("...")` from any function that returns a Result.
inline tl::unexpected<Error> Fail(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace articap
