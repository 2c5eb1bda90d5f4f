// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace articap {

// Little-endian numbers appended to a string.
class C3dOutput {
 public:
  void U8(int value) { bytes_.push_back(static_cast<char>(value)); }
  void U16(int value) {
    U8(value & 0xFF);
    U8(value >> 8 & 0xFF);
  }
  void F32(float value);
  void Append(std::string_view bytes) { bytes_.append(bytes); }
  void PadToBlock();
  void Reserve(std::size_t num_bytes) { bytes_.reserve(num_bytes); }
  std::size_t size() const { return bytes_.size(); }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

// Builds the parameter section of a C3D file (Intel).
class C3dParameterWriter {
 public:
  void BeginGroup(std::string_view name);
  void Add(std::string_view name, int value);  // 16 bits, unsigned above 32767
  void Add(std::string_view name, float value);
  void Add(std::string_view name, std::string_view text);
  void AddWords(std::string_view name, std::span<const int> words, const std::vector<int>& dims);
  void AddFloats(std::string_view name, std::span<const float> values,
                 const std::vector<int>& dims);
  // NAME, NAME2, NAME3, ... as many as a list of more than 255 entries needs. An entry spans
  // `width` values.
  void AddTextList(std::string_view name, const std::vector<std::string>& texts);
  void AddFloatList(std::string_view name, std::span<const float> values, int width = 1);
  void AddWordList(std::string_view name, std::span<const int> values);

  // The section, padded to whole blocks.
  std::string Finish() &&;
  std::size_t size() const { return records_.size(); }

 private:
  void AddRecord(std::string_view name, int type, const std::vector<int>& dims,
                 std::string_view data);

  int num_groups_ = 0;
  C3dOutput records_;
};

}  // namespace articap
