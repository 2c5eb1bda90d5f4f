// SPDX-License-Identifier: MIT
#include "core/io/c3d_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "core/check.h"
#include "core/io/c3d_bytes.h"

namespace articap {
namespace {

constexpr std::size_t kMostEntries = 255;  // a dimension is one byte
// The distance to the next record is 16 bits, and some readers take it as signed.
constexpr std::size_t kMostRecordBytes = 32700;

std::string PartName(std::string_view name, std::size_t part) {
  return part == 0 ? std::string(name) : fmt::format("{}{}", name, part + 1);
}

}  // namespace

void C3dOutput::F32(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  U16(static_cast<int>(bits & 0xFFFF));
  U16(static_cast<int>(bits >> 16));
}

void C3dOutput::PadToBlock() {
  bytes_.resize((bytes_.size() + kC3dBlockBytes - 1) / kC3dBlockBytes * kC3dBlockBytes, '\0');
}

void C3dParameterWriter::BeginGroup(std::string_view name) {
  ++num_groups_;
  records_.U8(static_cast<int>(name.size()));
  records_.U8(-num_groups_);
  records_.Append(name);
  records_.U16(3);  // distance to the next record: this number and the description's length
  records_.U8(0);   // no description
}

void C3dParameterWriter::AddRecord(std::string_view name, int type, const std::vector<int>& dims,
                                   std::string_view data) {
  records_.U8(static_cast<int>(name.size()));
  records_.U8(num_groups_);
  records_.Append(name);
  const std::size_t distance = 2 + 1 + 1 + dims.size() + data.size() + 1;
  ARTICAP_CHECK_LT(distance, std::size_t{65536});
  records_.U16(static_cast<int>(distance));
  records_.U8(type);
  records_.U8(static_cast<int>(dims.size()));
  for (const int dim : dims) records_.U8(dim);
  records_.Append(data);
  records_.U8(0);  // no description
}

void C3dParameterWriter::Add(std::string_view name, int value) { AddWords(name, {&value, 1}, {}); }

void C3dParameterWriter::Add(std::string_view name, float value) {
  AddFloats(name, {&value, 1}, {});
}

void C3dParameterWriter::Add(std::string_view name, std::string_view text) {
  AddRecord(name, -1, {static_cast<int>(text.size())}, text);
}

void C3dParameterWriter::AddWords(std::string_view name, std::span<const int> words,
                                  const std::vector<int>& dims) {
  C3dOutput data;
  for (const int word : words) data.U16(word);
  AddRecord(name, 2, dims, data.bytes());
}

void C3dParameterWriter::AddFloats(std::string_view name, std::span<const float> values,
                                   const std::vector<int>& dims) {
  C3dOutput data;
  for (const float value : values) data.F32(value);
  AddRecord(name, 4, dims, data.bytes());
}

void C3dParameterWriter::AddTextList(std::string_view name, const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  const std::size_t entries = std::min(kMostEntries, kMostRecordBytes / length);
  for (std::size_t begin = 0, part = 0; begin < texts.size() || part == 0;
       begin += entries, ++part) {
    const std::size_t end = std::min(texts.size(), begin + entries);
    std::string data;
    for (std::size_t i = begin; i < end; ++i)
      data += texts[i] + std::string(length - texts[i].size(), ' ');
    AddRecord(PartName(name, part), -1, {static_cast<int>(length), static_cast<int>(end - begin)},
              data);
  }
}

void C3dParameterWriter::AddFloatList(std::string_view name, std::span<const float> values,
                                      int width) {
  const std::size_t chunk = kMostEntries * static_cast<std::size_t>(width);
  for (std::size_t begin = 0, part = 0; begin < values.size() || part == 0;
       begin += chunk, ++part) {
    const auto some = values.subspan(begin, std::min(chunk, values.size() - begin));
    const int entries = static_cast<int>(some.size()) / width;
    AddFloats(PartName(name, part), some,
              width == 1 ? std::vector<int>{entries} : std::vector<int>{width, entries});
  }
}

void C3dParameterWriter::AddWordList(std::string_view name, std::span<const int> values) {
  for (std::size_t begin = 0, part = 0; begin < values.size() || part == 0;
       begin += kMostEntries, ++part) {
    const auto some = values.subspan(begin, std::min(kMostEntries, values.size() - begin));
    AddWords(PartName(name, part), some, {static_cast<int>(some.size())});
  }
}

std::string C3dParameterWriter::Finish() && {
  constexpr int kProcessorIntel = 84;
  C3dOutput section;
  const std::size_t num_blocks = (4 + records_.size() + 2 + kC3dBlockBytes - 1) / kC3dBlockBytes;
  section.U8(1);
  section.U8(kC3dKey);
  // One byte: sections above 255 blocks (thousands of labels) are told by the header's data start.
  section.U8(static_cast<int>(std::min<std::size_t>(num_blocks, 255)));
  section.U8(kProcessorIntel);
  section.Append(records_.bytes());
  section.U16(0);  // no further record
  section.PadToBlock();
  return std::move(section.bytes());
}

}  // namespace articap
