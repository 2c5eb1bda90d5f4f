// SPDX-License-Identifier: MIT
#include "core/marker_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/file_io.h"
#include "core/landmarks.h"
#include "core/toml_reader.h"

namespace articap {
namespace {

constexpr std::array kModes = {StabilizationMode::kRigid, StabilizationMode::kTranslation,
                               StabilizationMode::kNone};

struct RoleField {
  const char* name;
  bool MarkerRole::*field;
};
constexpr std::array kRoles = {RoleField{"head", &MarkerRole::head_reference},
                               RoleField{"strategic", &MarkerRole::strategic},
                               RoleField{"face", &MarkerRole::face}};

// Reads one document; every message names the file and the line.
class MarkerSetReader {
 public:
  explicit MarkerSetReader(std::string source_name) : source_name_(std::move(source_name)) {}

  Result<MarkerSet> Read(const toml::table& document) const {
    if (auto known = CheckKeys(document, {"name", "head", "marker"}); !known)
      return tl::unexpected(known.error());
    MarkerSet set;
    if (auto read = ReadText(document, "name", set.name); !read)
      return tl::unexpected(read.error());
    if (const toml::node* head = document.get("head"))
      if (auto read = ReadHead(*head, set); !read) return tl::unexpected(read.error());
    if (const toml::node* markers = document.get("marker"))
      if (auto read = ReadMarkers(*markers, set); !read) return tl::unexpected(read.error());
    if (set.markers.empty())
      return Fail(fmt::format("{}: the map has no markers; add a [[marker]]", source_name_));
    return set;
  }

 private:
  std::string Where(const toml::node& node) const {
    return fmt::format("{}:{}", source_name_, node.source().begin.line);
  }

  Result<void> CheckKeys(const toml::table& table,
                         std::initializer_list<std::string_view> known) const {
    for (const auto& [key, value] : table)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        return Fail(fmt::format("{}: unknown key '{}'; known here: {}", Where(value), key.str(),
                                fmt::join(known, ", ")));
    return {};
  }

  // Leaves `text` alone where the key is absent.
  Result<void> ReadText(const toml::table& table, std::string_view key, std::string& text) const {
    const toml::node* node = table.get(key);
    if (!node) return {};
    const auto* value = node->as_string();
    if (!value) return Fail(fmt::format("{}: {} must be a \"text\"", Where(*node), key));
    text = value->get();
    return {};
  }

  Result<void> ReadHead(const toml::node& node, MarkerSet& set) const {
    const toml::table* head = node.as_table();
    if (!head) return Fail(fmt::format("{}: head must be a table: [head]", Where(node)));
    if (auto known = CheckKeys(*head, {"mode", "left", "up", "forward"}); !known) return known;
    std::string mode_name = NameOf(set.mode);
    if (auto read = ReadText(*head, "mode", mode_name); !read) return read;
    const auto mode = std::ranges::find_if(
        kModes, [&](StabilizationMode candidate) { return NameOf(candidate) == mode_name; });
    if (mode == kModes.end())
      return Fail(fmt::format("{}: unknown mode '{}'; one of rigid, translation, none",
                              Where(*head->get("mode")), mode_name));
    set.mode = *mode;
    return ReadAxes(*head, set);
  }

  Result<void> ReadAxes(const toml::table& head, MarkerSet& set) const {
    const std::array<const toml::node*, 3> nodes = {head.get("left"), head.get("up"),
                                                    head.get("forward")};
    const auto num_given = std::ranges::count_if(nodes, [](auto* node) { return node != nullptr; });
    if (num_given == 0) return {};
    if (num_given != 3)
      return Fail(
          fmt::format("{}: [head] declares {} of the axes left, up, forward; declare all "
                      "three or none",
                      Where(head), num_given));
    std::array<Eigen::Vector3d, 3> axes;
    for (int i = 0; i < 3; ++i) {
      const auto axis = ReadAxis(*nodes[i]);
      if (!axis) return tl::unexpected(axis.error());
      axes[i] = *axis;
    }
    const auto declared = MakeDeclaredAxes(axes[0], axes[1], axes[2]);
    if (!declared) return Fail(fmt::format("{}: {}", Where(*nodes[0]), declared.error().message));
    set.axes = *declared;
    return {};
  }

  Result<Eigen::Vector3d> ReadAxis(const toml::node& node) const {
    if (const auto* text = node.as_string()) {
      const auto axis = ParseAxis(text->get());
      if (!axis) return Fail(fmt::format("{}: {}", Where(node), axis.error().message));
      return *axis;
    }
    const toml::array* numbers = node.as_array();
    Eigen::Vector3d axis;
    bool is_vector = numbers && numbers->size() == 3;
    for (std::size_t i = 0; is_vector && i < 3; ++i) {
      const auto value = (*numbers)[i].value<double>();
      is_vector = value.has_value();
      if (is_vector) axis[static_cast<int>(i)] = *value;
    }
    if (!is_vector)
      return Fail(fmt::format("{}: an axis is \"+x\", \"-y\", ... or a vector of three numbers",
                              Where(node)));
    return axis;
  }

  Result<void> ReadMarkers(const toml::node& node, MarkerSet& set) const {
    const toml::array* markers = node.as_array();
    if (!markers) return Fail(fmt::format("{}: write [[marker]], not marker", Where(node)));
    for (const toml::node& element : *markers) {
      const toml::table* table = element.as_table();
      if (!table) return Fail(fmt::format("{}: a marker is a table: [[marker]]", Where(element)));
      auto marker = ReadMarker(*table);
      if (!marker) return tl::unexpected(marker.error());
      if (set.Find(marker->name))
        return Fail(fmt::format("{}: marker '{}' is there twice", Where(element), marker->name));
      set.markers.push_back(std::move(*marker));
    }
    return {};
  }

  Result<MarkerRole> ReadMarker(const toml::table& table) const {
    if (auto known = CheckKeys(
            table, {"name", "roles", "landmark", "beside_landmark", "region", "offset_mm"});
        !known)
      return tl::unexpected(known.error());
    MarkerRole marker;
    for (auto read :
         {ReadText(table, "name", marker.name), ReadText(table, "landmark", marker.landmark),
          ReadText(table, "region", marker.region), ReadRoles(table, marker),
          ReadBeside(table, marker), ReadOffset(table, marker)})
      if (!read) return tl::unexpected(read.error());
    if (marker.name.empty()) return Fail(fmt::format("{}: this marker has no name", Where(table)));
    if (!marker.landmark.empty() && !FindLandmark(marker.landmark))
      return Fail(
          fmt::format("{}: unknown landmark '{}' of marker '{}'; docs/landmarks.md lists "
                      "them, and a marker may have none",
                      Where(*table.get("landmark")), marker.landmark, marker.name));
    if (!marker.region.empty() && !IsRegion(marker.region))
      return Fail(fmt::format("{}: unknown region '{}' of marker '{}'; one of {}",
                              Where(*table.get("region")), marker.region, marker.name,
                              fmt::join(AllRegions(), ", ")));
    return marker;
  }

  // A marker may have no roles at all: it is then kept in the tracks and used for nothing.
  Result<void> ReadRoles(const toml::table& table, MarkerRole& marker) const {
    const toml::node* node = table.get("roles");
    if (!node) return Fail(fmt::format("{}: this marker has no roles = [...]", Where(table)));
    const toml::array* roles = node->as_array();
    if (!roles) return Fail(fmt::format("{}: roles must be a list", Where(*node)));
    for (const toml::node& element : *roles) {
      const std::string name = element.value_or(std::string());
      const auto role = std::ranges::find_if(
          kRoles, [&](const RoleField& candidate) { return candidate.name == name; });
      if (role == kRoles.end())
        return Fail(fmt::format("{}: unknown role '{}'; one of head, strategic, face",
                                Where(element), name));
      if (marker.*role->field)
        return Fail(fmt::format("{}: role '{}' is there twice", Where(element), name));
      marker.*role->field = true;
    }
    return {};
  }

  Result<void> ReadBeside(const toml::table& table, MarkerRole& marker) const {
    const toml::node* node = table.get("beside_landmark");
    if (!node) return {};
    const auto value = node->value_exact<bool>();
    if (!value || marker.landmark.empty())
      return Fail(fmt::format("{}: beside_landmark must be true or false, and goes with a landmark",
                              Where(*node)));
    marker.beside_landmark = *value;
    return {};
  }

  Result<void> ReadOffset(const toml::table& table, MarkerRole& marker) const {
    const toml::node* node = table.get("offset_mm");
    if (!node) return {};
    const auto value = node->value<double>();
    // Markers are a few mm across; more is another unit.
    if (!value || !(std::abs(*value) <= 30))
      return Fail(fmt::format("{}: offset_mm must be a number between -30 and 30", Where(*node)));
    marker.offset_mm = *value;
    return {};
  }

  std::string source_name_;
};

std::string TomlAxis(const Eigen::Vector3d& axis) {
  for (int i = 0; i < 3; ++i)
    for (const double sign : {-1.0, 1.0})
      if (axis == sign * Eigen::Vector3d::Unit(i))
        return fmt::format("\"{}{}\"", sign < 0 ? '-' : '+', "xyz"[i]);
  return fmt::format("[{}, {}, {}]", TomlFloat(axis.x()), TomlFloat(axis.y()), TomlFloat(axis.z()));
}

std::string WriteMarker(const MarkerRole& marker) {
  std::vector<std::string> roles;
  for (const RoleField& role : kRoles)
    if (marker.*role.field) roles.push_back(QuotedToml(role.name));
  std::string text = fmt::format("\n[[marker]]\nname = {}\nroles = [{}]\n", QuotedToml(marker.name),
                                 fmt::join(roles, ", "));
  if (!marker.landmark.empty()) text += fmt::format("landmark = {}\n", QuotedToml(marker.landmark));
  if (marker.beside_landmark) text += "beside_landmark = true\n";
  if (!marker.region.empty()) text += fmt::format("region = {}\n", QuotedToml(marker.region));
  if (marker.offset_mm != 0) text += fmt::format("offset_mm = {}\n", TomlFloat(marker.offset_mm));
  return text;
}

}  // namespace

std::string_view RegionOf(const MarkerRole& role) {
  if (!role.region.empty()) return role.region;
  const LandmarkInfo* landmark = FindLandmark(role.landmark);
  return landmark ? landmark->region : std::string_view();
}

const MarkerRole* MarkerSet::Find(std::string_view marker_name) const {
  const auto found = std::ranges::find(markers, marker_name, &MarkerRole::name);
  return found == markers.end() ? nullptr : &*found;
}

const MarkerRole* MarkerSet::FindAtLandmark(std::string_view landmark) const {
  const auto found = std::ranges::find(markers, landmark, &MarkerRole::landmark);
  return found == markers.end() ? nullptr : &*found;
}

Result<Eigen::Vector3d> ParseAxis(const std::string& text) {
  const std::size_t axis = text.size() == 2 ? std::string_view("xyz").find(text[1]) : 3;
  if (axis > 2 || (text[0] != '+' && text[0] != '-'))
    return Fail(fmt::format("'{}' is no axis; one of +x, -x, +y, -y, +z, -z", text));
  const double sign = text[0] == '-' ? -1 : 1;
  return Eigen::Vector3d(sign * Eigen::Vector3d::Unit(static_cast<int>(axis)));
}

Result<DeclaredAxes> MakeDeclaredAxes(const Eigen::Vector3d& left_in_stage,
                                      const Eigen::Vector3d& up_in_stage,
                                      const Eigen::Vector3d& forward_in_stage) {
  Eigen::Matrix3d axes;
  axes << left_in_stage, up_in_stage, forward_in_stage;
  constexpr double kTolerance = 1e-6;
  if (!(axes.transpose() * axes).isIdentity(kTolerance))
    return Fail("the axes left, up and forward must be unit vectors at right angles");
  if (axes.determinant() < 0)
    return Fail(
        "the axes left, up and forward are left-handed (left x up must be forward), which would "
        "mirror the face; check them, and if the data themselves are mirrored, use --mirror");
  return DeclaredAxes{left_in_stage, up_in_stage, forward_in_stage};
}

Result<MarkerSet> ParseMarkerSet(const std::string& toml_text, const std::string& source_name) {
  try {
    const toml::table document = toml::parse(toml_text, source_name);
    return MarkerSetReader(source_name).Read(document);
  } catch (const toml::parse_error& error) {
    return Fail(
        fmt::format("{}:{}: {}", source_name, error.source().begin.line, error.description()));
  }
}

Result<MarkerSet> ReadMarkerSet(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseMarkerSet(*text, path.string());
}

std::string WriteMarkerSet(const MarkerSet& set) {
  std::string text =
      fmt::format("name = {}\n\n[head]\nmode = \"{}\"\n", QuotedToml(set.name), NameOf(set.mode));
  if (set.axes)
    text += fmt::format("left = {}\nup = {}\nforward = {}\n", TomlAxis(set.axes->left_in_stage),
                        TomlAxis(set.axes->up_in_stage), TomlAxis(set.axes->forward_in_stage));
  for (const MarkerRole& marker : set.markers) text += WriteMarker(marker);
  return text;
}

}  // namespace articap
