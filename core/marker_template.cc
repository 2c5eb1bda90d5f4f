// SPDX-License-Identifier: MIT
#include "core/marker_template.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/file_io.h"
#include "core/toml_reader.h"

namespace articap {
namespace {

constexpr const char* kHead =
    "# Where each marker sits on the speaker's head, mm, in a frame that is fixed to the skull, "
    "and how\n"
    "# far it strays from there (standard deviation of a coordinate). Labels come from this.\n"
    "# Of markers that a single view saw, the depth is estimated, to the length of "
    "unmeasured_mm.\n";

TemplateMarker ReadMarker(const TomlReader& reader) {
  reader.AllowOnly({"name", "position_mm", "sigma_mm", "head", "unmeasured_mm"});
  TemplateMarker marker;
  marker.name = reader.Text("name");
  marker.position_mm = reader.Vector("position_mm");
  marker.sigma_mm = reader.Number("sigma_mm", marker.sigma_mm);
  if (reader.Has("head")) {
    const auto* head = reader.table()["head"].as_boolean();
    if (!head) reader.Fault("head", "must be true or false");
    marker.head_reference = head && head->get();
  }
  if (reader.Has("unmeasured_mm")) marker.unmeasured_mm = reader.Vector("unmeasured_mm");
  if (marker.name.empty()) reader.Fault("name", "must not be empty");
  if (!marker.position_mm.allFinite()) reader.Fault("position_mm", "must be three finite numbers");
  if (!marker.unmeasured_mm.allFinite())
    reader.Fault("unmeasured_mm", "must be three finite numbers");
  if (!(marker.sigma_mm > 0)) reader.Fault("sigma_mm", "must be more than 0");
  return marker;
}

std::string VectorText(const Eigen::Vector3d& v) {
  return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", v.x(), v.y(), v.z());
}

std::string MarkerTable(const TemplateMarker& marker) {
  std::string text =
      fmt::format("\n[[marker]]\nname = {}\nposition_mm = {}\nsigma_mm = {:.3f}\n",
                  QuotedToml(marker.name), VectorText(marker.position_mm), marker.sigma_mm);
  if (marker.head_reference) text += "head = true\n";
  if (!marker.unmeasured_mm.isZero(0))
    text += fmt::format("unmeasured_mm = {}\n", VectorText(marker.unmeasured_mm));
  return text;
}

}  // namespace

std::optional<int> MarkerTemplate::Find(std::string_view marker_name) const {
  for (int i = 0; i < static_cast<int>(markers.size()); ++i)
    if (markers[i].name == marker_name) return i;
  return std::nullopt;
}

std::vector<std::string> MarkerTemplate::names() const {
  std::vector<std::string> names;
  for (const TemplateMarker& marker : markers) names.push_back(marker.name);
  return names;
}

Result<MarkerTemplate> ParseMarkerTemplate(const std::string& toml_text,
                                           const std::string& source_name) {
  const auto document = ParseToml(toml_text, source_name);
  if (!document) return tl::unexpected(document.error());
  std::optional<Error> fault;
  const TomlReader reader(*document, source_name, fault);
  reader.AllowOnly({"name", "learnt_from", "marker"});
  MarkerTemplate result;
  result.name = reader.Text("name", "");
  result.learnt_from = reader.Text("learnt_from", "");
  for (const TomlReader& table : reader.Tables("marker")) {
    TemplateMarker marker = ReadMarker(table);
    if (result.Find(marker.name)) table.Fault("name", "is there twice");
    result.markers.push_back(std::move(marker));
  }
  if (result.markers.empty()) reader.Fault("marker", "is missing: add a [[marker]]");
  if (fault) return tl::unexpected(*fault);
  return result;
}

Result<MarkerTemplate> ReadMarkerTemplate(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseMarkerTemplate(*text, path.string());
}

std::string WriteMarkerTemplate(const MarkerTemplate& marker_template) {
  std::string text = kHead;
  text += fmt::format("name = {}\nlearnt_from = {}\n", QuotedToml(marker_template.name),
                      QuotedToml(marker_template.learnt_from));
  for (const TemplateMarker& marker : marker_template.markers) text += MarkerTable(marker);
  return text;
}

}  // namespace articap
