// SPDX-License-Identifier: MIT
#include "rig/io/makehuman_target.h"

#include <fmt/format.h>
#include <zlib.h>

#include <string>
#include <vector>

#include "rig/io/text_scan.h"

namespace articap {
namespace {

// The largest target of a whole MakeHuman body is 1.2 MB: more is a bomb.
constexpr std::size_t kMaxUnpackedBytes = 16u << 20;

bool IsGzip(std::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

Result<std::string> Unpack(std::string_view bytes, std::string_view source) {
  z_stream stream{};
  if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK)
    return Fail(fmt::format("{}: zlib has no memory left", source));
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string text;
  int status = Z_OK;
  while (status == Z_OK && text.size() < kMaxUnpackedBytes) {
    char chunk[1 << 16];
    stream.next_out = reinterpret_cast<Bytef*>(chunk);
    stream.avail_out = sizeof(chunk);
    status = inflate(&stream, Z_NO_FLUSH);
    text.append(chunk, sizeof(chunk) - stream.avail_out);
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END)
    return Fail(
        fmt::format("{}: the gzip data are damaged, cut off or larger than {} MB; "
                    "fetch the file again",
                    source, kMaxUnpackedBytes >> 20));
  return text;
}

}  // namespace

Result<DisplacementField> ParseMakeHumanTarget(std::string_view bytes, int num_vertices,
                                               std::string_view source) {
  std::string unpacked;
  if (IsGzip(bytes)) {
    auto text = Unpack(bytes, source);
    if (!text) return tl::unexpected(text.error());
    unpacked = std::move(*text);
    bytes = unpacked;
  }
  DisplacementField field;
  std::vector<char> seen(static_cast<std::size_t>(num_vertices), 0);
  std::vector<std::string_view> fields;
  LineScanner lines(bytes);
  std::string_view line;
  while (lines.Next(line)) {
    SplitAtBlanks(line.substr(0, line.find('#')), fields);
    if (fields.empty()) continue;
    const auto fault = [&](const std::string& what) {
      return Fail(fmt::format("{}, line {}: {}", source, lines.line_number(), what));
    };
    if (fields.size() != 4)
      return fault(fmt::format("{} fields; a target has four: vertex dx dy dz", fields.size()));
    const auto vertex = ParseInteger(fields[0]);
    if (!vertex || *vertex < 0 || *vertex >= num_vertices)
      return fault(
          fmt::format("vertex '{}' is not one of the mesh's {}; the target belongs to "
                      "another base mesh",
                      fields[0], num_vertices));
    if (seen[*vertex]) return fault(fmt::format("vertex {} comes twice", *vertex));
    seen[*vertex] = 1;
    Eigen::Vector3d displacement;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = ParseNumber(fields[axis + 1]);
      if (!value) return fault(fmt::format("'{}' is not a finite number", fields[axis + 1]));
      displacement[axis] = *value;
    }
    field.vertices.push_back(*vertex);
    field.displacements_mm.push_back(displacement);
  }
  return field;
}

}  // namespace articap
