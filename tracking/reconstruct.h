// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/dots.h"
#include "core/options.h"
#include "core/point_cloud.h"
#include "core/result.h"
#include "tracking/sight_line.h"
#include "tracking/synchronize.h"

namespace articap {

struct ReconstructOptions {
  double calibration_px = 0.05;  // what calibration is taken to be off at a dot, SD
  // How far a dot may lie from where the other views put it, whatever its noise; nothing: as far as
  // the recording itself shows them to lie (Survey).
  std::optional<double> match_px;
  double match_sigmas = 4;  // of its noise, where that is more
  double nearest_mm = 100;  // to a camera, along the ray
  double farthest_mm = 10000;
};

// Where the markers are, roughly: the depth of what a single view sees.
struct WorkingVolume {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  // stage
  double sigma_mm = 100;
};
void VisitOptions(ReconstructOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const ReconstructOptions& options);

// Finds which dots of one instant are the same marker, and where it is. Nothing is known of other
// instants, so that frames can be treated in any order, and in parallel: what one frame gets wrong
// does no harm to the next.
//
// Rays of two views that meet are a hypothesis, to which every other view adds the dot nearest to
// where it would show the point. The hypotheses that most views agree on come first, then the one
// with the least residual; each dot is one marker's. Pairs that only two views support stay beside
// one another as alternatives where they claim the same dot: labels decide. Dots of a single
// camera with mirrors that meet none may be half hidden, and are paired again within a quarter of
// their diameter. Every dot that no more than one
// other view confirms is also there by itself, as far along its ray as the working volume, and with
// its uncertainty.
class Reconstructor {
 public:
  // match_px must be given. Without a volume, single dots are left out.
  Reconstructor(const CameraArray& array, const ReconstructOptions& options,
                const std::optional<WorkingVolume>& volume = std::nullopt);

  // By camera: its dots. In a mirror's camera every dot may be seen directly or by any of its
  // mirrors, as far as the mirror's region says nothing else.
  std::vector<CloudPoint> operator()(std::span<const std::vector<Dot>> dots) const;

  const CameraArray& array() const { return array_; }
  const std::vector<ViewProjection>& projections() const { return projections_; }

 private:
  CameraArray array_;
  ReconstructOptions options_;
  std::optional<WorkingVolume> volume_;
  std::vector<ViewProjection> projections_;
};

// What some frames of a recording, reconstructed with a wide gate, say of it: from what three views
// or more see (two, where nothing else is).
struct RecordingSurvey {
  double match_px = 0;  // five times the median residual
  // The median place and three times the median distance from there; nothing where there is none.
  std::optional<WorkingVolume> volume;
};
RecordingSurvey Survey(const CameraArray& array, std::span<const InstantDots> instants,
                       const ReconstructOptions& options);

// Every instant by itself, on all processors; the result does not depend on their number.
std::vector<std::vector<CloudPoint>> Reconstruct(const CameraArray& array,
                                                 std::span<const InstantDots> instants,
                                                 const ReconstructOptions& options);

}  // namespace articap
