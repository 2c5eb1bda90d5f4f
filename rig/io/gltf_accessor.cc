// SPDX-License-Identifier: MIT
#include "rig/io/gltf_accessor.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace articap {
namespace {

template <class T>
T Read(const unsigned char* at) {
  T value;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

double Scaled(const tinygltf::Accessor& accessor, double value, double full) {
  return accessor.normalized ? value / full : value;
}

}  // namespace

ElementReader::ElementReader(const tinygltf::Model& model, int index, std::string_view what)
    : what_(what) {
  Require(IsIndex(index, model.accessors.size()), "{}: there is no accessor {}", what, index);
  accessor_ = &model.accessors[index];
  Require(!accessor_->sparse.isSparse,
          "{}: the accessor is sparse, which is not supported; export without sparse accessors",
          what);
  Require(accessor_->count <= kMaxElements, "{}: {} elements are too many", what, accessor_->count);
  const int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor_->type));
  const int bytes =
      tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor_->componentType));
  Require(components > 0 && bytes > 0, "{}: the accessor has no known type", what);
  components_ = static_cast<std::size_t>(components);
  component_bytes_ = static_cast<std::size_t>(bytes);
  if (accessor_->bufferView >= 0) Locate(model);
}

double ElementReader::Value(std::size_t element, std::size_t component) const {
  if (!data_) return 0;
  const unsigned char* at = data_ + element * stride_ + component * component_bytes_;
  switch (accessor_->componentType) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return Read<float>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return Scaled(*accessor_, Read<std::uint8_t>(at), 255);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return Scaled(*accessor_, Read<std::uint16_t>(at), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return Read<std::uint32_t>(at);
    default:
      throw Refusal(fmt::format("{}: signed integers are not expected here", what_));
  }
}

void ElementReader::Locate(const tinygltf::Model& model) {
  Require(IsIndex(accessor_->bufferView, model.bufferViews.size()),
          "{}: there is no buffer view {}", what_, accessor_->bufferView);
  const tinygltf::BufferView& view = model.bufferViews[accessor_->bufferView];
  Require(IsIndex(view.buffer, model.buffers.size()), "{}: there is no buffer {}", what_,
          view.buffer);
  const std::vector<unsigned char>& bytes = model.buffers[view.buffer].data;
  Require(view.byteOffset <= bytes.size() && view.byteLength <= bytes.size() - view.byteOffset,
          "{}: the buffer view reaches over the end of the buffer ({} bytes); the file is cut off",
          what_, bytes.size());
  const std::size_t element = components_ * component_bytes_;
  stride_ = view.byteStride > 0 ? view.byteStride : element;
  Require(stride_ >= element && stride_ <= 255, "{}: the stride of {} bytes is wrong", what_,
          stride_);
  if (accessor_->count == 0) return;
  const std::size_t needed = stride_ * (accessor_->count - 1) + element;
  Require(
      accessor_->byteOffset <= view.byteLength && needed <= view.byteLength - accessor_->byteOffset,
      "{}: {} elements do not fit into the buffer view's {} bytes; the file is damaged", what_,
      accessor_->count, view.byteLength);
  data_ = bytes.data() + view.byteOffset + accessor_->byteOffset;
}

std::vector<float> ReadFloats(const tinygltf::Model& model, int index, std::string_view what) {
  const ElementReader reader(model, index, what);
  Require(reader.component_type() == TINYGLTF_COMPONENT_TYPE_FLOAT,
          "{}: the numbers are not 32-bit floats; export without quantisation", what);
  std::vector<float> values;
  values.reserve(reader.count() * reader.components());
  for (std::size_t i = 0; i < reader.count(); ++i)
    for (std::size_t k = 0; k < reader.components(); ++k) {
      values.push_back(static_cast<float>(reader.Value(i, k)));
      Require(std::isfinite(values.back()), "{}: element {} is not finite", what, i);
    }
  return values;
}

std::vector<Eigen::Vector3f> ReadVectors(const tinygltf::Model& model, int index,
                                         std::string_view what) {
  const ElementReader reader(model, index, what);
  Require(reader.components() == 3, "{}: elements of {} numbers instead of 3", what,
          reader.components());
  const std::vector<float> values = ReadFloats(model, index, what);
  std::vector<Eigen::Vector3f> vectors;
  vectors.reserve(reader.count());
  for (std::size_t i = 0; i < values.size(); i += 3)
    vectors.emplace_back(values[i], values[i + 1], values[i + 2]);
  return vectors;
}

}  // namespace articap
