// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace articap {

struct OpenCvMatrix {
  int rows = 0;
  int columns = 0;
  std::vector<double> values;  // row by row
};

// The top level of a YAML file of cv::FileStorage: names with scalars, or with matrices below them.
// What lies deeper is kept as text and not looked into, so that files with more than a camera's
// numbers in them are read. (cv::FileStorage itself throws, or worse, on files that are not whole.)
class OpenCvDocument {
 public:
  static Result<OpenCvDocument> Parse(std::string_view text, const std::string& source_name);

  bool Has(const std::string& key) const { return entries_.contains(key); }
  // The value beside the key, without quotes; empty where there is none.
  std::string Text(const std::string& key) const;
  Result<double> Number(const std::string& key) const;
  // One channel of numbers, of at most this many.
  Result<OpenCvMatrix> Matrix(const std::string& key, int most_values) const;

 private:
  struct Entry {
    int line = 0;
    std::string value;  // beside the key
    std::string block;  // the lines below that are indented
  };
  tl::unexpected<Error> FaultIn(const std::string& key, const std::string& what) const;

  std::string source_name_;
  std::map<std::string, Entry> entries_;
};

}  // namespace articap
