// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

namespace articap {

inline std::string TextOf(const std::uint8_t* data, std::size_t size) {
  return std::string(reinterpret_cast<const char*>(data), size);
}

// Readers that want a path read the input from here.
class TemporaryFile {
 public:
  TemporaryFile(const std::uint8_t* data, std::size_t size, const std::string& ending)
      : path_("/tmp/articap_fuzz_" + std::to_string(::getpid()) + ending) {
    std::ofstream stream(path_, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  ~TemporaryFile() { ::unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// A property that must hold of whatever was read.
inline void Require(bool holds) {
  if (!holds) std::abort();
}

// write(read(write(x))) equals write(x), where x could be read at all.
template <class Read, class Write>
void RequireRoundTrip(const std::string& input, const Read& read, const Write& write) {
  const auto first = read(input);
  if (!first) return;
  const std::string written = write(*first);
  const auto second = read(written);
  Require(second.has_value());
  Require(write(*second) == written);
}

}  // namespace articap
