// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/c3d_bytes.h"
#include "core/result.h"

namespace articap {

// One parameter of a C3D file, e.g. POINT:LABELS.
struct C3dParameter {
  std::string group;  // upper case
  std::string name;
  int type = 0;           // -1 characters, 1 bytes, 2 16-bit integers, 4 floats
  std::vector<int> dims;  // empty for a single value
  std::size_t data_offset = 0;
  std::size_t num_elements = 1;
};

// The parameter section: groups of named values.
class C3dParameters {
 public:
  // Keeps what can be read of a damaged section and says so in `warnings`. Fails where there is no
  // parameter section at all.
  static Result<C3dParameters> Parse(std::span<const std::byte> bytes,
                                     const std::string& source_name,
                                     std::vector<std::string>& warnings);

  const C3dBytes& bytes() const { return bytes_; }
  const C3dParameter* Find(std::string_view group, std::string_view name) const;
  // First element as a number; 16-bit integers unsigned, as counts are.
  std::optional<double> Number(std::string_view group, std::string_view name) const;
  // All elements, and those of NAME2, NAME3, ... where a list was too long for one parameter.
  std::vector<double> Numbers(std::string_view group, std::string_view name,
                              bool is_signed = false) const;
  // Likewise, trimmed; the first dimension is the length.
  std::vector<std::string> Texts(std::string_view group, std::string_view name) const;
  std::string Text(std::string_view group, std::string_view name) const;
  std::vector<std::string> GroupNames() const;

 private:
  explicit C3dParameters(C3dBytes bytes) : bytes_(bytes) {}

  C3dBytes bytes_;
  std::vector<C3dParameter> parameters_;
};

}  // namespace articap
