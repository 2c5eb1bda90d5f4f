// SPDX-License-Identifier: MIT
#include "tracking/corrections.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/file_io.h"
#include "core/toml_reader.h"

namespace articap {
namespace {

std::string NonEmpty(const TomlReader& reader, const char* key) {
  std::string text = reader.Text(key);
  if (text.empty()) reader.Fault(key, "must not be empty");
  return text;
}

constexpr int kMostFrames = 1000000000;

void ReadFrame(const TomlReader& reader, Correction& correction) {
  correction.first = correction.last = reader.Integer("frame");
  if (correction.first < 0 || correction.first > kMostFrames)
    reader.Fault("frame", "is no number that a frame can have");
}

// frame = 12, or frames = [12, 20].
void ReadFrames(const TomlReader& reader, Correction& correction) {
  if (reader.Has("frame") == reader.Has("frames")) {
    reader.Fault("frames", "is needed, [first, last], or 'frame' for a single one; not both");
    return;
  }
  if (reader.Has("frame")) {
    ReadFrame(reader, correction);
    return;
  }
  const std::vector<double> frames = reader.Numbers("frames");
  const bool are_two = frames.size() == 2 && frames[0] >= 0 && frames[1] <= kMostFrames &&
                       frames[0] == std::floor(frames[0]) && frames[1] == std::floor(frames[1]);
  if (!are_two || frames[0] > frames[1]) {
    reader.Fault("frames", "must be two whole numbers, the first frame and the last");
    return;
  }
  correction.first = static_cast<int>(frames[0]);
  correction.last = static_cast<int>(frames[1]);
}

void ReadPlace(const TomlReader& reader, const char* key, Correction& correction) {
  correction.view = NonEmpty(reader, "view");
  const std::vector<double> place = reader.Numbers(key);
  if (place.size() != 2) {
    reader.Fault(key, "must be two numbers, x and y in pixels");
    return;
  }
  correction.place_px = {place[0], place[1]};
}

Correction ReadRelabel(const TomlReader& reader) {
  reader.AllowOnly({"marker", "is", "frame", "frames"});
  Correction correction;
  correction.kind = CorrectionKind::kRelabel;
  correction.marker = NonEmpty(reader, "marker");
  correction.other = NonEmpty(reader, "is");
  ReadFrames(reader, correction);
  return correction;
}

Correction ReadSwap(const TomlReader& reader) {
  reader.AllowOnly({"markers", "frame", "frames"});
  Correction correction;
  correction.kind = CorrectionKind::kSwap;
  const std::vector<std::string> markers = reader.Texts("markers");
  if (markers.size() != 2)
    reader.Fault("markers", "must be the names of two markers");
  else
    std::tie(correction.marker, correction.other) = std::tie(markers[0], markers[1]);
  ReadFrames(reader, correction);
  return correction;
}

Correction ReadDelete(const TomlReader& reader) {
  reader.AllowOnly({"marker", "view", "at_px", "frame", "frames"});
  Correction correction;
  const bool is_dot = reader.Has("view") || reader.Has("at_px");
  correction.kind = is_dot ? CorrectionKind::kDeleteDot : CorrectionKind::kDelete;
  if (is_dot && reader.Has("marker"))
    reader.Fault("marker", "is deleted by its name, a dot by 'view' and 'at_px'; choose one");
  if (is_dot)
    ReadPlace(reader, "at_px", correction);
  else
    correction.marker = NonEmpty(reader, "marker");
  ReadFrames(reader, correction);
  return correction;
}

Correction ReadSplit(const TomlReader& reader) {
  reader.AllowOnly({"marker", "frame"});
  Correction correction;
  correction.kind = CorrectionKind::kSplit;
  correction.marker = reader.Text("marker", "");
  ReadFrame(reader, correction);
  return correction;
}

Correction ReadMove(const TomlReader& reader) {
  reader.AllowOnly({"marker", "view", "frame", "to_px"});
  Correction correction;
  correction.kind = CorrectionKind::kMove;
  correction.marker = NonEmpty(reader, "marker");
  ReadFrame(reader, correction);
  ReadPlace(reader, "to_px", correction);
  return correction;
}

struct Kind {
  const char* name;
  Correction (*read)(const TomlReader&);
};
constexpr Kind kKinds[] = {{"relabel", ReadRelabel},
                           {"swap", ReadSwap},
                           {"delete", ReadDelete},
                           {"split", ReadSplit},
                           {"move", ReadMove}};

void ReadKind(const toml::table& document, const Kind& kind, std::optional<Error>& fault,
              Corrections& corrections) {
  const toml::node* const node = document.get(kind.name);
  if (!node) return;
  const TomlReader whole(document, corrections.source, fault);
  if (!node->is_array_of_tables()) {
    whole.Fault(kind.name, fmt::format("must be a list of tables: [[{}]]", kind.name));
    return;
  }
  for (const toml::node& element : *node->as_array()) {
    const auto line = static_cast<int>(element.source().begin.line);
    const TomlReader reader(*element.as_table(),
                            fmt::format("{}, line {}", corrections.source, line), fault);
    Correction correction = kind.read(reader);
    if (!correction.marker.empty() && correction.marker == correction.other)
      reader.Fault(correction.other, "cannot be put in its own place");
    correction.line = line;
    corrections.list.push_back(std::move(correction));
  }
}

}  // namespace

std::string Correction::WhereIn(const std::string& source) const {
  return fmt::format("{}, line {}", source, line);
}

Result<Corrections> ParseCorrections(const std::string& toml_text, const std::string& source_name) {
  const auto document = ParseToml(toml_text, source_name);
  if (!document) return tl::unexpected(document.error());
  std::optional<Error> fault;
  TomlReader(*document, source_name, fault)
      .AllowOnly({"relabel", "swap", "delete", "split", "move"});
  Corrections corrections = {source_name, {}};
  for (const Kind& kind : kKinds) ReadKind(*document, kind, fault, corrections);
  if (fault) return tl::unexpected(*fault);
  std::stable_sort(corrections.list.begin(), corrections.list.end(),
                   [](const Correction& a, const Correction& b) { return a.line < b.line; });
  return corrections;
}

Result<Corrections> ReadCorrections(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseCorrections(*text, path.string());
}

}  // namespace articap
