// SPDX-License-Identifier: MIT
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace articap {

// A broken contract between pieces of code: always a bug, never a consequence of bad input.
class CheckError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

namespace internal {

[[noreturn]] inline void ThrowCheck(const char* file, int line, const std::string& what) {
  throw CheckError(std::string(file) + ":" + std::to_string(line) + ": check failed: " + what);
}

template <class A, class B>
std::string DescribeComparison(const char* expression, const A& a, const B& b) {
  std::ostringstream out;
  out << expression << " (" << a << " vs. " << b << ")";
  return out.str();
}

}  // namespace internal
}  // namespace articap

#define ARTICAP_CHECK(condition)                                                       \
  do {                                                                                 \
    if (!(condition)) ::articap::internal::ThrowCheck(__FILE__, __LINE__, #condition); \
  } while (false)

#define ARTICAP_CHECK_OP(op, a, b)                                                       \
  do {                                                                                   \
    const auto& check_a = (a);                                                           \
    const auto& check_b = (b);                                                           \
    if (!(check_a op check_b))                                                           \
      ::articap::internal::ThrowCheck(                                                   \
          __FILE__, __LINE__,                                                            \
          ::articap::internal::DescribeComparison(#a " " #op " " #b, check_a, check_b)); \
  } while (false)

#define ARTICAP_CHECK_EQ(a, b) ARTICAP_CHECK_OP(==, a, b)
#define ARTICAP_CHECK_LT(a, b) ARTICAP_CHECK_OP(<, a, b)
#define ARTICAP_CHECK_LE(a, b) ARTICAP_CHECK_OP(<=, a, b)
#define ARTICAP_CHECK_GT(a, b) ARTICAP_CHECK_OP(>, a, b)
#define ARTICAP_CHECK_GE(a, b) ARTICAP_CHECK_OP(>=, a, b)
