// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <type_traits>

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

  // How much is done, 0 to 1, where it is known. From any thread.
  void SetPart(double part) { part_ = part; }

 private:
  void Show();

  std::string what_;
  std::atomic<double> part_ = 0;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::thread thread_;
};

// The result of work() or work(progress), with progress shown meanwhile.
template <class Work>
auto WithProgress(const std::string& what, const Work& work) {
  Progress progress(what);
  if constexpr (std::is_invocable_v<Work, Progress&>)
    return work(progress);
  else
    return work();
}

}  // namespace articap
