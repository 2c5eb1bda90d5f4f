// SPDX-License-Identifier: MIT
#include "tests/tracking/gap_cuts.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace articap {
namespace {

constexpr int kApart = 12;  // frames between gaps, at least

// Frames beside a gap at -(n - 1) ... 0 and length + 1 ... length + n: what a cubic spline through
// them (second derivatives zero at its ends) makes of them in the gap.
Eigen::MatrixXd SplineWeights(int length, int n) {
  const int size = 2 * n;
  Eigen::VectorXd knots(size);
  for (int i = 0; i < n; ++i) {
    knots[i] = i - n + 1;
    knots[n + i] = length + 1 + i;
  }
  Eigen::MatrixXd of_bends = Eigen::MatrixXd::Identity(size, size);
  Eigen::MatrixXd of_values = Eigen::MatrixXd::Zero(size, size);
  for (int i = 1; i + 1 < size; ++i) {
    const double before = knots[i] - knots[i - 1];
    const double after = knots[i + 1] - knots[i];
    of_bends.row(i).segment<3>(i - 1) << before / 6, (before + after) / 3, after / 6;
    of_values.row(i).segment<3>(i - 1) << 1 / before, -1 / before - 1 / after, 1 / after;
  }
  const Eigen::MatrixXd bends = of_bends.partialPivLu().solve(of_values);
  Eigen::MatrixXd weights(length, size);
  const double steps = length + 1;
  for (int k = 0; k < length; ++k) {
    const double u = (k + 1) / steps;
    const double v = 1 - u;
    weights.row(k) =
        steps * steps / 6 * ((v * v * v - v) * bends.row(n - 1) + (u * u * u - u) * bends.row(n));
    weights(k, n - 1) += v;
    weights(k, n) += u;
  }
  return weights;
}

// Of frames first - n ... first - 1 and end ... end + n - 1, a row each.
Eigen::MatrixXd Beside(const StageTracks& tracks, const Gap& gap, int n) {
  Eigen::MatrixXd beside(2 * n, 3);
  for (int i = 0; i < n; ++i) {
    beside.row(i) = tracks.position_mm(gap.first - n + i, gap.marker);
    beside.row(n + i) = tracks.position_mm(gap.first + gap.length + i, gap.marker);
  }
  return beside;
}

Eigen::RowVector3d Hermite(const Eigen::MatrixXd& beside, double u, double steps) {
  const double u2 = u * u;
  const double u3 = u2 * u;
  return (1 - 3 * u2 + 2 * u3) * beside.row(1) + (3 * u2 - 2 * u3) * beside.row(2) +
         steps * ((u3 - 2 * u2 + u) * (beside.row(1) - beside.row(0)) +
                  (u3 - u2) * (beside.row(3) - beside.row(2)));
}

}  // namespace

CutTake CutGaps(const StageTracks& whole, const std::vector<int>& markers, int length, int together,
                std::mt19937& random) {
  CutTake cut{whole, {}};
  const auto draw = [&](int count) { return static_cast<int>(random() % count); };
  for (int first = kApart + draw(20); first + length + kApart < whole.num_frames();
       first += length + kApart + draw(20)) {
    std::vector<int> left = markers;
    for (int i = 0; i < together; ++i) {
      const int drawn = draw(static_cast<int>(left.size()));
      cut.gaps.push_back({left[drawn], first, length});
      left.erase(left.begin() + drawn);
    }
  }
  for (const Gap& gap : cut.gaps)
    for (int k = 0; k < length; ++k) cut.tracks.SetMissing(gap.first + k, gap.marker);
  return cut;
}

void GapErrors::Add(const StageTracks& whole, const std::vector<Gap>& cut,
                    const StageTracks& filled) {
  constexpr int kSplineFrames = 8;
  for (const Gap& gap : cut) {
    ++gaps;
    double over_variance_of_gap = 0;
    const Eigen::MatrixXd spline_mm =
        SplineWeights(gap.length, kSplineFrames) * Beside(whole, gap, kSplineFrames);
    const Eigen::MatrixXd beside_mm = Beside(whole, gap, 2);
    for (int k = 0; k < gap.length; ++k) {
      const int frame = gap.first + k;
      if (filled.is_missing(frame, gap.marker)) {
        ++left;
        continue;
      }
      ++samples;
      const double steps = gap.length + 1;
      const double u = (k + 1) / steps;
      const Eigen::RowVector3d truth_mm = whole.position_mm(frame, gap.marker);
      linear_mm2 += ((1 - u) * beside_mm.row(1) + u * beside_mm.row(2) - truth_mm).squaredNorm();
      cubic_mm2 += (Hermite(beside_mm, u, steps) - truth_mm).squaredNorm();
      spline_mm2 += (spline_mm.row(k) - truth_mm).squaredNorm();
      const double error_mm2 =
          (filled.position_mm(frame, gap.marker).transpose() - truth_mm).squaredNorm();
      filled_mm2 += error_mm2;
      over_variance_of_gap += error_mm2 / 3 / std::pow(filled.sigma_mm(frame, gap.marker), 2);
    }
    over_variance += over_variance_of_gap;
    far_off += over_variance_of_gap > 9 * gap.length;
  }
}

double GapErrors::Rms(double sum_mm2) const { return std::sqrt(sum_mm2 / std::max(1, samples)); }

double GapErrors::NormalisedRms() const { return Rms(over_variance); }

}  // namespace articap
