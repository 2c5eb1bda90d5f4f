// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cstddef>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rig/io/tinygltf.h"

namespace articap {

// More vertices than any head has: keeps hostile counts from filling the memory.
constexpr std::size_t kMaxElements = 4'000'000;

// Carries the first fault out of the nested readers below.
struct Refusal : std::exception {
  explicit Refusal(std::string text) : message(std::move(text)) {}
  const char* what() const noexcept override { return message.c_str(); }
  std::string message;
};

template <class... Args>
void Require(bool condition, fmt::format_string<Args...> text, Args&&... args) {
  if (!condition) throw Refusal(fmt::format(text, std::forward<Args>(args)...));
}

inline bool IsIndex(int index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

// The elements of an accessor one after another, checked against buffer view and buffer. `what`
// names it in messages; faults are thrown as Refusal.
class ElementReader {
 public:
  ElementReader(const tinygltf::Model& model, int index, std::string_view what);

  std::size_t count() const { return accessor_->count; }
  std::size_t components() const { return components_; }
  int component_type() const { return accessor_->componentType; }

  // Integers are scaled to 0..1 where `normalized`; an accessor without a view is all zeros.
  double Value(std::size_t element, std::size_t component) const;

 private:
  void Locate(const tinygltf::Model& model);

  std::string_view what_;
  const tinygltf::Accessor* accessor_ = nullptr;
  std::size_t components_ = 0;
  std::size_t component_bytes_ = 0;
  std::size_t stride_ = 0;
  const unsigned char* data_ = nullptr;
};

// Finite 32-bit floats; elements of three of them.
std::vector<float> ReadFloats(const tinygltf::Model& model, int index, std::string_view what);
std::vector<Eigen::Vector3f> ReadVectors(const tinygltf::Model& model, int index,
                                         std::string_view what);

}  // namespace articap
