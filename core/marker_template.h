// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace articap {

// Where a marker sits on the head.
struct TemplateMarker {
  std::string name;
  // In the frame of the template, which is fixed to the skull; its axes are those of the picture,
  // layout or file that it was learnt from.
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  // How far it strays from there, SD of a coordinate: little for what sits on the skull or on
  // spectacles, some millimetres for lips; also how roughly a layout knows its place.
  double sigma_mm = 3;
  bool head_reference = false;  // moves with the skull
  // Where only a single view ever saw it: along its line of sight the place is not measured but
  // estimated, to this vector's length, SD. Zero where it is measured in all directions.
  Eigen::Vector3d unmeasured_mm = Eigen::Vector3d::Zero();

  // Of where the marker is at any time.
  Eigen::Matrix3d covariance_mm2() const {
    return sigma_mm * sigma_mm * Eigen::Matrix3d::Identity() +
           unmeasured_mm * unmeasured_mm.transpose();
  }

  bool operator==(const TemplateMarker&) const = default;
};

// What the markers of a speaker are known by: labels come from it alone. A commented TOML file:
//   name = "anna"
//   learnt_from = "take01, frame 1"     # in words
//   [[marker]]
//   name = "Chin"
//   position_mm = [1.2, -95.0, 60.1]
//   sigma_mm = 5.0
//   head = false                        # moves with the skull; optional
//   unmeasured_mm = [0.5, 0.2, 4.0]     # optional
struct MarkerTemplate {
  std::string name;
  std::string learnt_from;
  std::vector<TemplateMarker> markers;

  std::optional<int> Find(std::string_view marker_name) const;
  std::vector<std::string> names() const;

  bool operator==(const MarkerTemplate&) const = default;
};

// Refused, naming file and line: unknown keys, markers without a name or there twice, positions
// that are not finite, sigmas that are not positive.
Result<MarkerTemplate> ParseMarkerTemplate(const std::string& toml_text,
                                           const std::string& source_name);
Result<MarkerTemplate> ReadMarkerTemplate(const std::filesystem::path& path);
// Positions to a micrometre.
std::string WriteMarkerTemplate(const MarkerTemplate& marker_template);

}  // namespace articap
