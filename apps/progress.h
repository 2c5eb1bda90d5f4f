// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace articap {

// Says on a terminal what is going on and for how long, once it takes more than a second. Silent
// where stderr is no terminal. One at a time; the line is wiped when it ends.
//
//   const auto fit = WithProgress("fitting 1590 frames", [&] { return Fit(...); });
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  void Show();

  std::string what_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::thread thread_;
};

// The result of work(), with progress shown meanwhile.
template <class Work>
auto WithProgress(const std::string& what, const Work& work) {
  const Progress progress(what);
  return work();
}

}  // namespace articap
