// SPDX-License-Identifier: MIT
#include "tracking/label.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "core/statistics.h"
#include "tracking/head_motion.h"
#include "tracking/label_assignment.h"
#include "tracking/label_smoothing.h"
#include "tracking/label_votes.h"
#include "tracking/pose_search.h"

namespace articap {
namespace {

// No marker is expected to better than this, however slow.
constexpr double kLeastSigma_mm = 0.3;
// Of a pose that was found from a frame by itself.
constexpr double kFoundPoseSigma_mm = 0.3;

// What is known of a marker within the head.
struct MarkerState {
  bool seen = false;  // ever
  int frame = 0;      // when last
  MarkerPlace place;
  Eigen::Vector3d velocity_mm_per_frame = Eigen::Vector3d::Zero();
};

// Goes through a take, forwards or backwards, frame after frame.
class LabelPass {
 public:
  LabelPass(const PointClouds& clouds, const MarkerTemplate& marker_template,
            const LabelPriors& priors, const LabelOptions& options)
      : clouds_(clouds),
        priors_(priors),
        options_(options),
        home_(HomesOf(marker_template)),
        states_(marker_template.markers.size()),
        motion_(MiddleOf(home_), options) {}

  int searches() const { return searches_; }

  LabelledFrame Label(int frame) {
    const auto& cloud = clouds_.frames[frame];
    std::optional<PoseEstimate> pose;
    LabelledFrame result = Follow(frame, pose);
    const bool is_followed = IsEnough(result);
    if (!is_followed) result = Search(cloud);
    DropDoubtful(cloud, result);
    result.places = ExpectAll(frame);
    AddPlaces(cloud, result);
    if (!result.template_from_stage) return result;
    if (is_followed)
      motion_.Update(SecondsSince(frame, last_frame_), *pose);
    else
      motion_.Start(*result.template_from_stage);
    Remember(frame, result);
    return result;
  }

  // Goes on from a frame that was labelled elsewhere.
  void StartFrom(int frame, const LabelledFrame& labelled) {
    motion_.Start(*labelled.template_from_stage);
    Remember(frame, labelled);
  }

 private:
  void Remember(int frame, const LabelledFrame& labelled) {
    last_frame_ = frame;
    for (int m = 0; m < static_cast<int>(states_.size()); ++m) {
      if (labelled.points[m] < 0) continue;
      const MarkerPlace place = labelled.places[m];
      MarkerState& state = states_[m];
      state.velocity_mm_per_frame.setZero();
      if (state.seen && std::abs(frame - state.frame) == 1)
        state.velocity_mm_per_frame = place.position_mm - state.place.position_mm;
      state.seen = true;
      state.frame = frame;
      state.place = place;
    }
  }

  double SecondsSince(int frame, int earlier) const {
    return std::abs(frame - earlier) / clouds_.rate_hz;
  }

  // An Ornstein-Uhlenbeck process around home: near where it was last, and the longer it is unseen
  // (in any direction), the more at home. For a frame it also goes on as it went, damped.
  MarkerPlace Expect(int marker, int frame) const {
    const MarkerState& state = states_[marker];
    const MarkerPlace& home = home_[marker];
    if (!state.seen) return home;
    constexpr double kDamped = 0.8;
    const double kept = std::exp(-SecondsSince(frame, state.frame) / options_.memory_s);
    const Eigen::Vector3d ahead = state.place.position_mm + kDamped * state.velocity_mm_per_frame;
    return {kept * ahead + (1 - kept) * home.position_mm,
            kept * kept * state.place.covariance_mm2 + (1 - kept * kept) * home.covariance_mm2 +
                kLeastSigma_mm * kLeastSigma_mm * Eigen::Matrix3d::Identity()};
  }

  std::vector<MarkerPlace> ExpectAll(int frame) const {
    std::vector<MarkerPlace> all;
    for (int m = 0; m < static_cast<int>(states_.size()); ++m) all.push_back(Expect(m, frame));
    return all;
  }

  LabelledFrame Follow(int frame, std::optional<PoseEstimate>& pose) const {
    constexpr int kRounds = 3;
    LabelledFrame result;
    const double since_s = SecondsSince(frame, last_frame_);
    if (!motion_.is_known() || since_s > options_.memory_s) return result;
    const auto& cloud = clouds_.frames[frame];
    const std::vector<MarkerPlace> expected = ExpectAll(frame);
    const PoseEstimate prior = motion_.Predict(since_s);
    pose = prior;
    for (int round = 0; round < kRounds; ++round) {
      const LabelCosts costs = CostsOf(expected, cloud, *pose, priors_);
      result.points = AssignPoints(costs, cloud);
      result.margins = MarginsOf(costs, cloud, result.points);
      pose = PoseOf(expected, cloud, result.points, prior);
    }
    result.template_from_stage = pose->template_from_stage;
    return result;
  }

  // The head has not been lost: three markers, and not many fewer than there are points for, and it
  // is not turned as no head is.
  bool IsEnough(const LabelledFrame& labelled) const {
    constexpr double kLeastShare = 0.3, kMostSigmas = 4;
    if (!labelled.template_from_stage) return false;
    const double turn_rad = Eigen::AngleAxisd(labelled.template_from_stage->rotation).angle();
    return turn_rad < kMostSigmas * options_.attitude_sigma_deg * std::numbers::pi / 180 &&
           labelled.num_labelled() >=
               std::max(3.0, kLeastShare * static_cast<double>(home_.size()));
  }

  LabelledFrame Search(const std::vector<CloudPoint>& cloud) {
    LabelledFrame result;
    result.points.assign(home_.size(), -1);
    result.margins.assign(home_.size(), std::numeric_limits<float>::quiet_NaN());
    const auto found = FindHead(home_, cloud, priors_, options_);
    if (!found) return result;
    ++searches_;
    result.template_from_stage = found->template_from_stage;
    result.points = found->points;
    const auto pose = PoseEstimate::Isotropic(found->template_from_stage, motion_.center_mm(), 0,
                                              kFoundPoseSigma_mm);
    result.margins = MarginsOf(CostsOf(home_, cloud, pose, priors_), cloud, found->points);
    return result;
  }

  const PointClouds& clouds_;
  const LabelPriors& priors_;
  const LabelOptions& options_;
  std::vector<MarkerPlace> home_;  // where the template says
  std::vector<MarkerState> states_;
  HeadMotion motion_;
  int last_frame_ = 0;
  int searches_ = 0;
};

// How often a marker is seen by one view only: as often as more views see fewer markers than there
// are. They bet on one another's dots where nothing contradicts them, hence the bounds.
LabelPriors PriorsOf(const PointClouds& clouds, const MarkerTemplate& marker_template,
                     const LabelOptions& options) {
  std::vector<double> by_more_views;
  for (const auto& cloud : clouds.frames)
    by_more_views.push_back(
        static_cast<double>(std::count_if(cloud.begin(), cloud.end(), [](const CloudPoint& point) {
          return point.sights.size() != 1;
        })));
  const double most = options.seen * static_cast<double>(marker_template.markers.size());
  constexpr double kLeast = 0.02, kMost = 0.6;
  LabelPriors priors = {{options.seen, kLeast}, options.false_points, options.false_points};
  if (!by_more_views.empty())
    priors.usual.seen_by_one_view = std::clamp(1 - MedianOf(by_more_views) / most, kLeast, kMost);
  return priors;
}

// Dots of a frame that no labelled point explains. Points of a file count as dots.
int CountUnexplained(const std::vector<CloudPoint>& cloud, const std::vector<int>& labelled) {
  std::set<std::pair<int, int>> explained, all;
  const auto insert = [](const CloudPoint& point, int index, auto& dots) {
    for (const DotSight& sight : point.sights) dots.insert({sight.view.camera, sight.dot});
    if (point.sights.empty()) dots.insert({-1, index});
  };
  for (int i = 0; i < static_cast<int>(cloud.size()); ++i) insert(cloud[i], i, all);
  for (const int point : labelled)
    if (point >= 0) insert(cloud[point], point, explained);
  return static_cast<int>(all.size() - explained.size());
}

int CountUnlabelledPairs(const std::vector<CloudPoint>& cloud, const std::vector<int>& labelled) {
  const auto is_pair = [](const CloudPoint& point) { return point.sights.size() == 2; };
  const auto pairs = std::count_if(cloud.begin(), cloud.end(), is_pair);
  const auto named = std::count_if(labelled.begin(), labelled.end(),
                                   [&](int point) { return point >= 0 && is_pair(cloud[point]); });
  return static_cast<int>(pairs - named);
}

// How often a marker is seen, and by one view: what the first pass says, and a second of what is
// usual beside it.
MarkerPriors LearnFrom(const PointClouds& clouds, const std::vector<LabelledFrame>& frames,
                       int marker, const MarkerPriors& usual) {
  double expected = clouds.rate_hz, seen = usual.seen * expected,
         by_one_view = usual.seen_by_one_view * seen;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    if (!frames[frame].template_from_stage) continue;
    ++expected;
    const int point = frames[frame].points[marker];
    if (point < 0) continue;
    ++seen;
    if (clouds.frames[frame][point].sights.size() == 1) ++by_one_view;
  }
  constexpr double kLeast = 0.01, kMost = 0.99;
  return {std::clamp(seen / expected, kLeast, kMost),
          std::clamp(by_one_view / seen, kLeast, kMost)};
}

// What the first pass says about how often markers are seen, and how many points are false.
LabelPriors LearnFrom(const PointClouds& clouds, const std::vector<LabelledFrame>& frames,
                      LabelPriors priors) {
  int known = 0, expected = 0, unexplained = 0, unlabelled_pairs = 0, counted = 0;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    if (!frames[frame].template_from_stage) continue;
    ++counted;
    known += frames[frame].num_labelled();
    expected += static_cast<int>(frames[frame].points.size());
    unexplained += CountUnexplained(clouds.frames[frame], frames[frame].points);
    unlabelled_pairs += CountUnlabelledPairs(clouds.frames[frame], frames[frame].points);
  }
  constexpr double kSudden = 0.02;
  priors.sudden = kSudden;
  if (counted == 0) return priors;
  constexpr double kLeastSeen = 0.5, kMostSeen = 0.99, kFewestFalse = 0.05;
  priors.usual.seen = std::clamp(1.0 * known / expected, kLeastSeen, kMostSeen);
  priors.false_points = std::max(kFewestFalse, 1.0 * unexplained / counted);
  priors.false_pairs = std::max(kFewestFalse, 1.0 * unlabelled_pairs / counted);
  for (int marker = 0; marker < static_cast<int>(frames.front().points.size()); ++marker)
    priors.markers.push_back(LearnFrom(clouds, frames, marker, priors.usual));
  return priors;
}

// Whether two views or more saw three markers: then a frame shows how the head is turned.
bool ShowsAttitude(const std::vector<CloudPoint>& cloud, const LabelledFrame& frame) {
  constexpr int kEnough = 3;
  const auto seen = std::count_if(frame.points.begin(), frame.points.end(), [&](int point) {
    return point >= 0 && cloud[point].sights.size() != 1;
  });
  return frame.template_from_stage && seen >= kEnough;
}

// How far the head turns, from the frames that show it; nothing where nearly all do, or too few.
std::optional<double> LearnAttitudeSigma_deg(const PointClouds& clouds,
                                             const std::vector<LabelledFrame>& frames) {
  constexpr double kNearlyAll = 0.9, kFewest_s = 1, kLeast_deg = 8, kTimes = 2;
  constexpr double kMedianOfChi3 = 1.538;
  std::vector<double> turns_rad;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    if (!ShowsAttitude(clouds.frames[frame], frames[frame])) continue;
    turns_rad.push_back(Eigen::AngleAxisd(frames[frame].template_from_stage->rotation).angle());
  }
  const auto count = static_cast<double>(turns_rad.size());
  if (count < kFewest_s * clouds.rate_hz || count > kNearlyAll * static_cast<double>(frames.size()))
    return std::nullopt;
  const double sigma_rad = MedianOf(std::move(turns_rad)) / kMedianOfChi3;
  return std::max(kLeast_deg, kTimes * sigma_rad * 180 / std::numbers::pi);
}

Labelling FirstPass(const PointClouds& clouds, const MarkerTemplate& marker_template,
                    const LabelPriors& priors, const LabelOptions& options) {
  Labelling labelling;
  LabelPass forwards(clouds, marker_template, priors, options);
  int first = -1;  // frame in which the head is found
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    labelling.frames.push_back(forwards.Label(frame));
    if (first < 0 && labelling.frames.back().template_from_stage) first = frame;
  }
  labelling.searches = forwards.searches();
  // What came before may show too little of the head to find it, yet enough to follow it.
  if (first > 0) {
    LabelPass backwards(clouds, marker_template, priors, options);
    backwards.StartFrom(first, labelling.frames[first]);
    for (int frame = first - 1; frame >= 0; --frame)
      labelling.frames[frame] = backwards.Label(frame);
  }
  return labelling;
}

}  // namespace

int LabelledFrame::num_labelled() const {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [](int point) { return point >= 0; }));
}

const CloudPoint* LabelledPoint(const PointClouds& clouds, const Labelling& labelling, int frame,
                                int marker) {
  const LabelledFrame& labelled = labelling.frames[frame];
  if (!labelled.template_from_stage || labelled.points[marker] < 0) return nullptr;
  return &clouds.frames[frame][labelled.points[marker]];
}

void VisitOptions(LabelOptions& options, OptionVisitor& visit) {
  visit("seen", options.seen, "part of a marker's frames in which it is found");
  visit("false_points", options.false_points,
        "points a frame, in a cube of 300 mm, that are no markers");
  visit("head_acceleration_mm_s2", options.head_acceleration_mm_s2,
        "about the most of the head; mm/s2");
  visit("attitude_sigma_deg", options.attitude_sigma_deg,
        "how far the head is turned from where the template was learnt, SD; degrees");
  visit("memory_s", options.memory_s,
        "how long a marker stays away from where the template says, about; s");
  visit("least_share", options.least_share,
        "part of the markers that must be seen to find the head anew");
}

Result<void> CheckOptions(const LabelOptions& options) {
  for (const auto& [name, value] :
       {std::pair("seen", options.seen), std::pair("least_share", options.least_share)})
    if (!(value > 0 && value < 1))
      return Fail(fmt::format("{} is {}; it must lie between 0 and 1", name, value));
  return RequirePositive({{"false_points", options.false_points},
                          {"head_acceleration_mm_s2", options.head_acceleration_mm_s2},
                          {"attitude_sigma_deg", options.attitude_sigma_deg},
                          {"memory_s", options.memory_s}});
}

Labelling LabelClouds(const PointClouds& clouds, const MarkerTemplate& marker_template,
                      const LabelOptions& options) {
  const LabelPriors priors = PriorsOf(clouds, marker_template, options);
  Labelling labelling = FirstPass(clouds, marker_template, priors, options);
  // Where a mirror hides what would tell it, the head must not turn farther than it does elsewhere.
  if (const auto sigma_deg = LearnAttitudeSigma_deg(clouds, labelling.frames);
      sigma_deg && *sigma_deg < options.attitude_sigma_deg) {
    LabelOptions calmer = options;
    calmer.attitude_sigma_deg = *sigma_deg;
    labelling = FirstPass(clouds, marker_template, priors, calmer);
  }
  const LabelPriors learnt = LearnFrom(clouds, labelling.frames, priors);
  labelling.relabelled =
      RelabelFromBothSides(clouds, marker_template, learnt, options.memory_s / 2, labelling.frames);
  labelling.swaps_repaired = RepairByVotes(clouds, labelling.frames);
  return labelling;
}

}  // namespace articap
