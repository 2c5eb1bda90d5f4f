// SPDX-License-Identifier: MIT
#include "tracking/label_smoothing.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/statistics.h"

namespace articap {
namespace {

// What the pose found in the first pass may still be off.
constexpr double kPoseSigma_mm = 0.5;
constexpr double kPoseSigma_rad = 0.01;
// No place is expected to better than this.
constexpr double kLeastSigma_mm = 0.3;

class BothSides {
 public:
  BothSides(const PointClouds& clouds, const MarkerTemplate& marker_template,
            const LabelPriors& priors, double memory_s, std::vector<LabelledFrame>& frames)
      : clouds_(clouds),
        template_(marker_template),
        priors_(priors),
        memory_s_(memory_s),
        frames_(frames),
        center_mm_(MiddleOf(HomesOf(marker_template))),
        restlessness_(marker_template.markers.size(), 1),
        before_(marker_template.markers.size(), -1),
        after_(marker_template.markers.size(), -1) {
    LearnRestlessness();
  }

  // From one end to the other, so that what a frame gains helps the next.
  void Sweep(bool forwards) {
    const int count = clouds_.num_frames();
    std::vector<int>& nearer = forwards ? before_ : after_;
    std::vector<int>& farther = forwards ? after_ : before_;
    std::fill(nearer.begin(), nearer.end(), -1);
    std::fill(farther.begin(), farther.end(), -1);
    for (int i = 0; i < count; ++i) {
      const int frame = forwards ? i : count - 1 - i;
      FindNext(frame, forwards ? 1 : -1, farther);
      frames_[frame] = Label(frame);
      for (int m = 0; m < static_cast<int>(nearer.size()); ++m)
        if (IsLabelled(frame, m)) nearer[m] = frame;
    }
  }

 private:
  // How much less a marker moves from frame to frame than the process would, which knows no
  // velocity: from samples between two others, all of them seen by two views or more.
  void LearnRestlessness() {
    constexpr std::size_t kFewest = 20;
    constexpr double kCalmest = 0.1;
    for (int m = 0; m < static_cast<int>(restlessness_.size()); ++m) {
      std::vector<double> ratios;
      for (int frame = 1; frame + 1 < clouds_.num_frames(); ++frame) {
        if (!IsMeasured(frame - 1, m) || !IsMeasured(frame, m) || !IsMeasured(frame + 1, m))
          continue;
        before_[m] = frame - 1;
        after_[m] = frame + 1;
        const MarkerPlace expected = Expect(m, frame);
        ratios.push_back(
            (frames_[frame].places[m].position_mm - expected.position_mm).squaredNorm() /
            expected.covariance_mm2.trace());
      }
      if (ratios.size() < kFewest) continue;
      // Of a chi-squared variable of three degrees of freedom, each: faces rest, and move at once.
      constexpr double kPart = 0.95, kQuantile = 7.815 / 3;
      restlessness_[m] =
          std::clamp(QuantileOf(std::move(ratios), kPart) / kQuantile, kCalmest, 1.0);
    }
  }

  bool IsMeasured(int frame, int marker) const {
    return IsLabelled(frame, marker) &&
           clouds_.frames[frame][frames_[frame].points[marker]].sights.size() != 1;
  }

  // The next frame beyond this one in which each marker is labelled; -1 for none.
  void FindNext(int frame, int step, std::vector<int>& next) const {
    const int count = clouds_.num_frames();
    for (int m = 0; m < static_cast<int>(next.size()); ++m) {
      if (next[m] >= 0 && (next[m] - frame) * step > 0) continue;
      int at = frame + step;
      while (at >= 0 && at < count && !IsLabelled(at, m)) at += step;
      next[m] = at >= 0 && at < count ? at : -1;
    }
  }

  LabelledFrame Label(int frame) const {
    LabelledFrame result = frames_[frame];
    if (!result.template_from_stage) return result;
    const auto& cloud = clouds_.frames[frame];
    result.places.clear();
    for (int m = 0; m < static_cast<int>(template_.markers.size()); ++m)
      result.places.push_back(Expect(m, frame));
    const auto prior = PoseEstimate::Isotropic(*result.template_from_stage, center_mm_,
                                               kPoseSigma_rad, kPoseSigma_mm);
    PoseEstimate pose = prior;
    constexpr int kRounds = 2;
    for (int round = 0; round < kRounds; ++round) {
      const LabelCosts costs = CostsOf(result.places, cloud, pose, priors_);
      result.points = AssignPoints(costs, cloud);
      result.margins = MarginsOf(costs, cloud, result.points);
      pose = PoseOf(result.places, cloud, result.points, prior);
    }
    result.template_from_stage = pose.template_from_stage;
    DropDoubtful(cloud, result);
    AddPlaces(cloud, result);
    return result;
  }

  bool IsLabelled(int frame, int marker) const {
    return frames_[frame].template_from_stage && frames_[frame].points[marker] >= 0;
  }

  double Correlation(int frame, int other) const {
    const double apart = std::sqrt(3.0) * std::abs(frame - other) / clouds_.rate_hz / memory_s_;
    return (1 + apart) * std::exp(-apart);
  }

  MarkerPlace Expect(int marker, int frame) const {
    const TemplateMarker& home = template_.markers[marker];
    std::vector<int> samples;
    for (const int sample : {before_[marker], after_[marker]})
      if (sample >= 0) samples.push_back(sample);
    const int count = static_cast<int>(samples.size());
    Eigen::MatrixXd between = Eigen::MatrixXd::Identity(count, count);
    Eigen::VectorXd here(count);
    Eigen::MatrixX3d strayed(count, 3);
    for (int i = 0; i < count; ++i) {
      here[i] = Correlation(frame, samples[i]);
      strayed.row(i) = frames_[samples[i]].places[marker].position_mm - home.position_mm;
      for (int k = 0; k < i; ++k)
        between(i, k) = between(k, i) = Correlation(samples[i], samples[k]);
    }
    const Eigen::VectorXd weights = between.inverse() * here;
    MarkerPlace place;
    place.position_mm = home.position_mm + strayed.transpose() * weights;
    const double left = std::max(0.0, 1 - here.dot(weights));
    place.covariance_mm2 = restlessness_[marker] * left * home.covariance_mm2() +
                           kLeastSigma_mm * kLeastSigma_mm * Eigen::Matrix3d::Identity();
    // What is not known of the samples themselves, as the depth of single sights: that is wrong in
    // all of them alike.
    for (int i = 0; i < count; ++i)
      place.covariance_mm2 +=
          weights.sum() * weights[i] * frames_[samples[i]].places[marker].covariance_mm2;
    return place;
  }

  const PointClouds& clouds_;
  const MarkerTemplate& template_;
  const LabelPriors& priors_;
  double memory_s_;
  std::vector<LabelledFrame>& frames_;
  Eigen::Vector3d center_mm_;
  // By marker: variance about the mean of the process, over what its covariance says.
  std::vector<double> restlessness_;
  // By marker: the nearest labelled frames of the one that is being labelled; -1 for none.
  std::vector<int> before_, after_;
};

}  // namespace

int RelabelFromBothSides(const PointClouds& clouds, const MarkerTemplate& marker_template,
                         const LabelPriors& priors, double memory_s,
                         std::vector<LabelledFrame>& frames) {
  const std::vector<LabelledFrame> first = frames;
  BothSides both_sides(clouds, marker_template, priors, memory_s, frames);
  both_sides.Sweep(true);
  both_sides.Sweep(false);
  int changed = 0;
  for (std::size_t frame = 0; frame < frames.size(); ++frame)
    for (std::size_t m = 0; m < frames[frame].points.size(); ++m) {
      const int before = first[frame].points[m];
      if (before >= 0 && frames[frame].points[m] != before) ++changed;
    }
  return changed;
}

}  // namespace articap
