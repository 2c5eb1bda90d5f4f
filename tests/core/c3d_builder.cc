// SPDX-License-Identifier: MIT
#include "tests/core/c3d_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace articap {
namespace {

constexpr std::size_t kBlock = 512;

void PadToBlock(std::string& bytes) { bytes.resize((bytes.size() + kBlock - 1) / kBlock * kBlock); }

}  // namespace

C3dBuilder::C3dBuilder() {
  SetText("POINT", "UNITS", "mm");
  SetTexts("POINT", "LABELS", {"A", "B", "C"});
}

C3dBuilder::Parameter& C3dBuilder::Find(const std::string& group, const std::string& name) {
  for (Parameter& parameter : parameters)
    if (parameter.group == group && parameter.name == name) return parameter;
  parameters.push_back({group, name, 2, {}, {}, {}});
  return parameters.back();
}

C3dBuilder& C3dBuilder::SetNumbers(const std::string& group, const std::string& name, int type,
                                   std::vector<double> numbers, std::vector<int> dims) {
  if (dims.empty() && numbers.size() > 1) dims = {static_cast<int>(numbers.size())};
  Find(group, name) = {group, name, type, dims, std::move(numbers), {}};
  return *this;
}

C3dBuilder& C3dBuilder::SetText(const std::string& group, const std::string& name,
                                const std::string& text) {
  Find(group, name) = {group, name, -1, {static_cast<int>(text.size())}, {}, text};
  return *this;
}

C3dBuilder& C3dBuilder::SetTexts(const std::string& group, const std::string& name,
                                 const std::vector<std::string>& texts, int length) {
  for (const std::string& text : texts) length = std::max(length, static_cast<int>(text.size()));
  std::string characters;
  for (const std::string& text : texts) characters += text + std::string(length - text.size(), ' ');
  Find(group, name) = {group, name, -1, {length, static_cast<int>(texts.size())}, {}, characters};
  return *this;
}

C3dBuilder& C3dBuilder::Remove(const std::string& group, const std::string& name) {
  std::erase_if(parameters, [&](const Parameter& parameter) {
    return parameter.group == group && parameter.name == name;
  });
  return *this;
}

C3dBuilder::Point C3dBuilder::DefaultPoint(int frame, int point) {
  if (point == 2 && frame % 3 == 1) return {0, 0, 0, -1};
  return {100.0 + 10 * point, -50.0 + 0.125 * frame, 2.5 * point, 256.0 * 5 + 16};
}

std::string C3dBuilder::Word(int value) const {
  const auto low = static_cast<char>(value & 0xFF);
  const auto high = static_cast<char>(value >> 8 & 0xFF);
  return processor == Processor::kMips ? std::string{high, low} : std::string{low, high};
}

std::string C3dBuilder::Float(float value) const {
  if (processor == Processor::kDec) {
    // The VAX's exponents count two more, and its 16-bit halves are swapped.
    const float four_times = value * 4;
    std::uint32_t bits = 0;
    std::memcpy(&bits, &four_times, 4);
    return Word(static_cast<int>(bits >> 16)) + Word(static_cast<int>(bits & 0xFFFF));
  }
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, 4);
  const std::string high = Word(static_cast<int>(bits >> 16));
  const std::string low = Word(static_cast<int>(bits & 0xFFFF));
  return processor == Processor::kMips ? high + low : low + high;
}

std::string C3dBuilder::ParameterSection() const {
  std::vector<std::string> groups;
  std::string records;
  for (const Parameter& parameter : parameters) {
    auto group = std::find(groups.begin(), groups.end(), parameter.group);
    const bool is_new = group == groups.end();
    if (is_new) group = groups.insert(groups.end(), parameter.group);
    const int id = static_cast<int>(group - groups.begin()) + 1;
    if (is_new) {
      records += static_cast<char>(parameter.group.size());
      records += static_cast<char>(-id);
      records += parameter.group + Word(3) + '\0';
    }
    std::string data = parameter.characters;
    for (const double number : parameter.numbers) {
      if (parameter.type == 1) data += static_cast<char>(static_cast<int>(number));
      if (parameter.type == 2) data += Word(static_cast<int>(number));
      if (parameter.type == 4) data += Float(static_cast<float>(number));
    }
    records += static_cast<char>(parameter.name.size());
    records += static_cast<char>(id);
    records += parameter.name;
    records += Word(static_cast<int>(5 + parameter.dims.size() + data.size()));
    records += static_cast<char>(parameter.type);
    records += static_cast<char>(parameter.dims.size());
    for (const int dim : parameter.dims) records += static_cast<char>(dim);
    records += data + '\0';
  }
  const std::size_t num_blocks = (records.size() + 6 + kBlock - 1) / kBlock;
  std::string section{1, 0x50, static_cast<char>(num_blocks), static_cast<char>(processor)};
  section += records + std::string(2, '\0');
  PadToBlock(section);
  return section;
}

std::size_t C3dBuilder::DataOffset() const {
  C3dBuilder complete = *this;
  complete.SetNumbers("POINT", "DATA_START", 2, {0});
  return (parameter_block - 1 + blank_blocks_before_data) * kBlock +
         complete.ParameterSection().size();
}

std::string C3dBuilder::Build() const {
  C3dBuilder complete = *this;
  const auto has = [&](const char* name) {
    return std::any_of(parameters.begin(), parameters.end(), [&](const Parameter& parameter) {
      return parameter.group == "POINT" && parameter.name == name;
    });
  };
  const int data_block = static_cast<int>(DataOffset() / kBlock) + 1;
  if (!has("DATA_START")) complete.SetNumbers("POINT", "DATA_START", 2, {double(data_block)});

  const float signed_scale = is_float ? -scale : scale;
  std::string bytes(kBlock, '\0');
  const auto put = [&](int offset, const std::string& value) {
    bytes.replace(static_cast<std::size_t>(offset), value.size(), value);
  };
  put(0, std::string{static_cast<char>(parameter_block), 0x50});
  put(2, Word(num_points));
  put(4, Word(num_channels * samples_per_frame));
  put(6, Word(first_frame));
  put(8, Word(std::min(first_frame + num_frames - 1, 65535)));
  put(12, Float(signed_scale));
  put(16, Word(data_block));
  put(18, Word(samples_per_frame));
  put(20, Float(rate_hz));
  for (const auto& [offset, value] : header_words) put(offset, Word(value));
  for (const auto& [offset, value] : header_floats) put(offset, Float(value));
  for (const auto& [offset, value] : header_texts) put(offset, value);

  bytes.resize((parameter_block - 1) * kBlock);
  bytes += complete.ParameterSection();
  bytes.resize(bytes.size() + blank_blocks_before_data * kBlock);
  for (int frame = 0; frame < num_frames; ++frame) {
    for (int i = 0; i < num_points; ++i) {
      const Point sample = point(frame, i);
      for (const double coordinate : {sample.x, sample.y, sample.z})
        bytes += is_float ? Float(static_cast<float>(coordinate))
                          : Word(static_cast<int>(std::lround(coordinate / scale)));
      bytes +=
          is_float ? Float(static_cast<float>(sample.word)) : Word(static_cast<int>(sample.word));
    }
    for (int k = 0; k < samples_per_frame; ++k)
      for (int channel = 0; channel < num_channels; ++channel) {
        const double raw = analog(frame * samples_per_frame + k, channel);
        bytes += is_float ? Float(static_cast<float>(raw)) : Word(static_cast<int>(raw));
      }
  }
  PadToBlock(bytes);
  return bytes;
}

}  // namespace articap
