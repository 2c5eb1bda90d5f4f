// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/tracks.h"
#include "tracking/frame_aligner.h"
#include "tracking/rigidity.h"

namespace articap {

// The shape of the references over a take, by generalised Procrustes analysis (Gower 1975) with
// rigid motions, missing references and robust weights: every frame is aligned to the shape, the
// shape becomes the weighted mean of the aligned frames, until it stands still. Starts from the
// frame that is most like the median of the distances. The frame of the shape is that of the stage
// in that frame, moved to the references' centroid. References that are never seen together with
// three others stay NaN; all of them where no frame shows three.
ReferenceModel EstimateReferenceShape(const StageTracks& tracks, const std::vector<int>& columns,
                                      const std::vector<double>& sigmas_mm,
                                      const DistanceStatistics& distances,
                                      std::span<const int> frames, const AlignerOptions& options);

// Where every marker of the tracks lies in the frame of the shape: the median, coordinate by
// coordinate, over those of `frames` that can be aligned. NaN for markers never seen.
std::vector<Eigen::Vector3d> MedianPositions(const StageTracks& tracks, FrameAligner& aligner,
                                             std::span<const int> frames);

}  // namespace articap
