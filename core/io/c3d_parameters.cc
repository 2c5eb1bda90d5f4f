// SPDX-License-Identifier: MIT
#include "core/io/c3d_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "core/io/text.h"

namespace articap {
namespace {

std::string ToUpper(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

std::string TextAt(const C3dBytes& bytes, std::size_t offset, std::size_t length) {
  std::string text;
  for (std::size_t i = 0; i < length; ++i) text += static_cast<char>(bytes.U8(offset + i));
  return CleanText(text.substr(0, text.find('\0')));
}

// A group or parameter as it lies in the file:
//   int8 length of the name (negative: locked), int8 group number (negative: this is the group),
//   the name, int16 distance to the next record from here (0: last), then the group's description,
//   or int8 type, uint8 number of dimensions, the dimensions, the data, the description.
struct Record {
  int group = 0;
  std::string name;
  C3dParameter parameter;
  std::size_t next_offset = 0;  // 0: this was the last
};

// LABELS, LABELS2, ... of 255 entries at most, for at most 65535 points.
constexpr int kMostParts = 300;

enum class RecordStatus { kRead, kEnd, kDamaged };

class RecordReader {
 public:
  RecordReader(const C3dBytes& bytes, std::size_t begin, std::size_t end)
      : bytes_(bytes), at_(begin), end_(end) {}

  std::size_t offset() const { return at_; }

  RecordStatus Next(Record& record) {
    if (!Has(2)) return at_ == end_ ? RecordStatus::kEnd : RecordStatus::kDamaged;
    const auto length =
        static_cast<std::size_t>(std::abs(static_cast<std::int8_t>(bytes_.U8(at_))));
    record.group = static_cast<std::int8_t>(bytes_.U8(at_ + 1));
    if (length == 0 || record.group == 0) return RecordStatus::kEnd;
    if (!Has(2 + length + 2)) return RecordStatus::kDamaged;
    record.name = ToUpper(TextAt(bytes_, at_ + 2, length));
    const std::size_t link = at_ + 2 + length;
    const std::size_t distance = bytes_.U16(link);
    record.next_offset = distance == 0 ? 0 : link + distance;
    if (distance == 1 || (record.group > 0 && !ReadParameter(link + 2, record.parameter)))
      return RecordStatus::kDamaged;
    at_ = record.next_offset == 0 ? end_ : record.next_offset;
    return RecordStatus::kRead;
  }

 private:
  bool Has(std::size_t num_bytes) const { return at_ <= end_ && end_ - at_ >= num_bytes; }

  bool ReadParameter(std::size_t at, C3dParameter& parameter) const {
    if (at + 2 > end_) return false;
    parameter.type = static_cast<std::int8_t>(bytes_.U8(at));
    const std::size_t num_dims = bytes_.U8(at + 1);
    if (std::abs(parameter.type) > 4 || parameter.type == 0 || num_dims > 7) return false;
    at += 2;
    if (at + num_dims > end_) return false;
    parameter.dims.clear();
    parameter.num_elements = 1;
    for (std::size_t i = 0; i < num_dims; ++i) {
      parameter.dims.push_back(bytes_.U8(at + i));
      parameter.num_elements *= static_cast<std::size_t>(parameter.dims.back());
    }
    parameter.data_offset = at + num_dims;
    const auto element_bytes = static_cast<std::size_t>(std::abs(parameter.type));
    return parameter.num_elements * element_bytes <= end_ - parameter.data_offset;
  }

  C3dBytes bytes_;
  std::size_t at_;
  std::size_t end_;
};

// The parameter section usually begins in block 2; the first byte of the file says where.
Result<std::size_t> FindSection(std::span<const std::byte> bytes, const std::string& source_name,
                                std::vector<std::string>& warnings) {
  const C3dBytes raw(bytes, C3dProcessor::kIntel);
  std::size_t block = raw.U8(0);
  if (block == 0) {
    warnings.push_back("The header does not say where the parameters are; block 2 was assumed.");
    block = 2;
  }
  const std::size_t offset = (block - 1) * kC3dBlockBytes;
  if (offset + 4 > bytes.size())
    return Fail(fmt::format(
        "{}: the parameters should begin at byte {}, but the file has {} bytes; it was cut short",
        source_name, offset, bytes.size()));
  return offset;
}

C3dProcessor FindProcessor(std::span<const std::byte> bytes, std::size_t section,
                           std::vector<std::string>& warnings) {
  const C3dBytes raw(bytes, C3dProcessor::kIntel);
  // Some programs count the processors from 0 instead of 83.
  const int number = raw.U8(section + 3);
  if (number >= 84 && number <= 86) return static_cast<C3dProcessor>(number);
  if (number >= 1 && number <= 3) return static_cast<C3dProcessor>(number + 83);
  warnings.push_back(fmt::format(
      "The parameter section names an unknown processor ({}); Intel was assumed.", number));
  return C3dProcessor::kIntel;
}

}  // namespace

Result<C3dParameters> C3dParameters::Parse(std::span<const std::byte> bytes,
                                           const std::string& source_name,
                                           std::vector<std::string>& warnings) {
  const auto section = FindSection(bytes, source_name, warnings);
  if (!section) return tl::unexpected(section.error());
  C3dParameters parameters(C3dBytes(bytes, FindProcessor(bytes, *section, warnings)));
  // The chain of records ends by itself; where it does not, the section's own count of blocks or
  // the first block of the data (each is sometimes wrong) keep it from running into the data.
  const C3dBytes& numbers = parameters.bytes_;
  const std::size_t data = (std::max<std::size_t>(numbers.U16(16), 1) - 1) * kC3dBlockBytes;
  const std::size_t declared = *section + numbers.U8(*section + 2) * kC3dBlockBytes;
  const std::size_t end =
      std::min(bytes.size(), std::max({declared, data, *section + kC3dBlockBytes}));
  std::array<std::string, 129> group_names;
  std::vector<int> group_of_parameter;
  RecordReader reader(parameters.bytes_, *section + 4, end);
  Record record;
  RecordStatus status;
  while ((status = reader.Next(record)) == RecordStatus::kRead) {
    if (record.group < 0) {
      group_names[-record.group] = record.name;
    } else {
      record.parameter.name = record.name;
      parameters.parameters_.push_back(record.parameter);
      group_of_parameter.push_back(record.group);
    }
  }
  if (status == RecordStatus::kDamaged)
    warnings.push_back(fmt::format(
        "The parameter section is damaged at byte {}; the {} parameters before it were kept.",
        reader.offset(), parameters.parameters_.size()));
  for (std::size_t i = 0; i < group_of_parameter.size(); ++i)
    parameters.parameters_[i].group = group_names[group_of_parameter[i]];
  return parameters;
}

const C3dParameter* C3dParameters::Find(std::string_view group, std::string_view name) const {
  for (const C3dParameter& parameter : parameters_)
    if (parameter.group == group && parameter.name == name) return &parameter;
  return nullptr;
}

std::optional<double> C3dParameters::Number(std::string_view group, std::string_view name) const {
  const C3dParameter* parameter = Find(group, name);
  if (!parameter || parameter->num_elements == 0) return std::nullopt;
  switch (parameter->type) {
    case 1:
      return bytes_.U8(parameter->data_offset);
    case 2:
      return bytes_.U16(parameter->data_offset);
    case 4:
      return bytes_.F32(parameter->data_offset);
    default:
      return std::nullopt;
  }
}

std::vector<double> C3dParameters::Numbers(std::string_view group, std::string_view name,
                                           bool is_signed) const {
  std::vector<double> numbers;
  std::string part(name);
  for (int k = 2; k <= kMostParts; ++k) {
    const C3dParameter* parameter = Find(group, part);
    if (!parameter) break;
    for (std::size_t i = 0; i < parameter->num_elements; ++i) {
      const std::size_t at = parameter->data_offset;
      if (parameter->type == 1) numbers.push_back(bytes_.U8(at + i));
      if (parameter->type == 2)
        numbers.push_back(is_signed ? bytes_.I16(at + 2 * i) : double(bytes_.U16(at + 2 * i)));
      if (parameter->type == 4) numbers.push_back(bytes_.F32(at + 4 * i));
    }
    part = fmt::format("{}{}", name, k);
  }
  return numbers;
}

std::vector<std::string> C3dParameters::Texts(std::string_view group, std::string_view name) const {
  std::vector<std::string> texts;
  std::string part(name);
  for (int k = 2; k <= kMostParts; ++k) {
    const C3dParameter* parameter = Find(group, part);
    if (!parameter) break;
    if (parameter->type == -1 && parameter->num_elements > 0) {
      const std::size_t length = parameter->dims.empty() ? 1 : parameter->dims[0];
      for (std::size_t i = 0; i < parameter->num_elements / length; ++i)
        texts.push_back(TextAt(bytes_, parameter->data_offset + i * length, length));
    } else if (parameter->type == -1 && parameter->dims.size() > 1 && parameter->dims[0] == 0) {
      texts.resize(texts.size() + parameter->dims[1]);  // labels without letters
    }
    part = fmt::format("{}{}", name, k);
  }
  return texts;
}

std::string C3dParameters::Text(std::string_view group, std::string_view name) const {
  const std::vector<std::string> texts = Texts(group, name);
  return texts.empty() ? "" : texts.front();
}

std::vector<std::string> C3dParameters::GroupNames() const {
  std::vector<std::string> names;
  for (const C3dParameter& parameter : parameters_)
    if (std::find(names.begin(), names.end(), parameter.group) == names.end())
      names.push_back(parameter.group);
  return names;
}

}  // namespace articap
