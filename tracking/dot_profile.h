// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace articap {

// Eight pixels at a time. The compiler turns arithmetic of these into what vector instructions the
// function around it may use, or two or eight of what there is; the results are the same to the
// bit.
using Lanes = float __attribute__((vector_size(32)));
inline constexpr int kLanes = 8;
// Conversions between vectors of one size keep the bits.
using LaneBits = std::int32_t __attribute__((vector_size(32)));

// How an evenly coloured ellipse appears under blur: a part of 1 of its colour at each place.
//
// With L the matrix that maps the ellipse to the unit circle, u = L (p - centre), f = |u|,
// g = L^T u and n = |g| / f, the place lies d = (1 - f) / n inside the edge, measured to the
// tangent at the edge's point in the same direction from the centre; that point lies w beside the
// foot of p, and the edge has the curvature k = det(L)^2 / n^3 there. With t = (d - k w^2 / 2) / s,
// s the SD of the blur with the pixels' squares in it, and e = s k, the blurred edge is the normal
// distribution's Phi(z),
//   z = t - e/2 - e^2 t/4 - 0.378 e^3 t^2 - 0.705 e^5 t^4,   the last two for t > 0 alone.
// The first terms are the expansion of the Gaussian-blurred disc in e (its radial integral with the
// Bessel function's asymptote); the last two are fitted to that integral. The sum is within 0.0006
// of it for e up to 0.2, 0.0022 for 0.3 and 0.0056 for 0.5: a disc of 4 px under a blur of 1 px.
struct DotEllipse {
  Eigen::Vector2f center_px = Eigen::Vector2f::Zero();
  // The rows of L, [xx xy; 0 yy], 1/px.
  float xx = 1;
  float xy = 0;
  float yy = 1;
  float blur_px = 1;  // s
};

}  // namespace articap
