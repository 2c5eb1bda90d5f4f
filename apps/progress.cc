// SPDX-License-Identifier: MIT
#include "apps/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <utility>

namespace articap {

Progress::Progress(std::string what) : what_(std::move(what)) {
  if (::isatty(STDERR_FILENO) != 0) thread_ = std::thread([this] { Show(); });
}

Progress::~Progress() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void Progress::Show() {
  constexpr auto kStep = std::chrono::seconds(1);
  int elapsed_s = 0;
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, kStep, [this] { return done_; })) {
    ++elapsed_s;
    const double part = part_;
    if (part > 0)
      fmt::print(stderr, "\r{} ... {:.0f} %, {} s", what_, 100 * part, elapsed_s);
    else
      fmt::print(stderr, "\r{} ... {} s", what_, elapsed_s);
    std::fflush(stderr);
  }
  if (elapsed_s > 0) fmt::print(stderr, "\r\033[K");
}

}  // namespace articap
