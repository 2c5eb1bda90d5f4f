// SPDX-License-Identifier: MIT
#include "core/file_io.h"

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

namespace articap {

Result<std::string> ReadFile(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return Fail(fmt::format("{}: is a folder, not a file; name a file in it", path.string()));
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return Fail(fmt::format("{}: cannot be opened ({}); check the path", path.string(),
                            std::strerror(errno)));
  const auto size = std::filesystem::file_size(path, error);
  std::string bytes;
  if (!error) {
    bytes.resize(size);
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
  } else {  // a pipe
    bytes.assign(std::istreambuf_iterator<char>(stream), {});
  }
  if (stream.bad()) return Fail(fmt::format("{}: reading failed half-way", path.string()));
  return bytes;
}

Result<void> WriteFile(const std::filesystem::path& path, std::string_view bytes) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error)
    return Fail(fmt::format("{}: the folder cannot be made ({})", path.parent_path().string(),
                            error.message()));
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.part", ::getpid());
  {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.flush();
    if (!stream) {
      const std::string why = std::strerror(errno);
      std::filesystem::remove(temporary, error);
      return Fail(
          fmt::format("{}: cannot be written ({}); check the folder's rights and the free "
                      "space of the disk",
                      path.string(), why));
    }
  }
  std::filesystem::rename(temporary, path, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return Fail(fmt::format("{}: cannot be replaced ({})", path.string(), error.message()));
  }
  return {};
}

std::string HashOf(std::string_view bytes) {
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

}  // namespace articap
