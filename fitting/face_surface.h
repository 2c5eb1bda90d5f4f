// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// Where the markers of a face can sit: the outer skin in front of the ears, without neck, mouth
// cavity, eyes, hair and what is worn. Neutral pose of the rig's current identity, mm, rig frame.
class FaceSurface {
 public:
  // Fails for rigs without such a skin.
  static Result<FaceSurface> Create(const FaceRig& rig);

  struct Foot {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();   // of the surface, nearest to the query
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // of its triangle, unit, outwards
    int region = 0;                                    // of the rig
    double distance_mm = 0;
  };
  Foot Nearest(const Eigen::Vector3d& point_in_rig) const;

  // Points spread evenly over the surface, at most about `spacing_mm` apart.
  std::vector<Eigen::Vector3d> Sample(double spacing_mm) const;

  // The landmarks that a marker can sit at: those of this skin and of spectacles.
  struct NamedPlace {
    std::string landmark;
    Eigen::Vector3d point_in_rig = Eigen::Vector3d::Zero();
  };
  const std::vector<NamedPlace>& places() const { return places_; }

 private:
  struct Facet {
    Eigen::Vector3d a, b, c;
    Eigen::Vector3d center;
    double radius_mm = 0;  // of the ball around the center that holds the corners
    Eigen::Vector3d normal;
    int region = 0;
  };

  FaceSurface() = default;

  std::vector<Facet> facets_;
  std::vector<NamedPlace> places_;
};

}  // namespace articap
