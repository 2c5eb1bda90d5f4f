// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <utility>

#include "core/result.h"

namespace articap {

// For tests: the value, or an exception that says why there is none.
template <class T>
T OrThrow(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

}  // namespace articap
