// SPDX-License-Identifier: MIT
// The head in 3D: the rig in its compact form, the window's parameters and markers.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "report/page_data.h"

namespace articap {
namespace {

std::span<const double> Flat(const std::vector<Eigen::Vector3d>& points) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  return {points.empty() ? nullptr : points.front().data(), 3 * points.size()};
}

Json Array(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

// Indices in as few bytes as the number of vertices allows.
Json Indices(const std::vector<int>& indices, int num_vertices) {
  if (num_vertices <= 65536) {
    const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
    return {{"bytes", 2}, {"data", Base64Of(std::span<const std::uint16_t>(narrow))}};
  }
  const std::vector<std::uint32_t> wide(indices.begin(), indices.end());
  return {{"bytes", 4}, {"data", Base64Of(std::span<const std::uint32_t>(wide))}};
}

// The transfer function of sRGB, so that eight bits are enough in the shadows.
std::uint8_t SrgbByte(float linear) {
  const double value = std::clamp(static_cast<double>(linear), 0.0, 1.0);
  const double encoded =
      value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

Json PartsData(const RigDefinition& rig) {
  const int num_vertices = static_cast<int>(rig.mesh.vertices.size());
  Json parts = Json::array();
  for (std::size_t part = 0; part < rig.part_names.size(); ++part) {
    std::vector<int> corners;
    for (std::size_t i = 0; i < rig.mesh.triangles.size(); ++i)
      if (rig.triangle_part[i] == part)
        for (const int corner : {0, 1, 2}) corners.push_back(rig.mesh.triangles[i][corner]);
    if (!corners.empty())
      parts.push_back(
          {{"name", rig.part_names[part]}, {"triangles", Indices(corners, num_vertices)}});
  }
  return parts;
}

Json JawData(const FaceRig& rig) {
  const JawJoint& jaw = *rig.definition().jaw;
  std::vector<int> vertices;
  std::vector<double> weights;
  for (int vertex = 0; vertex < rig.num_vertices(); ++vertex) {
    if (rig.jaw_weight(vertex) == 0) continue;
    vertices.push_back(vertex);
    weights.push_back(rig.jaw_weight(vertex));
  }
  return {{"vertices", Indices(vertices, rig.num_vertices())},
          {"weights", Quantized(weights)},
          {"pivot", Array(rig.neutral_mesh().vertices[jaw.pivot_vertex])},
          {"axis", Array(jaw.axis)},
          {"thrust_direction", Array(jaw.thrust_direction)},
          {"shift_direction", Array(jaw.shift_direction)},
          {"rotation_parameter", jaw.rotation_parameter},
          {"thrust_parameter", jaw.thrust_parameter},
          {"shift_parameter", jaw.shift_parameter}};
}

Json RigData(const FaceRig& rig) {
  const RigDefinition& definition = rig.definition();
  std::vector<std::uint8_t> colors;
  for (const Eigen::Vector3f& color : definition.colors)
    for (const float channel : color) colors.push_back(SrgbByte(channel));
  Json fields = Json::array();
  for (int i = 0; i < rig.num_parameters(); ++i) {
    const DisplacementField& field = rig.field(i);
    fields.push_back({{"vertices", Indices(field.vertices, rig.num_vertices())},
                      {"displacements", Quantized(Flat(field.displacements_mm))}});
  }
  Json data = {{"name", definition.name},
               {"num_vertices", rig.num_vertices()},
               {"vertices", Quantized(Flat(rig.neutral_mesh().vertices))},
               {"colors", Base64Of(std::span<const std::uint8_t>(colors))},
               {"parts", PartsData(definition)},
               {"fields", std::move(fields)}};
  data["jaw"] = definition.jaw ? JawData(rig) : Json(nullptr);
  return data;
}

// Bytes of the rig in the page, roughly, without making them.
std::size_t EstimatedSize(const FaceRig& rig) {
  const std::size_t index_bytes = rig.num_vertices() <= 65536 ? 2 : 4;
  std::size_t bytes = static_cast<std::size_t>(rig.num_vertices()) * (6 + 3 + 2 + index_bytes) +
                      rig.definition().mesh.triangles.size() * 3 * index_bytes;
  for (int i = 0; i < rig.num_parameters(); ++i)
    bytes += rig.field(i).vertices.size() * (6 + index_bytes);
  return bytes * 4 / 3;
}

// Positions of the markers named, frame by frame of the window; NaN where they are not known.
Json MarkerPositions(const RigTracks* tracks, const std::vector<std::string>& names,
                     const std::vector<int>& frame_numbers) {
  if (!tracks) return nullptr;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector3d> positions_mm;
  positions_mm.reserve(names.size() * frame_numbers.size());
  std::vector<std::optional<int>> columns;
  columns.reserve(names.size());
  for (const std::string& name : names) columns.push_back(tracks->Find(name));
  for (const int number : frame_numbers) {
    const std::int64_t frame = static_cast<std::int64_t>(number) - tracks->first_frame();
    const bool is_there = frame >= 0 && frame < tracks->num_frames();
    for (const std::optional<int>& column : columns)
      positions_mm.push_back(is_there && column
                                 ? tracks->position_mm(static_cast<int>(frame), *column)
                                 : Eigen::Vector3d::Constant(kNaN));
  }
  return Quantized(Flat(positions_mm));
}

std::vector<std::string> MarkerNames(const ReportPageInput& input) {
  std::vector<std::string> names;
  for (const RigTracks* tracks : {input.virtual_markers, input.measured}) {
    if (!tracks) continue;
    for (const std::string& name : tracks->names())
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

}  // namespace

Json SceneData(const ReportPageInput& input, const FrameWindow& window) {
  constexpr std::int64_t kMostPositions = 150'000;     // twelve bytes a marker and frame
  constexpr std::size_t kLargestRigBytes = 3'500'000;  // some 80,000 vertices
  const ParameterTrack& track = *input.parameters;
  const std::vector<std::string> names = MarkerNames(input);
  const std::int64_t num_positions =
      static_cast<std::int64_t>(names.size() + static_cast<std::size_t>(track.num_parameters())) *
      window.count;
  const int stride = static_cast<int>(
      std::max<std::int64_t>(1, (num_positions + kMostPositions - 1) / kMostPositions));
  std::vector<int> frame_numbers;
  std::vector<double> values;
  for (int i = 0; i < window.count; i += stride) {
    const int frame = window.first + i;
    frame_numbers.push_back(track.first_frame + frame);
    for (int k = 0; k < track.num_parameters(); ++k) values.push_back(track.values(frame, k));
  }
  Json data = {{"first", window.first},
               {"stride", stride},
               {"count", frame_numbers.size()},
               {"marker_names", names},
               {"measured", MarkerPositions(input.measured, names, frame_numbers)},
               {"virtual", MarkerPositions(input.virtual_markers, names, frame_numbers)}};
  const bool rig_fits = input.rig && EstimatedSize(*input.rig) <= kLargestRigBytes;
  data["rig"] = rig_fits ? RigData(*input.rig) : Json(nullptr);
  data["rig_is_too_large"] = input.rig && !rig_fits;
  // The rig's parameters by name: the track may hold fewer, in another order.
  data["rig_values"] = Json::array();
  if (rig_fits)
    for (int i = 0; i < input.rig->num_parameters(); ++i) {
      const std::string& name = input.rig->definition().parameters[i].name;
      const auto found = std::find(track.names.begin(), track.names.end(), name);
      if (found == track.names.end()) {
        data["rig_values"].push_back(nullptr);
        continue;
      }
      const std::size_t column = static_cast<std::size_t>(found - track.names.begin());
      std::vector<double> of_parameter;
      for (std::size_t at = column; at < values.size(); at += track.names.size())
        of_parameter.push_back(values[at]);
      data["rig_values"].push_back(Quantized(of_parameter));
    }
  return data;
}

}  // namespace articap
