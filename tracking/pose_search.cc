// SPDX-License-Identifier: MIT
#include "tracking/pose_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/alignment.h"

namespace articap {
namespace {

constexpr int kMarkersOfTriples = 9;  // triples are of the most rigid markers
constexpr int kMostTriples = 24;
constexpr int kMostProposals = 60000;  // bounds the time that a hopeless frame takes
constexpr int kRefined = 12;
constexpr double kSigmas = 3;

using Triple = std::array<int, 3>;

struct Proposal {
  Rigid3d template_from_stage;
  double gain = 0;
};

class HeadSearch {
 public:
  HeadSearch(std::span<const MarkerPlace> markers, std::span<const CloudPoint> cloud,
             const LabelPriors& priors, const LabelOptions& options)
      : markers_(markers),
        cloud_(cloud),
        priors_(priors),
        options_(options),
        center_mm_(MiddleOf(markers)) {
    for (const MarkerPlace& marker : markers)
      sigmas_mm_.push_back(std::sqrt(marker.covariance_mm2.trace() / 3));
    for (const CloudPoint& point : cloud)
      if (point.sights.size() != 1) points_mm_.push_back(point.position_in_stage_mm);
  }

  std::optional<FoundHead> Find() {
    if (IsRigidEnough()) {
      for (const Triple& triple : BestTriples()) ProposeFrom(triple);
    } else {
      ProposeFromAttitudes();
    }
    std::sort(proposals_.begin(), proposals_.end(),
              [](const Proposal& a, const Proposal& b) { return a.gain > b.gain; });
    std::vector<FoundHead> found;
    int refined = 0;
    for (const Proposal& proposal : proposals_) {
      const bool is_new = std::none_of(found.begin(), found.end(), [&](const FoundHead& head) {
        return AreAlike(head.template_from_stage, proposal.template_from_stage);
      });
      if (!is_new) continue;
      if (auto head = Refine(proposal.template_from_stage)) found.push_back(std::move(*head));
      if (++refined == kRefined) break;
    }
    return BestOf(found);
  }

 private:
  // Distances tell triples of points apart only where three markers hardly move.
  bool IsRigidEnough() const {
    constexpr double kRigid_mm = 2;
    constexpr int kFewest = 4;
    return std::count_if(sigmas_mm_.begin(), sigmas_mm_.end(),
                         [](double sigma_mm) { return sigma_mm < kRigid_mm; }) >= 3 &&
           static_cast<int>(points_mm_.size()) >= kFewest;
  }

  // Otherwise the head is taken to sit about as it sat when the template was learnt, and any marker
  // may be any point.
  void ProposeFromAttitudes() {
    constexpr std::array kTurns = {0.0, -0.5, 0.5};  // of the attitude's SD
    const double sigma_rad = options_.attitude_sigma_deg * std::numbers::pi / 180;
    for (const double yaw : kTurns)
      for (const double pitch : kTurns)
        for (const double roll : kTurns) {
          const Eigen::Vector3d turn = sigma_rad * Eigen::Vector3d(pitch, yaw, roll);
          Rigid3d pose;
          if (turn.norm() > 0) pose.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
          ProposeShifts(pose);
        }
  }

  void ProposeShifts(Rigid3d pose) {
    for (const MarkerPlace& marker : markers_)
      for (const Eigen::Vector3d& point : points_mm_) {
        pose.translation_mm = marker.position_mm - pose.rotation * point;
        Keep(pose);
      }
  }

  double Tolerance_mm(int a, int b) const {
    constexpr double kMeasurement_mm = 0.5;
    return kSigmas * std::hypot(sigmas_mm_[a], sigmas_mm_[b]) + kMeasurement_mm;
  }

  // The most rigid markers, and of their triples those that determine a pose best.
  std::vector<Triple> BestTriples() const {
    std::vector<int> order(markers_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return sigmas_mm_[a] < sigmas_mm_[b]; });
    order.resize(std::min<std::size_t>(order.size(), kMarkersOfTriples));
    std::vector<std::pair<double, Triple>> rated;
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size(); ++j)
        for (std::size_t k = j + 1; k < order.size(); ++k)
          rated.emplace_back(UncertaintyOf({order[i], order[j], order[k]}),
                             Triple{order[i], order[j], order[k]});
    std::stable_sort(rated.begin(), rated.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Triple> best;
    for (const auto& [uncertainty, triple] : rated)
      if (static_cast<int>(best.size()) < kMostTriples) best.push_back(triple);
    return best;
  }

  double UncertaintyOf(const Triple& triple) const {
    std::array<Eigen::Vector3d, 3> points;
    std::array<double, 3> weights{};
    for (int i = 0; i < 3; ++i) {
      points[i] = markers_[triple[i]].position_mm;
      weights[i] = 1 / (sigmas_mm_[triple[i]] * sigmas_mm_[triple[i]]);
    }
    return WorstRotationSigma(points, weights);
  }

  double TemplateDistance_mm(int a, int b) const {
    return (markers_[a].position_mm - markers_[b].position_mm).norm();
  }
  double CloudDistance_mm(int a, int b) const { return (points_mm_[a] - points_mm_[b]).norm(); }
  bool FitsTogether(int marker_a, int marker_b, int point_a, int point_b) const {
    return point_a != point_b &&
           std::abs(CloudDistance_mm(point_a, point_b) - TemplateDistance_mm(marker_a, marker_b)) <
               Tolerance_mm(marker_a, marker_b);
  }

  void ProposeFrom(const Triple& triple) {
    const int count = static_cast<int>(points_mm_.size());
    for (int a = 0; a < count; ++a)
      for (int b = 0; b < count; ++b) {
        if (!FitsTogether(triple[0], triple[1], a, b)) continue;
        for (int c = 0; c < count; ++c) {
          if (!FitsTogether(triple[0], triple[2], a, c) ||
              !FitsTogether(triple[1], triple[2], b, c))
            continue;
          if (++num_proposals_ > kMostProposals) return;
          Propose(triple, {a, b, c});
        }
      }
  }

  void Propose(const Triple& markers, const Triple& points) {
    std::array<Eigen::Vector3d, 3> source, target;
    for (int i = 0; i < 3; ++i) {
      source[i] = points_mm_[points[i]];
      target[i] = markers_[markers[i]].position_mm;
    }
    Keep(AlignRigid(source, target));
  }

  void Keep(const Rigid3d& pose) {
    constexpr double kCostOfMarker = 10;  // about what a marker that is not found costs
    proposals_.push_back({pose, GainOf(pose) - CostOfAttitude(pose) / kCostOfMarker});
  }

  // Speakers sit as they sat when the template was learnt, more or less.
  double CostOfAttitude(const Rigid3d& pose) const {
    const double angle_rad = pose.rotation.angularDistance(Eigen::Quaterniond::Identity());
    const double sigmas = angle_rad / (options_.attitude_sigma_deg * std::numbers::pi / 180);
    return sigmas * sigmas;
  }

  // How many markers find a point, each counting for more the nearer it is, and the more rigid.
  double GainOf(const Rigid3d& pose) const {
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    double gain = 0;
    std::vector<Eigen::Vector3d> places;
    places.reserve(points_mm_.size());
    for (const Eigen::Vector3d& point : points_mm_)
      places.push_back(rotation * point + pose.translation_mm);
    for (std::size_t m = 0; m < markers_.size(); ++m) {
      double least = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& place : places)
        least = std::min(least, (place - markers_[m].position_mm).squaredNorm());
      constexpr double kProposal_mm = 2;  // what the proposal itself is off
      gain += std::exp(-least / 2 / (sigmas_mm_[m] * sigmas_mm_[m] + kProposal_mm * kProposal_mm));
    }
    return gain;
  }

  std::optional<FoundHead> Refine(const Rigid3d& proposed) const {
    constexpr int kRounds = 6;
    constexpr double kStartSigma_mm = 4;
    FoundHead head;
    head.template_from_stage = proposed;
    double pose_sigma_mm = kStartSigma_mm;
    for (int round = 0; round < kRounds; ++round) {
      const LabelCosts costs =
          CostsOf(markers_, cloud_, Around(head.template_from_stage, 0, pose_sigma_mm), priors_);
      head.points = AssignPoints(costs, cloud_);
      head.cost = TotalCost(costs, head.points) + CostOfAttitude(head.template_from_stage);
      if (round + 1 == kRounds) break;
      constexpr double kLoose_rad = 0.5, kLoose_mm = 50;
      head.template_from_stage = PoseOf(markers_, cloud_, head.points,
                                        Around(head.template_from_stage, kLoose_rad, kLoose_mm))
                                     .template_from_stage;
      pose_sigma_mm /= 2;
    }
    const auto count =
        std::count_if(head.points.begin(), head.points.end(), [](int point) { return point >= 0; });
    const double least = options_.least_share * static_cast<double>(markers_.size());
    if (static_cast<double>(count) < std::max(3.0, least)) return std::nullopt;
    return head;
  }

  PoseEstimate Around(const Rigid3d& pose, double rotation_sigma_rad,
                      double translation_sigma_mm) const {
    return PoseEstimate::Isotropic(pose, center_mm_, rotation_sigma_rad, translation_sigma_mm);
  }

  static bool AreAlike(const Rigid3d& a, const Rigid3d& b) {
    constexpr double kAngle_rad = 0.35;
    constexpr double kDistance_mm = 30;
    const Rigid3d between = a * b.Inverse();
    return a.rotation.angularDistance(b.rotation) < kAngle_rad &&
           between.translation_mm.norm() < kDistance_mm;
  }

  static std::optional<FoundHead> BestOf(const std::vector<FoundHead>& found) {
    if (found.empty()) return std::nullopt;
    FoundHead best =
        *std::min_element(found.begin(), found.end(),
                          [](const FoundHead& a, const FoundHead& b) { return a.cost < b.cost; });
    best.next_cost = std::numeric_limits<double>::infinity();
    for (const FoundHead& head : found)
      if (!AreAlike(head.template_from_stage, best.template_from_stage))
        best.next_cost = std::min(best.next_cost, head.cost);
    return best;
  }

  std::span<const MarkerPlace> markers_;
  std::span<const CloudPoint> cloud_;
  std::vector<double> sigmas_mm_;           // of the markers, the mean of all directions
  std::vector<Eigen::Vector3d> points_mm_;  // of those whose place is known, stage
  const LabelPriors& priors_;
  const LabelOptions& options_;
  Eigen::Vector3d center_mm_;
  std::vector<Proposal> proposals_;
  int num_proposals_ = 0;
};

}  // namespace

std::optional<FoundHead> FindHead(std::span<const MarkerPlace> markers,
                                  std::span<const CloudPoint> cloud, const LabelPriors& priors,
                                  const LabelOptions& options) {
  if (markers.empty() || cloud.empty()) return std::nullopt;
  return HeadSearch(markers, cloud, priors, options).Find();
}

}  // namespace articap
