// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/dots.h"
#include "core/image.h"

namespace articap {

// A speaking face with the thirty markers of maps/spectacles30.toml that are on the skin, flat
// white discs, and with spectacles whose five own studs are white, small and half hidden by their
// frame; seen by a pinhole in grey with noise. Eyes and teeth shine.
struct FaceDotPicture {
  Image image;
  // Middles of the dots that are wholly to be seen, at no more than 60 degrees.
  std::vector<Eigen::Vector2d> clear;
  // Of those that are to be seen in part or aslant: found or not, both is right.
  std::vector<Eigen::Vector2d> doubtful;
  // Near the studs: the same.
  std::vector<Eigen::Vector2d> studs;
};

struct FaceDotOptions {
  int pictures = 1;
  int width = 1920;
  int height = 1080;
  double dot_diameter_mm = 3.5;
  int seed = 1;
};
// Of poses all over what is said, the head turned by up to 25 degrees.
std::vector<FaceDotPicture> RenderFaceDots(const FaceDotOptions& options);

// How well points meet the dots of a picture, summed over pictures.
struct DotScore {
  int clear = 0;
  int found = 0;  // of these
  int wrong = 0;  // points that are no dot

  void Add(const FaceDotPicture& picture, const std::vector<Eigen::Vector2d>& points);
  double recall() const { return static_cast<double>(found) / clear; }
  double precision() const { return static_cast<double>(found) / (found + wrong); }
};
std::vector<Eigen::Vector2d> CentersOf(const std::vector<Dot>& dots);

}  // namespace articap
