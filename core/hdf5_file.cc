// SPDX-License-Identifier: MIT
#include "core/hdf5_file.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/check.h"
#include "core/file_io.h"

namespace articap::hdf5 {
namespace {

std::mutex& LibraryMutex() {
  static std::mutex mutex;
  return mutex;
}

constexpr std::size_t kMemoryStep = std::size_t{1} << 20;
constexpr std::size_t kSealSize = 512;  // the smallest user block
constexpr std::string_view kSealText = "articap HDF5, XXH3 of what follows these 512 bytes: ";

std::string SealOf(std::string_view content) {
  std::string seal = std::string(kSealText) + HashOf(content) + "\n";
  seal.resize(kSealSize, '\0');
  return seal;
}

// Object times off: the same content gives the same bytes.
Handle TimelessDatasetProperties() {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  ARTICAP_CHECK(H5Pset_obj_track_times(properties.get(), false) >= 0);
  return properties;
}

Handle SpaceOf(const std::vector<hsize_t>& shape) {
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
}

void WriteAttribute(hid_t object, const char* name, const Handle& type, const Handle& space,
                    const void* data) {
  Handle attribute(H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  ARTICAP_CHECK(attribute.is_valid());
  ARTICAP_CHECK(H5Sget_simple_extent_npoints(space.get()) == 0 ||
                H5Awrite(attribute.get(), type.get(), data) >= 0);
}

std::optional<std::vector<hsize_t>> ShapeOfSpace(const Handle& space) {
  const int rank = space.is_valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
  if (rank < 0) return std::nullopt;
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  if (H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr) < 0) return std::nullopt;
  return shape;
}

// Nothing where the count is beyond any recording.
std::optional<std::size_t> CountOf(const std::vector<hsize_t>& shape) {
  constexpr hsize_t kMost = hsize_t{1} << 31;
  hsize_t count = 1;
  for (const hsize_t size : shape) {
    if (size > 0 && count > kMost / size) return std::nullopt;
    count *= size;
  }
  return static_cast<std::size_t>(count);
}

Handle OpenDataset(hid_t parent, const char* name) {
  const bool exists = H5Lexists(parent, name, H5P_DEFAULT) > 0;
  return {exists ? H5Dopen2(parent, name, H5P_DEFAULT) : -1, H5Dclose};
}

// The number of elements of a dataset, where the file is large enough to hold them.
std::optional<std::size_t> HonestCountOf(const Handle& dataset) {
  // The most that deflate can do; a shape that promises more memory than that is a lie.
  constexpr std::size_t kLargestCompression = 1100;
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const auto shape = ShapeOfSpace(space);
  const auto count = shape ? CountOf(*shape) : std::nullopt;
  if (!count || !type.is_valid()) return std::nullopt;
  const std::size_t stored = static_cast<std::size_t>(H5Dget_storage_size(dataset.get()));
  const std::size_t element = std::max<std::size_t>(H5Tget_size(type.get()), 1);
  if (*count > 0 && *count > kLargestCompression * stored / element) return std::nullopt;
  return count;
}

std::string Trimmed(const char* text, std::size_t size) { return {text, ::strnlen(text, size)}; }

// Texts of fixed length, through a function that reads into a buffer of the type. Texts of variable
// length are not read: on damaged files HDF5 1.10 follows their pointers out of the file.
template <class Read>
std::optional<std::vector<std::string>> StringsOf(const Handle& type, std::size_t count,
                                                  const Read& read) {
  constexpr std::size_t kLongest = 4096;
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0)
    return std::nullopt;
  const std::size_t size = H5Tget_size(type.get());
  if (size == 0 || size > kLongest) return std::nullopt;
  std::vector<char> buffer(count * size);
  if (count > 0 && read(buffer.data()) < 0) return std::nullopt;
  std::vector<std::string> strings(count);
  for (std::size_t i = 0; i < count; ++i) strings[i] = Trimmed(buffer.data() + i * size, size);
  return strings;
}

// Texts padded with zeros to one size.
struct FixedStrings {
  Handle type;
  std::vector<char> bytes;
};

FixedStrings FixedStringsOf(const std::vector<std::string>& values) {
  std::size_t size = 1;
  for (const std::string& value : values) size = std::max(size, value.size());
  std::vector<char> bytes(values.size() * size, '\0');
  for (std::size_t i = 0; i < values.size(); ++i)
    std::copy(values[i].begin(), values[i].end(),
              bytes.begin() + static_cast<std::ptrdiff_t>(i * size));
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  ARTICAP_CHECK(H5Tset_size(type.get(), size) >= 0 && H5Tset_cset(type.get(), H5T_CSET_UTF8) >= 0 &&
                H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0);
  return {std::move(type), std::move(bytes)};
}

template <class Number>
hid_t NativeType();
template <>
hid_t NativeType<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t NativeType<std::int64_t>() {
  return H5T_NATIVE_INT64;
}

}  // namespace

QuietLibrary::QuietLibrary() : lock_(LibraryMutex()) {
  // After damaged files the library cannot tidy up at the end of the program, and prints so. Files
  // live in memory alone: there is nothing that it must bring to disk then.
  static const herr_t no_tidying = H5dont_atexit();
  ARTICAP_CHECK(no_tidying >= 0);
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietLibrary::~QuietLibrary() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

Handle CreateFileInMemory() {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  ARTICAP_CHECK(H5Pset_fapl_core(access.get(), kMemoryStep, false) >= 0);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  ARTICAP_CHECK(H5Pset_userblock(creation.get(), kSealSize) >= 0);
  Handle file(H5Fcreate("in-memory", H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
  ARTICAP_CHECK(file.is_valid());
  return file;
}

Handle OpenFileInMemory(std::string_view bytes) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (H5Pset_fapl_core(access.get(), kMemoryStep, false) < 0 || bytes.empty() ||
      H5Pset_file_image(access.get(), const_cast<char*>(bytes.data()), bytes.size()) < 0)
    return {-1, H5Fclose};
  return {H5Fopen("in-memory", H5F_ACC_RDONLY, access.get()), H5Fclose};
}

std::string SealedBytesOf(const Handle& file) {
  ARTICAP_CHECK(H5Fflush(file.get(), H5F_SCOPE_GLOBAL) >= 0);
  // The library's image of a file leaves out the user block.
  const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
  ARTICAP_CHECK_GT(size, 0);
  std::string content(static_cast<std::size_t>(size), '\0');
  ARTICAP_CHECK_EQ(H5Fget_file_image(file.get(), content.data(), content.size()), size);
  return SealOf(content) + content;
}

bool IsSealed(std::string_view bytes) {
  return bytes.size() >= kSealSize && bytes.starts_with(kSealText);
}

bool SealHolds(std::string_view bytes) {
  return IsSealed(bytes) && bytes.substr(0, kSealSize) == SealOf(bytes.substr(kSealSize));
}

Handle WriteDataset(hid_t parent, const char* name, hid_t file_type, hid_t memory_type,
                    const std::vector<hsize_t>& shape, const void* data) {
  const Handle space = SpaceOf(shape);
  const Handle properties = TimelessDatasetProperties();
  Handle dataset(
      H5Dcreate2(parent, name, file_type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
      H5Dclose);
  ARTICAP_CHECK(dataset.is_valid());
  const bool is_empty = std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end();
  ARTICAP_CHECK(is_empty ||
                H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  return dataset;
}

void WriteStrings(hid_t parent, const char* name, const std::vector<std::string>& values) {
  const FixedStrings strings = FixedStringsOf(values);
  WriteDataset(parent, name, strings.type.get(), strings.type.get(), {values.size()},
               strings.bytes.data());
}

void WriteStringAttribute(hid_t object, const char* name, const std::vector<std::string>& values) {
  const FixedStrings strings = FixedStringsOf(values);
  WriteAttribute(object, name, strings.type, SpaceOf({values.size()}), strings.bytes.data());
}

void WriteStringAttribute(hid_t object, const char* name, const std::string& value) {
  const FixedStrings strings = FixedStringsOf({value});
  WriteAttribute(object, name, strings.type, Handle(H5Screate(H5S_SCALAR), H5Sclose),
                 strings.bytes.data());
}

void WriteNumberAttribute(hid_t object, const char* name, double value) {
  WriteAttribute(object, name, Handle(H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose),
                 Handle(H5Screate(H5S_SCALAR), H5Sclose), &value);
}

std::optional<std::vector<hsize_t>> ShapeOf(hid_t parent, const char* name) {
  const Handle dataset = OpenDataset(parent, name);
  if (!dataset.is_valid()) return std::nullopt;
  return ShapeOfSpace(Handle(H5Dget_space(dataset.get()), H5Sclose));
}

template <class Number>
std::optional<std::vector<Number>> ReadNumbers(hid_t parent, const char* name) {
  const Handle dataset = OpenDataset(parent, name);
  const auto count = dataset.is_valid() ? HonestCountOf(dataset) : std::nullopt;
  if (!count) return std::nullopt;
  std::vector<Number> numbers(*count);
  if (*count > 0 && H5Dread(dataset.get(), NativeType<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                            numbers.data()) < 0)
    return std::nullopt;
  return numbers;
}

template std::optional<std::vector<double>> ReadNumbers<double>(hid_t, const char*);
template std::optional<std::vector<std::int64_t>> ReadNumbers<std::int64_t>(hid_t, const char*);

std::optional<std::vector<std::string>> ReadStrings(hid_t parent, const char* name) {
  const Handle dataset = OpenDataset(parent, name);
  const auto count = dataset.is_valid() ? HonestCountOf(dataset) : std::nullopt;
  if (!count) return std::nullopt;
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  return StringsOf(type, *count, [&](void* buffer) {
    return H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
  });
}

std::optional<std::vector<std::string>> ReadStringAttribute(hid_t parent, const char* dataset,
                                                            const char* name) {
  const Handle object = OpenDataset(parent, dataset);
  if (!object.is_valid() || H5Aexists(object.get(), name) <= 0) return std::nullopt;
  const Handle attribute(H5Aopen(object.get(), name, H5P_DEFAULT), H5Aclose);
  if (!attribute.is_valid()) return std::nullopt;
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  constexpr std::size_t kMost = 1 << 16;  // attributes are small
  const auto shape = ShapeOfSpace(space);
  const auto count = shape ? CountOf(*shape) : std::nullopt;
  if (!count || *count > kMost || !type.is_valid()) return std::nullopt;
  return StringsOf(type, *count,
                   [&](void* buffer) { return H5Aread(attribute.get(), type.get(), buffer); });
}

std::optional<double> ReadNumberAttribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return std::nullopt;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute.is_valid()) return std::nullopt;
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  double value = 0;
  if (H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0)
    return std::nullopt;
  return value;
}

}  // namespace articap::hdf5
