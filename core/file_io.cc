// SPDX-License-Identifier: MIT
#include "core/file_io.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <new>
#include <system_error>
#include <vector>

namespace articap {
namespace {

// Hands the file to `take` a piece at a time, until it ends or `take` wants no more.
Result<FileDigest> ReadPieces(const std::filesystem::path& path,
                              const std::function<bool(std::string_view)>& take) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return Fail(fmt::format("{}: is no file that can be read; check the path", path.string()));
  Result<std::ifstream> stream = OpenFile(path);
  if (!stream) return tl::unexpected(stream.error());
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       XXH3_freeState);
  if (!state) throw std::bad_alloc();
  XXH3_64bits_reset(state.get());
  constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
  std::vector<char> piece(kPieceBytes);
  FileDigest digest;
  while (*stream) {
    stream->read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto count = static_cast<std::size_t>(stream->gcount());
    XXH3_64bits_update(state.get(), piece.data(), count);
    digest.size_bytes += static_cast<std::int64_t>(count);
    if (!take({piece.data(), count})) break;
  }
  if (stream->bad()) return Fail(fmt::format("{}: reading failed half-way", path.string()));
  digest.xxh3 = fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
  return digest;
}

}  // namespace

Result<std::ifstream> OpenFile(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return Fail(fmt::format("{}: is a folder, not a file; name a file in it", path.string()));
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return Fail(fmt::format("{}: cannot be opened ({}); check the path", path.string(),
                            std::strerror(errno)));
  return stream;
}

Result<std::string> ReadFile(const std::filesystem::path& path) {
  Result<std::ifstream> stream = OpenFile(path);
  if (!stream) return tl::unexpected(stream.error());
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  std::string bytes;
  if (!error) {
    bytes.resize(size);
    stream->read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(stream->gcount()));
  } else {  // a pipe
    bytes.assign(std::istreambuf_iterator<char>(*stream), {});
  }
  if (stream->bad()) return Fail(fmt::format("{}: reading failed half-way", path.string()));
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

bool SyncFile(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool synced = ::fsync(file) == 0;
  ::close(file);
  return synced;
}

std::string HashOf(std::string_view bytes) {
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

Result<FileDigest> DigestOf(const std::filesystem::path& path) {
  return ReadPieces(path, [](std::string_view) { return true; });
}

Result<FileDigest> CopyFile(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::filesystem::path temporary = to;
  temporary += fmt::format(".{}.part", ::getpid());
  std::error_code error;
  const auto fail = [&](const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return Fail(
        fmt::format("{}: cannot be written ({}); check the folder's rights and the free "
                    "space of the disk",
                    to.string(), why));
  };
  if (std::filesystem::exists(to, error)) return fail("it is there already");
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  Result<FileDigest> digest = ReadPieces(from, [&](std::string_view piece) {
    return bool(stream.write(piece.data(), static_cast<std::streamsize>(piece.size())));
  });
  stream.close();
  if (!stream || !SyncFile(temporary)) return fail(std::strerror(errno));
  if (digest) std::filesystem::rename(temporary, to, error);
  if (error) return fail(error.message());
  if (!digest) std::filesystem::remove(temporary, error);
  return digest;
}

}  // namespace articap
