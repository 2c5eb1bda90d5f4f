// SPDX-License-Identifier: MIT
#include "tracking/learn_template.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/alignment.h"
#include "core/landmarks.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "tracking/pose_search.h"

namespace articap {
namespace {

// Speakers differ from the typical face, and markers sit beside their landmarks.
constexpr double kLayoutSigma_mm = 8;
// What is assumed of a marker before a take has shown how it moves.
constexpr double kRigidSigma_mm = 1;
constexpr double kFaceSigma_mm = 5;
// Samples of a marker that tell its place.
constexpr std::size_t kFewest = 20;

struct ReferenceFit {
  FoundHead head;
  int frame = -1;
  std::vector<MarkerPlace> places;  // of the layout, bent and in the stage's axes
};

std::vector<MarkerPlace> PlacesOf(const MarkerTemplate& layout, const Eigen::Matrix3d& change) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const TemplateMarker& marker : layout.markers) middle += marker.position_mm;
  middle /= static_cast<double>(layout.markers.size());
  std::vector<MarkerPlace> places;
  for (const TemplateMarker& marker : layout.markers)
    places.push_back({change * (marker.position_mm - middle),
                      marker.sigma_mm * marker.sigma_mm * Eigen::Matrix3d::Identity()});
  return places;
}

LabelPriors PriorsOf(const LabelOptions& options) {
  constexpr double kSeenByOneView = 0.3;
  return {{options.seen, kSeenByOneView}, options.false_points, options.false_points};
}

// Bends the layout by the affine map that takes it nearest to what it found, as far as many markers
// say so: heads are broad or long.
void Bend(const std::vector<CloudPoint>& cloud, const FoundHead& head,
          std::vector<MarkerPlace>& places) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> side = Eigen::Matrix<double, 4, 3>::Zero();
  constexpr double kRidge = 2;  // markers' worth, at an arm of 50 mm
  normal.diagonal() << kRidge * 2500, kRidge * 2500, kRidge * 2500, 0.01;
  for (std::size_t m = 0; m < places.size(); ++m) {
    if (head.points[m] < 0 || cloud[head.points[m]].sights.size() == 1) continue;
    const Eigen::Vector4d source = places[m].position_mm.homogeneous();
    const Eigen::Vector3d change =
        head.template_from_stage * cloud[head.points[m]].position_in_stage_mm -
        places[m].position_mm;
    normal += source * source.transpose();
    side += source * change.transpose();
  }
  const Eigen::Matrix<double, 4, 3> map = normal.ldlt().solve(side);
  for (MarkerPlace& place : places)
    place.position_mm += map.transpose() * place.position_mm.homogeneous();
}

int CountFound(const FoundHead& head) {
  return static_cast<int>(
      std::count_if(head.points.begin(), head.points.end(), [](int point) { return point >= 0; }));
}

// Those of which more than a ray is known.
int CountPlaced(const std::vector<CloudPoint>& cloud, const FoundHead& head) {
  return static_cast<int>(std::count_if(head.points.begin(), head.points.end(), [&](int point) {
    return point >= 0 && cloud[point].sights.size() != 1;
  }));
}

// Bends the layout onto what it found and looks again, each time knowing better what to expect.
std::optional<ReferenceFit> Improve(const std::vector<CloudPoint>& cloud, ReferenceFit fit,
                                    const LabelOptions& options) {
  constexpr int kRounds = 2;
  constexpr double kSharper = 0.5;  // of the variance
  for (int round = 0; round < kRounds; ++round) {
    Bend(cloud, fit.head, fit.places);
    for (MarkerPlace& place : fit.places) place.covariance_mm2 *= kSharper;
    auto found = FindHead(fit.places, cloud, PriorsOf(options), options);
    if (!found) return std::nullopt;
    fit.head = std::move(*found);
  }
  return fit;
}

// The layout in all sizes and attitudes, in one frame: the ways that look best are improved, and
// the best of these is right.
std::optional<ReferenceFit> SearchFrame(const PointClouds& clouds, const MarkerTemplate& layout,
                                        int frame, std::span<const Eigen::Quaterniond> attitudes,
                                        const LabelOptions& options) {
  constexpr std::array kSizes = {1.0, 0.88, 1.14};
  constexpr std::size_t kImproved = 4;
  const auto& cloud = clouds.frames[frame];
  std::vector<ReferenceFit> fits(attitudes.size() * kSizes.size());
  ParallelFor(static_cast<int>(fits.size()), 0, [&](int way) {
    const auto& layout_from_stage = attitudes[way / kSizes.size()];
    ReferenceFit& fit = fits[way];
    fit.places = PlacesOf(
        layout, kSizes[way % kSizes.size()] * layout_from_stage.conjugate().toRotationMatrix());
    if (auto found = FindHead(fit.places, cloud, PriorsOf(options), options)) {
      fit.head = std::move(*found);
      fit.frame = frame;
    }
  });
  std::erase_if(fits, [](const ReferenceFit& fit) { return fit.frame < 0; });
  const auto is_better = [](const ReferenceFit& a, const ReferenceFit& b) {
    return a.head.cost < b.head.cost;
  };
  std::stable_sort(fits.begin(), fits.end(), is_better);
  std::optional<ReferenceFit> best;
  for (std::size_t i = 0; i < std::min(kImproved, fits.size()); ++i) {
    auto improved = Improve(cloud, std::move(fits[i]), options);
    if (improved && (!best || is_better(*improved, *best))) best = std::move(improved);
  }
  return best;
}

// Of the frame that shows most markers; none is tried after one that shows nearly all markers.
std::optional<ReferenceFit> SearchReference(const PointClouds& clouds, const MarkerTemplate& layout,
                                            std::span<const int> frames,
                                            std::span<const Eigen::Quaterniond> attitudes,
                                            const LabelOptions& options) {
  constexpr double kNear_deg = 20;  // of one of the attitudes
  constexpr double kNearlyAll = 0.9;
  LabelOptions near = options;
  near.attitude_sigma_deg = std::min(near.attitude_sigma_deg, kNear_deg);
  std::optional<ReferenceFit> best;
  int most_placed = 0;
  for (const int frame : frames) {
    auto fit = SearchFrame(clouds, layout, frame, attitudes, near);
    if (!fit) continue;
    const int placed = CountPlaced(clouds.frames[frame], fit->head);
    if (!best || placed > most_placed ||
        (placed == most_placed && fit->head.cost < best->head.cost)) {
      best = std::move(fit);
      most_placed = placed;
    }
    if (most_placed >= kNearlyAll * static_cast<double>(layout.markers.size())) break;
  }
  return best;
}

// The direction of which least is known, with its SD.
Eigen::Vector3d LongestAxisOf_mm(const MarkerPlace& place) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(place.covariance_mm2);
  return std::sqrt(axes.eigenvalues().z()) * axes.eigenvectors().col(2);
}

// The places that the frame itself shows; of markers that it does not, those of the bent layout.
MarkerTemplate TemplateOf(const PointClouds& clouds, const MarkerTemplate& layout,
                          const ReferenceFit& fit) {
  MarkerTemplate result = layout;
  result.learnt_from = fmt::format("frame {}", clouds.first_frame + fit.frame);
  const auto& cloud = clouds.frames[fit.frame];
  for (std::size_t m = 0; m < result.markers.size(); ++m) {
    TemplateMarker& marker = result.markers[m];
    marker.position_mm = fit.places[m].position_mm;
    const int point = fit.head.points[m];
    if (point < 0) continue;
    const MarkerPlace place = PlaceOf(fit.places[m], cloud[point], fit.head.template_from_stage);
    marker.position_mm = place.position_mm;
    marker.sigma_mm = marker.head_reference ? kRigidSigma_mm : kFaceSigma_mm;
    if (cloud[point].sights.size() == 1) marker.unmeasured_mm = LongestAxisOf_mm(place);
  }
  return result;
}

Result<void> RefuseDoubtful(const std::optional<ReferenceFit>& fit, const MarkerTemplate& layout) {
  constexpr double kClearly = 6;  // twice the difference of log-likelihood
  const std::string names = fmt::format("{} markers of the layout", layout.markers.size());
  if (!fit)
    return Fail(fmt::format(
        "the {} are found in none of the frames tried: the layout is another set's, too few "
        "markers are seen there, or the head is turned far; give a frame in which the speaker sits "
        "still and all markers are seen",
        names));
  if (fit->head.next_cost < fit->head.cost + kClearly)
    return Fail(fmt::format(
        "{} of the {} are found, but in another pose of the head nearly as well: say where they "
        "are more exactly (a layout with measured positions)",
        CountFound(fit->head), names));
  return {};
}

// The SD of a normal distribution in whose middle nine tenths of the values lie: speech has long
// tails, for lips are at rest most of the time.
double SpreadOf_mm(std::vector<double> values, double middle) {
  for (double& value : values) value = std::abs(value - middle);
  constexpr double kPart = 0.9, kNormal = 1.6449;
  return QuantileOf(std::move(values), kPart) / kNormal;
}

// In the template, where so many views or more saw the marker; points of a file count as seen by
// all.
std::vector<Eigen::Vector3d> FoundPlaces(const PointClouds& clouds, const Labelling& labelling,
                                         int marker, std::size_t least_views) {
  std::vector<Eigen::Vector3d> places;
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    const CloudPoint* const point = LabelledPoint(clouds, labelling, frame, marker);
    if (point && (point->sights.empty() || point->sights.size() >= least_views))
      places.push_back(labelling.frames[frame].places[marker].position_mm);
  }
  return places;
}

// Of a take that is long enough, the markers that it hardly shows where the reference frame has
// them: what was found there was something else.
std::vector<int> LostMarkers(const PointClouds& clouds, const Labelling& labelling) {
  std::vector<int> lost;
  if (static_cast<std::size_t>(clouds.num_frames()) < 2 * kFewest) return lost;
  const auto num_markers = static_cast<int>(labelling.frames.front().points.size());
  for (int marker = 0; marker < num_markers; ++marker)
    if (FoundPlaces(clouds, labelling, marker, 1).size() < kFewest) lost.push_back(marker);
  return lost;
}

MarkerTemplate WithLayoutPlaces(MarkerTemplate marker_template, const ReferenceFit& fit,
                                const std::vector<int>& markers) {
  for (const int m : markers) {
    TemplateMarker& marker = marker_template.markers[m];
    marker.position_mm = fit.places[m].position_mm;
    marker.sigma_mm = kLayoutSigma_mm;
    marker.unmeasured_mm.setZero();
  }
  return marker_template;
}

}  // namespace

Result<MarkerTemplate> LayoutOf(const MarkerSet& set) {
  MarkerTemplate layout;
  layout.name = set.name;
  layout.learnt_from = "typical places of landmarks";
  for (const MarkerRole& role : set.markers) {
    const LandmarkInfo* landmark = FindLandmark(role.landmark);
    if (!landmark)
      return Fail(fmt::format(
          "marker '{}' of the map sits at no landmark, so that nobody knows where to look for it; "
          "give its landmark in the map, or a layout file with its place",
          role.name));
    layout.markers.push_back(
        {role.name, landmark->typical_mm, kLayoutSigma_mm, role.head_reference});
  }
  return layout;
}

Result<void> RefuseMirrored(const MarkerTemplate& layout, const MarkerSet& set) {
  std::vector<Eigen::Vector3d> places, typical;
  for (const TemplateMarker& marker : layout.markers) {
    const MarkerRole* role = set.Find(marker.name);
    const LandmarkInfo* landmark = role ? FindLandmark(role->landmark) : nullptr;
    if (!landmark) continue;
    places.push_back(marker.position_mm);
    typical.push_back(landmark->typical_mm);
  }
  if (places.size() >= 4 && DetectReflection(places, typical).is_reflected)
    return Fail(
        "the layout is mirrored: its markers lie as on a face whose left and right are exchanged; "
        "name them by the speaker's own left and right");
  return {};
}

std::vector<Eigen::Quaterniond> LikelyAttitudes(const CameraArray& array) {
  std::vector<Eigen::Quaterniond> attitudes = {Eigen::Quaterniond::Identity()};
  // A camera's x is to the right, where a speaker who faces it has the left; its y is down.
  const Eigen::Quaterniond layout_from_cam(
      Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  for (const Camera& camera : array.cameras) {
    const Eigen::Quaterniond attitude = layout_from_cam * camera.cam_from_stage.rotation;
    constexpr double kSame_rad = 0.3;
    const bool is_known =
        std::any_of(attitudes.begin(), attitudes.end(), [&](const Eigen::Quaterniond& other) {
          return attitude.angularDistance(other) < kSame_rad;
        });
    if (!is_known) attitudes.push_back(attitude);
  }
  return attitudes;
}

Result<MarkerTemplate> LearnTemplate(const PointClouds& clouds, const MarkerTemplate& layout,
                                     std::span<const int> frames,
                                     std::span<const Eigen::Quaterniond> attitudes,
                                     const LabelOptions& options) {
  const auto fit = SearchReference(clouds, layout, frames, attitudes, options);
  if (const auto clear = RefuseDoubtful(fit, layout); !clear) return tl::unexpected(clear.error());
  const MarkerTemplate first = TemplateOf(clouds, layout, *fit);
  const Labelling labelling = LabelClouds(clouds, first, options);
  const MarkerTemplate refined = RefineTemplate(first, clouds, labelling);
  const std::vector<int> lost = LostMarkers(clouds, labelling);
  if (lost.empty()) return refined;
  const MarkerTemplate again = WithLayoutPlaces(refined, *fit, lost);
  return RefineTemplate(again, clouds, LabelClouds(clouds, again, options));
}

MarkerTemplate RefineTemplate(const MarkerTemplate& marker_template, const PointClouds& clouds,
                              const Labelling& labelling) {
  // A take of a few sentences does not show all that a face can do.
  constexpr double kLeastSigma_mm = 0.5, kLeastFaceSigma_mm = 2;
  MarkerTemplate refined = marker_template;
  for (int m = 0; m < static_cast<int>(refined.markers.size()); ++m) {
    TemplateMarker& marker = refined.markers[m];
    std::vector<Eigen::Vector3d> places = FoundPlaces(clouds, labelling, m, 2);
    if (places.size() >= kFewest)
      marker.unmeasured_mm.setZero();
    else
      places = FoundPlaces(clouds, labelling, m, 1);
    if (places.size() < kFewest) continue;
    double spread_mm = marker.head_reference ? kLeastSigma_mm : kLeastFaceSigma_mm;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const Eigen::Vector3d& place : places) values.push_back(place[axis]);
      marker.position_mm[axis] = MedianOf(values);
      spread_mm = std::max(spread_mm, SpreadOf_mm(values, marker.position_mm[axis]));
    }
    marker.sigma_mm = spread_mm;
  }
  return refined;
}

}  // namespace articap
