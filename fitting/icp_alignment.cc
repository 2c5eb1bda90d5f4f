// SPDX-License-Identifier: MIT
#include "fitting/icp_alignment.h"

#include <fmt/format.h>

#ifdef ARTICAP_WITH_PCL

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/alignment.h"
#include "core/check.h"
#include "core/statistics.h"
#include "fitting/face_surface.h"

namespace articap {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr double kDegree = std::numbers::pi / 180;
// Turns about each axis that surround a start: neighbours are near enough for ICP to close the gap,
// and the outermost reach 35 degrees.
constexpr double kTurns_deg[] = {-25, 0, 25};
// Markers may cover the lower face alone or reach the forehead: the cloud's centre is tried at
// these heights about the middle of the face, mm.
constexpr double kLifts_mm[] = {-25, 0, 25};
constexpr double kSampleSpacing_mm = 3;
constexpr int kIcpIterations = 30;
// Pairs farther apart than this are left out by ICP: markers on spectacles or a headband.
constexpr double kIcpReach_mm = 40;
// So many landings, by their trimmed residual after ICP, are worth refining, of those that differ
// by more than this from all better ones.
constexpr std::size_t kRefinedLandings = 24;
constexpr double kSameTurn = 5 * kDegree, kSamePlace_mm = 5;
// Of the points, by their distance to the skin, that a start is judged by.
constexpr double kTrimmedPart = 0.8;
constexpr double kOtherOrientation = 20 * kDegree;
// A face with its markers spans some 100 to 200 mm; RMS distance from their centre.
constexpr double kLeastRadius_mm = 15, kLargestRadius_mm = 200;

PclCloud::Ptr ToPcl(std::span<const Eigen::Vector3d> points) {
  auto cloud = pcl::make_shared<PclCloud>();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3f p = point.cast<float>();
    cloud->push_back({p.x(), p.y(), p.z()});
  }
  return cloud;
}

// Where the middle of a face's markers lies: the middle of the landmarks that carry markers, or of
// the skin for rigs that name few.
Eigen::Vector3d MiddleOfFace(const FaceSurface& surface, std::span<const Eigen::Vector3d> samples) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  if (surface.places().size() >= kLeastCloudPoints) {
    for (const auto& place : surface.places()) middle += place.point_in_rig;
    return middle / static_cast<double>(surface.places().size());
  }
  for (const Eigen::Vector3d& sample : samples) middle += sample;
  return middle / static_cast<double>(samples.size());
}

// Rigid ICP of one cloud against one surface from any start.
class IcpSearch {
 public:
  IcpSearch(std::span<const Eigen::Vector3d> cloud_mm, std::span<const Eigen::Vector3d> samples)
      : cloud_(ToPcl(cloud_mm)), samples_(ToPcl(samples)) {
    tree_->setInputCloud(samples_);
    icp_.setSearchMethodTarget(tree_, /*force_no_recompute=*/true);
    icp_.setInputSource(cloud_);
    icp_.setInputTarget(samples_);
    icp_.setMaximumIterations(kIcpIterations);
    icp_.setMaxCorrespondenceDistance(kIcpReach_mm);
    icp_.setTransformationEpsilon(1e-6);
  }

  struct Landing {
    Sim3d rig_from_cloud;
    double trimmed_mm = 0;  // RMS distance of the nearest points to the samples
  };
  Landing From(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation_mm) {
    Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
    guess.topLeftCorner<3, 3>() = rotation.toRotationMatrix().cast<float>();
    guess.topRightCorner<3, 1>() = translation_mm.cast<float>();
    PclCloud moved;
    icp_.align(moved, guess);
    const Eigen::Matrix4d result = icp_.getFinalTransformation().cast<double>();
    const Eigen::Matrix3d turned = result.topLeftCorner<3, 3>();
    return {{1, Eigen::Quaterniond(turned).normalized(), result.topRightCorner<3, 1>()},
            TrimmedDistance(moved)};
  }

 private:
  double TrimmedDistance(const PclCloud& moved) const {
    std::vector<float> squared;
    pcl::Indices index(1);
    std::vector<float> nearest(1);
    for (const pcl::PointXYZ& point : moved) {
      tree_->nearestKSearch(point, 1, index, nearest);
      squared.push_back(nearest[0]);
    }
    const auto kept =
        static_cast<std::ptrdiff_t>(std::ceil(kTrimmedPart * static_cast<double>(squared.size())));
    std::partial_sort(squared.begin(), squared.begin() + kept, squared.end());
    double sum = 0;
    for (std::ptrdiff_t i = 0; i < kept; ++i) sum += squared[static_cast<std::size_t>(i)];
    return std::sqrt(sum / static_cast<double>(kept));
  }

  PclCloud::Ptr cloud_, samples_;
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree_ =
      pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp_;
};

std::vector<Eigen::Quaterniond> TurnsAround(const std::vector<Eigen::Quaterniond>& starts) {
  std::vector<Eigen::Quaterniond> turns;
  for (const Eigen::Quaterniond& start : starts)
    for (const double pitch : kTurns_deg)
      for (const double yaw : kTurns_deg)
        for (const double roll : kTurns_deg)
          turns.push_back(Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitY()) *
                          Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitX()) *
                          Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitZ()) * start);
  return turns;
}

Result<void> CheckCloud(std::span<const Eigen::Vector3d> cloud_mm, const PointSpread& spread) {
  for (const Eigen::Vector3d& point : cloud_mm) ARTICAP_CHECK(point.allFinite());
  if (cloud_mm.size() < static_cast<std::size_t>(kLeastCloudPoints))
    return Fail(fmt::format("{} markers are too few to tell a face by; at least {} are needed",
                            cloud_mm.size(), kLeastCloudPoints));
  const double radius_mm = std::sqrt(spread.scatter.sum() / spread.total_weight);
  if (radius_mm < kLeastRadius_mm || radius_mm > kLargestRadius_mm)
    return Fail(fmt::format(
        "the markers lie {:.3g} mm (RMS) around their centre, those of a face {} to {} mm; check "
        "the unit of length, and that the markers are those of one face",
        radius_mm, kLeastRadius_mm, kLargestRadius_mm));
  return {};
}

std::vector<IcpSearch::Landing> LandFromAllStarts(std::span<const Eigen::Vector3d> cloud_mm,
                                                  const Eigen::Vector3d& cloud_center,
                                                  const FaceSurface& surface,
                                                  const IcpOptions& options) {
  const std::vector<Eigen::Vector3d> samples = surface.Sample(kSampleSpacing_mm);
  const Eigen::Vector3d middle = MiddleOfFace(surface, samples);
  IcpSearch search(cloud_mm, samples);
  std::vector<IcpSearch::Landing> landings;
  for (const Eigen::Quaterniond& turn : TurnsAround(options.starts))
    for (const double lift_mm : kLifts_mm)
      landings.push_back(
          search.From(turn, middle + lift_mm * Eigen::Vector3d::UnitY() - turn * cloud_center));
  std::ranges::stable_sort(landings, {}, &IcpSearch::Landing::trimmed_mm);
  return landings;
}

// The best landings, each pose once; `landings` are sorted.
std::vector<Sim3d> DistinctLandings(const std::vector<IcpSearch::Landing>& landings,
                                    const Eigen::Vector3d& cloud_center) {
  std::vector<Sim3d> distinct;
  for (const IcpSearch::Landing& landing : landings) {
    const Sim3d& pose = landing.rig_from_cloud;
    const bool is_new = std::ranges::none_of(distinct, [&](const Sim3d& other) {
      return pose.rotation.angularDistance(other.rotation) < kSameTurn &&
             (pose * cloud_center - other * cloud_center).norm() < kSamePlace_mm;
    });
    if (is_new) distinct.push_back(pose);
    if (distinct.size() == kRefinedLandings) break;
  }
  return distinct;
}

IcpAlignment BestOf(const std::vector<CloudFit>& fits) {
  const CloudFit& best = *std::ranges::min_element(fits, {}, &CloudFit::cost);
  IcpAlignment alignment;
  alignment.rig_from_cloud = best.rig_from_cloud;
  alignment.cost = best.cost;
  alignment.runner_up_cost = std::numeric_limits<double>::infinity();
  for (const CloudFit& fit : fits)
    if (fit.rig_from_cloud.rotation.angularDistance(best.rig_from_cloud.rotation) >
        kOtherOrientation)
      alignment.runner_up_cost = std::min(alignment.runner_up_cost, fit.cost);
  return alignment;
}

}  // namespace

Result<IcpAlignment> AlignCloudToRig(std::span<const Eigen::Vector3d> cloud_mm, const FaceRig& rig,
                                     const IcpOptions& options) {
  ARTICAP_CHECK(!options.starts.empty());
  const PointSpread spread = SpreadOf(cloud_mm);
  if (const auto plausible = CheckCloud(cloud_mm, spread); !plausible)
    return tl::unexpected(plausible.error());
  const Result<FaceSurface> surface = FaceSurface::Create(rig);
  if (!surface) return tl::unexpected(surface.error());

  const auto landings = LandFromAllStarts(cloud_mm, spread.centroid, *surface, options);
  std::vector<CloudFit> fits;
  for (const Sim3d& start : DistinctLandings(landings, spread.centroid)) {
    CloudFit fit = RefineCloudAlignment(*surface, cloud_mm, start, options.model,
                                        /*at_landmarks=*/false);
    if (options.use_landmarks)
      fit = RefineCloudAlignment(*surface, cloud_mm, fit.rig_from_cloud, options.model,
                                 /*at_landmarks=*/true);
    fits.push_back(fit);
  }
  IcpAlignment alignment = BestOf(fits);
  alignment.num_starts = static_cast<int>(landings.size());
  for (const Eigen::Vector3d& point : cloud_mm)
    alignment.distances_mm.push_back(
        surface->Nearest(alignment.rig_from_cloud * point).distance_mm);
  alignment.median_distance_mm = MedianOf(alignment.distances_mm);
  return alignment;
}

}  // namespace articap

#else

namespace articap {

Result<IcpAlignment> AlignCloudToRig(std::span<const Eigen::Vector3d>, const FaceRig&,
                                     const IcpOptions&) {
  return Fail(
      "this build of articap has no PCL (ARTICAP_WITH_PCL is off), which lays unnamed markers on a "
      "face; write a marker map by hand, after one of those in maps/");
}

}  // namespace articap

#endif
