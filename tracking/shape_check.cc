// SPDX-License-Identifier: MIT
#include "tracking/shape_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/alignment.h"

namespace articap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

struct Paired {
  std::vector<std::string> names;
  std::vector<std::size_t> index;  // among the references
  Points own_mm;
  Points given_mm;
};

Paired PairUp(const std::vector<std::string>& names, const Points& points_mm,
              const HeadShape& given) {
  Paired paired;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const NamedPoint* point = given.Find(names[i]);
    if (!point || !points_mm[i].allFinite()) continue;
    paired.names.push_back(names[i]);
    paired.index.push_back(i);
    paired.own_mm.push_back(points_mm[i]);
    paired.given_mm.push_back(point->point_in_head_mm);
  }
  return paired;
}

double RigidRms(const Points& source, const Points& target) {
  return AlignmentRms(AlignRigid(source, target), source, target);
}

// The order of the given points that fits best: all orders of up to seven, beyond that exchanges of
// two as long as they help.
std::vector<std::size_t> BestOrder(const Paired& paired) {
  std::vector<std::size_t> order(paired.names.size());
  std::iota(order.begin(), order.end(), 0);
  const auto rms_of = [&](const std::vector<std::size_t>& candidate) {
    Points reordered;
    for (const std::size_t i : candidate) reordered.push_back(paired.given_mm[i]);
    return RigidRms(paired.own_mm, reordered);
  };
  std::vector<std::size_t> best = order;
  double best_rms_mm = rms_of(order);
  constexpr std::size_t kMaxForAllOrders = 7;
  if (order.size() <= kMaxForAllOrders) {
    while (std::ranges::next_permutation(order).found)
      if (const double rms_mm = rms_of(order); rms_mm < best_rms_mm) {
        best = order;
        best_rms_mm = rms_mm;
      }
    return best;
  }
  for (bool improved = true; improved;) {
    improved = false;
    const std::vector<std::size_t> start = best;
    for (std::size_t a = 0; a < start.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        std::vector<std::size_t> candidate = start;
        std::swap(candidate[a], candidate[b]);
        if (const double rms_mm = rms_of(candidate); rms_mm < best_rms_mm) {
          best = candidate;
          best_rms_mm = rms_mm;
          improved = true;
        }
      }
  }
  return best;
}

// An error where another assignment of the names fits and the given one does not.
Result<void> CheckNames(const Paired& paired, double rms_mm, double tolerance_mm) {
  const std::vector<std::size_t> order = BestOrder(paired);
  Points reordered;
  std::vector<std::string> exchanged;
  for (std::size_t i = 0; i < order.size(); ++i) {
    reordered.push_back(paired.given_mm[order[i]]);
    if (order[i] != i)
      exchanged.push_back(
          fmt::format("'{}' is where '{}' should be", paired.names[i], paired.names[order[i]]));
  }
  const double reordered_rms_mm = RigidRms(paired.own_mm, reordered);
  // Three points can be put in an order that fits by chance.
  if (exchanged.empty() || paired.names.size() < 4 || reordered_rms_mm > tolerance_mm ||
      reordered_rms_mm > 0.5 * rms_mm)
    return {};
  return Fail(fmt::format(
      "the names of reference markers are exchanged: {} (the distances fit the reference shape to "
      "{:.2f} mm so, and to {:.2f} mm as named). Correct the names, e.g. with articap label",
      fmt::join(exchanged, ", "), reordered_rms_mm, rms_mm));
}

Result<void> CheckHandednessAndSize(const Paired& paired, double rms_mm, double tolerance_mm) {
  const ReflectionTest test = DetectReflection(paired.own_mm, paired.given_mm);
  if (test.is_reflected && test.rms_reflected < tolerance_mm)
    return Fail(fmt::format(
        "the references fit the mirror image of the reference shape ({:.2f} mm) and not the shape "
        "({:.2f} mm): the data are mirrored or left-handed; use --mirror",
        test.rms_reflected, rms_mm));
  // Whatever the order of the names.
  const double size_ratio =
      std::sqrt(SpreadOf(paired.given_mm).scatter.sum() / SpreadOf(paired.own_mm).scatter.sum());
  if (!(size_ratio < 2 && size_ratio > 0.5))
    return Fail(fmt::format(
        "the reference shape is {:.3g} times as large as the references of this take: another unit "
        "of length, or another subject's shape",
        size_ratio));
  return {};
}

// The largest subset of references that fits, found by leaving out the worst one by one; by
// distances to the others, which do not depend on an alignment. Returns who is left out.
std::vector<std::size_t> Misplaced(const Paired& paired, double tolerance_mm) {
  std::vector<std::size_t> kept(paired.names.size()), left_out;
  std::iota(kept.begin(), kept.end(), 0);
  while (kept.size() > 3) {
    Points own, given;
    for (const std::size_t i : kept) {
      own.push_back(paired.own_mm[i]);
      given.push_back(paired.given_mm[i]);
    }
    if (RigidRms(own, given) <= tolerance_mm / 2) break;
    double best_rms_mm = std::numeric_limits<double>::infinity();
    std::size_t worst = 0;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      Points own_without = own, given_without = given;
      own_without.erase(own_without.begin() + static_cast<std::ptrdiff_t>(k));
      given_without.erase(given_without.begin() + static_cast<std::ptrdiff_t>(k));
      const double rms_mm = RigidRms(own_without, given_without);
      if (rms_mm >= best_rms_mm) continue;
      best_rms_mm = rms_mm;
      worst = k;
    }
    left_out.push_back(kept[worst]);
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(worst));
  }
  return left_out;
}

// Distance of every reference from its place when the shape is aligned by those in place.
std::vector<double> Deviations(const Paired& paired, const std::vector<std::size_t>& left_out,
                               std::size_t num_references) {
  std::vector<double> weights(paired.names.size(), 1.0);
  for (const std::size_t i : left_out) weights[i] = 0;
  const Rigid3d given_from_own = AlignRigid(paired.own_mm, paired.given_mm, weights);
  std::vector<double> deviation_mm(num_references, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < paired.names.size(); ++i)
    deviation_mm[paired.index[i]] = (given_from_own * paired.own_mm[i] - paired.given_mm[i]).norm();
  return deviation_mm;
}

std::vector<std::string> NamesOf(const Paired& paired, const std::vector<std::size_t>& members) {
  std::vector<std::string> names;
  for (const std::size_t i : members) names.push_back(paired.names[i]);
  return names;
}

// The error where the references left out keep a shape of their own, or are half of all or more.
Result<void> CheckMajority(const Paired& paired, const std::vector<std::size_t>& left_out,
                           double rms_mm, double tolerance_mm) {
  std::vector<std::size_t> kept;
  Points own, given;
  for (std::size_t i = 0; i < paired.names.size(); ++i) {
    if (std::ranges::find(left_out, i) == left_out.end()) {
      kept.push_back(i);
    } else {
      own.push_back(paired.own_mm[i]);
      given.push_back(paired.given_mm[i]);
    }
  }
  if (left_out.size() >= 3 && RigidRms(own, given) <= tolerance_mm)
    return Fail(fmt::format(
        "the references fall into two groups, each of which keeps its shape, that have moved "
        "against one another since the reference shape was made: {} and {}. Were the spectacles "
        "seated anew? Take the references from one group, and bind this take anew",
        fmt::join(NamesOf(paired, kept), ", "), fmt::join(NamesOf(paired, left_out), ", ")));
  if (left_out.size() > 1 && 2 * left_out.size() + 1 >= paired.names.size())
    return Fail(fmt::format(
        "the references do not fit the reference shape: {:.1f} mm RMS, and most of them disagree "
        "({}). It is another subject's shape, or the markers were placed anew: estimate a new "
        "shape",
        rms_mm, fmt::join(NamesOf(paired, left_out), ", ")));
  return {};
}

}  // namespace

Result<ShapeComparison> CompareWithShape(const std::vector<std::string>& names,
                                         const std::vector<Eigen::Vector3d>& points_mm,
                                         const HeadShape& given, double tolerance_mm) {
  const Paired paired = PairUp(names, points_mm, given);
  if (paired.names.size() < 3)
    return Fail(
        fmt::format("only {} of the references ({}) are both in this take and in the reference "
                    "shape; three are "
                    "needed. Name references that the shape has, or give another shape",
                    paired.names.size(), fmt::join(names, ", ")));
  const double rms_mm = RigidRms(paired.own_mm, paired.given_mm);
  std::vector<std::size_t> left_out;
  if (rms_mm > tolerance_mm / 2) {
    if (auto fits = CheckHandednessAndSize(paired, rms_mm, tolerance_mm); !fits)
      return tl::unexpected(fits.error());
    left_out = Misplaced(paired, tolerance_mm);
    // One marker off its place explains itself; more might be names.
    if (left_out.size() > 1)
      if (auto named = CheckNames(paired, rms_mm, tolerance_mm); !named)
        return tl::unexpected(named.error());
  }
  if (auto majority = CheckMajority(paired, left_out, rms_mm, tolerance_mm); !majority)
    return tl::unexpected(majority.error());
  ShapeComparison comparison{Deviations(paired, left_out, names.size()), {}, {}};
  for (const std::size_t i : left_out) {
    const double off_mm = comparison.deviation_mm[paired.index[i]];
    if (off_mm <= tolerance_mm) continue;
    comparison.misplaced.push_back(static_cast<int>(paired.index[i]));
    comparison.warnings.push_back(fmt::format(
        "'{}' lies {:.1f} mm from its place in the reference shape, found by its distances from "
        "the other references: it was glued on anew or bent since, and is left out",
        paired.names[i], off_mm));
  }
  if (comparison.misplaced.empty() && rms_mm > tolerance_mm / 2)
    comparison.warnings.push_back(
        fmt::format("the references fit the reference shape to {:.2f} mm RMS only", rms_mm));
  return comparison;
}

}  // namespace articap
