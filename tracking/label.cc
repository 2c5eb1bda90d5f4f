// SPDX-License-Identifier: MIT
#include "tracking/label.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tracking/label_assignment.h"
#include "tracking/label_votes.h"
#include "tracking/pose_search.h"

namespace articap {
namespace {

// No marker is expected to better than this, however slow.
constexpr double kLeastSigma_mm = 0.3;
// Of the pose once it has been found from the frame itself.
constexpr double kFoundPoseSigma_mm = 0.3;

// What is known of a marker within the head.
struct MarkerState {
  bool seen = false;  // ever
  int frame = 0;      // when last
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mm_per_frame = Eigen::Vector3d::Zero();
};

// Goes through a take, forwards or backwards, frame after frame.
class LabelPass {
 public:
  LabelPass(const PointClouds& clouds, const MarkerTemplate& marker_template,
            const LabelOptions& options)
      : clouds_(clouds), options_(options), states_(marker_template.markers.size()) {
    for (const TemplateMarker& marker : marker_template.markers)
      home_.push_back({marker.position_mm, marker.sigma_mm});
  }

  int searches() const { return searches_; }

  LabelledFrame Label(int frame) {
    const auto& cloud = clouds_.frames[frame];
    LabelledFrame result = Follow(frame);
    if (!IsEnough(result)) result = Search(cloud);
    if (result.template_from_stage) Remember(frame, result);
    return result;
  }

  // Goes on from a frame that was labelled elsewhere.
  void Remember(int frame, const LabelledFrame& labelled) {
    const Rigid3d& pose = *labelled.template_from_stage;
    if (last_pose_ && std::abs(frame - last_frame_) == 1)
      step_ = pose * last_pose_->Inverse();
    else
      step_ = Rigid3d{};
    last_pose_ = pose;
    last_frame_ = frame;
    for (int m = 0; m < static_cast<int>(states_.size()); ++m) {
      if (labelled.points[m] < 0) continue;
      MarkerState& state = states_[m];
      const Eigen::Vector3d position =
          pose * clouds_.frames[frame][labelled.points[m]].position_in_stage_mm;
      state.velocity_mm_per_frame.setZero();
      if (state.seen && std::abs(frame - state.frame) == 1)
        state.velocity_mm_per_frame = position - state.position_mm;
      state.seen = true;
      state.frame = frame;
      state.position_mm = position;
    }
  }

 private:
  double SecondsSince(int frame, int earlier) const {
    return std::abs(frame - earlier) / clouds_.rate_hz;
  }

  // Near where it was last, as far as an acceleration may have led it; the longer it is unseen, the
  // more at home.
  Expectation Expect(int marker, int frame) const {
    const MarkerState& state = states_[marker];
    const Expectation& home = home_[marker];
    if (!state.seen) return home;
    const double since_s = SecondsSince(frame, state.frame);
    const double trust =
        std::exp(-std::max(0.0, since_s - 1 / clouds_.rate_hz) / options_.memory_s);
    // One frame of constant velocity, damped: what is fast stops soon.
    const Eigen::Vector3d ahead = state.position_mm + 0.8 * state.velocity_mm_per_frame;
    const double strayed_mm = options_.acceleration_mm_s2 * since_s * since_s / 2;
    const double sigma_mm =
        trust * std::min(strayed_mm, home.sigma_mm) + (1 - trust) * home.sigma_mm;
    return {trust * ahead + (1 - trust) * home.position_mm, std::max(sigma_mm, kLeastSigma_mm)};
  }

  std::vector<Expectation> ExpectAll(int frame) const {
    std::vector<Expectation> all;
    for (int m = 0; m < static_cast<int>(states_.size()); ++m) all.push_back(Expect(m, frame));
    return all;
  }

  LabelledFrame Follow(int frame) const {
    constexpr int kRounds = 3;
    LabelledFrame result;
    if (!last_pose_) return result;
    const double since_s = SecondsSince(frame, last_frame_);
    if (since_s > options_.memory_s) return result;
    const auto& cloud = clouds_.frames[frame];
    const std::vector<Expectation> expected = ExpectAll(frame);
    Rigid3d pose = step_ * *last_pose_;
    double pose_sigma_mm =
        kFoundPoseSigma_mm + options_.head_acceleration_mm_s2 * since_s * since_s / 2;
    for (int round = 0; round < kRounds; ++round) {
      const LabelCosts costs = CostsOf(expected, cloud, pose, pose_sigma_mm, options_);
      result.points = AssignPoints(costs, cloud);
      result.margins = MarginsOf(costs, result.points);
      const auto better = PoseOf(expected, cloud, result.points);
      if (!better) return result;
      pose = *better;
      pose_sigma_mm = kFoundPoseSigma_mm;
    }
    result.template_from_stage = pose;
    return result;
  }

  // The head has not been lost: three markers, and not many fewer than there are points for.
  bool IsEnough(const LabelledFrame& labelled) const {
    constexpr double kLeastShare = 0.3;
    return labelled.template_from_stage &&
           labelled.num_labelled() >=
               std::max(3.0, kLeastShare * static_cast<double>(home_.size()));
  }

  LabelledFrame Search(const std::vector<CloudPoint>& cloud) {
    LabelledFrame result;
    result.points.assign(home_.size(), -1);
    result.margins.assign(home_.size(), std::numeric_limits<float>::quiet_NaN());
    const auto found = FindHead(home_, cloud, options_);
    if (!found) return result;
    ++searches_;
    result.template_from_stage = found->template_from_stage;
    result.points = found->points;
    result.margins =
        MarginsOf(CostsOf(home_, cloud, found->template_from_stage, kFoundPoseSigma_mm, options_),
                  found->points);
    return result;
  }

  const PointClouds& clouds_;
  const LabelOptions& options_;
  std::vector<Expectation> home_;  // where the template says
  std::vector<MarkerState> states_;
  std::optional<Rigid3d> last_pose_;
  int last_frame_ = 0;
  Rigid3d step_;  // of the head, from one frame to the next
  int searches_ = 0;
};

}  // namespace

int LabelledFrame::num_labelled() const {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [](int point) { return point >= 0; }));
}

void VisitOptions(LabelOptions& options, OptionVisitor& visit) {
  visit("seen", options.seen, "part of a marker's frames in which it is found");
  visit("false_points", options.false_points,
        "points a frame, in a cube of 300 mm, that are no markers");
  visit("acceleration_mm_s2", options.acceleration_mm_s2,
        "about the most of a marker within the head; mm/s2");
  visit("head_acceleration_mm_s2", options.head_acceleration_mm_s2,
        "about the most of the head; mm/s2");
  visit("memory_s", options.memory_s,
        "after this long unseen, a marker is expected where the template says; s");
  visit("least_share", options.least_share,
        "part of the markers that must be seen to find the head anew");
}

Result<void> CheckOptions(const LabelOptions& options) {
  for (const auto& [name, value] :
       {std::pair("seen", options.seen), std::pair("least_share", options.least_share)})
    if (!(value > 0 && value < 1))
      return Fail(fmt::format("{} is {}; it must lie between 0 and 1", name, value));
  return RequirePositive({{"false_points", options.false_points},
                          {"acceleration_mm_s2", options.acceleration_mm_s2},
                          {"head_acceleration_mm_s2", options.head_acceleration_mm_s2},
                          {"memory_s", options.memory_s}});
}

Labelling LabelClouds(const PointClouds& clouds, const MarkerTemplate& marker_template,
                      const LabelOptions& options) {
  Labelling labelling;
  LabelPass forwards(clouds, marker_template, options);
  int first = -1;  // frame in which the head is found
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    labelling.frames.push_back(forwards.Label(frame));
    if (first < 0 && labelling.frames.back().template_from_stage) first = frame;
  }
  labelling.searches = forwards.searches();
  // What came before may show too little of the head to find it, yet enough to follow it.
  if (first > 0) {
    LabelPass backwards(clouds, marker_template, options);
    backwards.Remember(first, labelling.frames[first]);
    for (int frame = first - 1; frame >= 0; --frame)
      labelling.frames[frame] = backwards.Label(frame);
  }
  labelling.swaps_repaired = RepairByVotes(clouds, labelling.frames);
  return labelling;
}

}  // namespace articap
