// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// The little of HDF5's C API that articap's files need, with handles that close themselves. Not for
// headers of others.
namespace articap::hdf5 {

// An HDF5 identifier that is closed when it goes out of scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }
  bool is_valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Held around every use of the library, which is not thread-safe, and which would print a stack of
// its own errors.
class QuietLibrary {
 public:
  QuietLibrary();
  ~QuietLibrary();
  QuietLibrary(const QuietLibrary&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// Files live in memory here; WriteFile and ReadFile (core/file_io.h) bring them to disk and back,
// so that half a file is never found.
Handle CreateFileInMemory();
Handle OpenFileInMemory(std::string_view bytes);  // invalid where the bytes are not HDF5

// The bytes of a file, headed by a seal: HDF5's user block of 512 bytes, which other programs pass
// over, with the hash of all that follows. HDF5 1.10 reads beyond its buffers on damaged files, so
// that a file is given to it only when its seal is whole.
std::string SealedBytesOf(const Handle& file);
bool IsSealed(std::string_view bytes);   // has a seal, whole or not
bool SealHolds(std::string_view bytes);  // and nothing was changed since

// Writing fails only for want of memory, or by a bug: checked. Texts are UTF-8 of fixed length.
Handle WriteDataset(hid_t parent, const char* name, hid_t file_type, hid_t memory_type,
                    const std::vector<hsize_t>& shape, const void* data);
void WriteStrings(hid_t parent, const char* name, const std::vector<std::string>& values);
void WriteStringAttribute(hid_t object, const char* name, const std::vector<std::string>& values);
void WriteStringAttribute(hid_t object, const char* name, const std::string& value);
void WriteNumberAttribute(hid_t object, const char* name, double value);

// Reading: nothing where the object is missing, of another type, or lies about its size.
std::optional<std::vector<hsize_t>> ShapeOf(hid_t parent, const char* name);
template <class Number>
std::optional<std::vector<Number>> ReadNumbers(hid_t parent, const char* name);
std::optional<std::vector<std::string>> ReadStrings(hid_t parent, const char* name);
std::optional<std::vector<std::string>> ReadStringAttribute(hid_t parent, const char* dataset,
                                                            const char* name);
std::optional<double> ReadNumberAttribute(hid_t object, const char* name);

}  // namespace articap::hdf5
