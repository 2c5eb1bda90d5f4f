// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace articap {

// How an evenly coloured ellipse appears under blur: a part of 1 of its colour at each place.
//
// With L the matrix that maps the ellipse to the unit circle, u = L (p - centre), f = |u| and
// n = |L^T u| / f, the place lies d = (1 - f) / n inside the edge, measured to the tangent at the
// edge's point in the same direction from the centre; that point lies w beside the foot of p, and
// the edge has the curvature k = det(L)^2 / n^3 there. With t = (d - k w^2 / 2) / s, s the SD of
// the blur with the pixels' squares in it, and e = s k, the blurred edge is the normal
// distribution's Phi(z),
//   z = t - e/2 - e^2 t/4 - 0.378 e^3 t^2 - 0.705 e^5 t^4,   the last two for t > 0 alone.
// The first terms are the expansion of the Gaussian-blurred disc in e (its radial integral with the
// Bessel function's asymptote); the last two are fitted to that integral. The sum is within 0.0006
// of it for e up to 0.2, 0.0022 for 0.3 and 0.0056 for 0.5: a disc of 4 px under a blur of 1 px.
//
// Eight pixels at a time, which Eigen turns into the vector instructions of every processor that
// articap runs on: the same pixels give the same bits everywhere.
using Lanes = Eigen::Array<float, 8, 1>;

struct DotEllipse {
  Eigen::Vector2f center_px = Eigen::Vector2f::Zero();
  // The rows of L, [xx xy; 0 yy], 1/px.
  float xx = 1;
  float xy = 0;
  float yy = 1;
  float blur_px = 1;  // s
};

struct DotProfile {
  Lanes inside;  // Phi(z)
  // Derivatives by centre x, y, xx, xy, yy and blur; those of the curvature k, which hardly
  // changes, are left out.
  Lanes by[6];
};

// At the pixels (x, y).
inline void ProfileAt(const DotEllipse& dot, const Lanes& x, const Lanes& y, DotProfile& profile) {
  const Lanes dx = x - dot.center_px.x(), dy = y - dot.center_px.y();
  const Lanes ux = dot.xx * dx + dot.xy * dy;
  const Lanes uy = dot.yy * dy;
  // In the very middle directions are undefined, and without consequence.
  constexpr float kMiddle2 = 1e-6f;
  const Lanes f2 = (ux * ux + uy * uy).max(kMiddle2);
  const Lanes f = f2.sqrt();
  const Lanes gx = dot.xx * ux, gy = dot.xy * ux + dot.yy * uy;
  const Lanes inverse_g = 1 / (gx * gx + gy * gy).max(kMiddle2 * dot.yy * dot.yy).sqrt();
  const Lanes inverse_n = f * inverse_g;  // 1 / n
  const Lanes out = 1 - f;
  const float inverse_s = 1 / dot.blur_px;
  const float det = dot.xx * dot.yy;
  const Lanes curvature = det * det * inverse_n * inverse_n * inverse_n;
  const Lanes beside2 = out * out * ((dx * dx + dy * dy) / f2 - inverse_n * inverse_n);
  const Lanes t = inverse_s * (out * inverse_n - 0.5f * curvature * beside2);
  const Lanes e = (dot.blur_px * curvature).min(0.5f);
  // 1 in the middle of a circle; ellipses have more below their tips.
  const Lanes deep = (e * t.max(0.0f)).min(1.0f);
  const Lanes deep2 = deep * deep;
  const Lanes z =
      (t - e * (0.5f + 0.25f * e * t + deep2 * (0.378f + 0.705f * deep2))).max(-6.0f).min(6.0f);
  // Abramowitz and Stegun, Handbook of Mathematical Functions, 26.2.17: to 7.5e-8.
  const Lanes density = 0.39894228f * (-0.5f * z * z).exp();
  const Lanes k = 1 / (1 + 0.2316419f * z.abs());
  const Lanes tail =
      density * k *
      (0.319381530f +
       k * (-0.356563782f + k * (1.781477937f + k * (-1.821255978f + k * 1.330274429f))));
  const Lanes sign = (1e30f * z).max(-1.0f).min(1.0f);
  profile.inside = 0.5f + sign * (0.5f - tail);
  const Lanes z_by_t = 1 - e * e * (0.25f + deep * (0.756f + 2.82f * deep2));
  const Lanes slope = density * inverse_s * z_by_t;  // by the distance d
  // d = (1 - f) f / |g| with g = L^T u: its derivatives come from those of f and g.
  const Lanes of_f = slope * (1 - 2 * f) * inverse_g / f;                  // f df
  const Lanes of_g = slope * out * f * inverse_g * inverse_g * inverse_g;  // g . dg
  profile.by[0] = of_g * (dot.xx * dot.xx * gx + dot.xx * dot.xy * gy) - of_f * gx;
  profile.by[1] =
      of_g * (dot.xx * dot.xy * gx + (dot.xy * dot.xy + dot.yy * dot.yy) * gy) - of_f * gy;
  profile.by[2] = of_f * ux * dx - of_g * (gx * (ux + dot.xx * dx) + gy * dot.xy * dx);
  profile.by[3] = of_f * ux * dy - of_g * (gx * dot.xx * dy + gy * (ux + dot.xy * dy));
  profile.by[4] = of_f * uy * dy - of_g * gy * 2 * dot.yy * dy;
  const Lanes z_by_e_times_e = -e * (0.5f + 0.5f * e * t + deep2 * (1.134f + 3.525f * deep2));
  profile.by[5] = density * inverse_s * (z_by_e_times_e - t * z_by_t);
}

}  // namespace articap
