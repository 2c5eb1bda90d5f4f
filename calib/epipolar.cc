// SPDX-License-Identifier: MIT
#include "calib/epipolar.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

namespace articap {
namespace {

// A pair of rays that show one point: second' E first = 0.
struct Match {
  Eigen::Vector3d first;
  Eigen::Vector3d second;
};

// Shifts and scales so that points have mean 0 and distance sqrt 2 on average.
Eigen::Matrix3d Normalizer(const std::vector<Match>& matches, Eigen::Vector3d Match::*side) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Match& match : matches) mean += (match.*side).head<2>();
  mean /= static_cast<double>(matches.size());
  double distance = 0;
  for (const Match& match : matches) distance += ((match.*side).head<2>() - mean).norm();
  const double scale = std::sqrt(2.0) * static_cast<double>(matches.size()) / distance;
  Eigen::Matrix3d normalizer;
  normalizer << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return normalizer;
}

Eigen::Matrix3d EssentialOf(const std::vector<Match>& matches) {
  const Eigen::Matrix3d first = Normalizer(matches, &Match::first);
  const Eigen::Matrix3d second = Normalizer(matches, &Match::second);
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const Match& match : matches) {
    const Eigen::Vector3d a = first * match.first, b = second * match.second;
    Eigen::Matrix<double, 9, 1> row;
    row << b.x() * a, b.y() * a, b.z() * a;
    normal += row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(normal);
  const Eigen::Matrix<double, 9, 1> smallest = eigen.eigenvectors().col(0);
  const Eigen::Matrix3d fundamental =
      second.transpose() *
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(smallest.data()) * first;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(fundamental,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * Eigen::Vector3d(1, 1, 0).asDiagonal() * svd.matrixV().transpose();
}

// The larger of the distances to the epipolar lines, in both pictures.
double DistanceOf(const Eigen::Matrix3d& essential, const Eigen::Vector3d& first,
                  const Eigen::Vector3d& second) {
  const Eigen::Vector3d line_in_second = essential * first;
  const Eigen::Vector3d line_in_first = essential.transpose() * second;
  const double product = std::abs(second.dot(line_in_second));
  return product / std::min(line_in_second.head<2>().norm(), line_in_first.head<2>().norm());
}

struct Judgement {
  std::vector<bool> swapped;
  std::vector<bool> inlier;
  int num_inliers = 0;
};

Judgement Judge(const Eigen::Matrix3d& essential, const std::vector<PointPairView>& views,
                double tolerance) {
  Judgement judgement;
  for (const PointPairView& view : views) {
    const auto distance_of = [&](int swapped) {
      return std::max(DistanceOf(essential, view.first[0], view.second[swapped]),
                      DistanceOf(essential, view.first[1], view.second[1 - swapped]));
    };
    const double as_is = distance_of(0), other = distance_of(1);
    judgement.swapped.push_back(other < as_is);
    judgement.inlier.push_back(std::min(as_is, other) < tolerance);
    judgement.num_inliers += judgement.inlier.back();
  }
  return judgement;
}

void AddMatches(const PointPairView& view, bool swapped, std::vector<Match>& matches) {
  matches.push_back({view.first[0], view.second[swapped ? 1 : 0]});
  matches.push_back({view.first[1], view.second[swapped ? 0 : 1]});
}

std::vector<Match> MatchesOf(const std::vector<PointPairView>& views, const Judgement& judgement) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (judgement.inlier[i]) AddMatches(views[i], judgement.swapped[i], matches);
  return matches;
}

// Of the four poses of an essential matrix the one that has the points ahead of both cameras.
Rigid3d PoseOf(const Eigen::Matrix3d& essential, const std::vector<Match>& matches) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(essential, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Rigid3d best;
  int most_ahead = -1;
  for (const Eigen::Matrix3d& between : {turn, Eigen::Matrix3d(turn.transpose())})
    for (double sign : {1.0, -1.0}) {
      Eigen::Matrix3d rotation = svd.matrixU() * between * svd.matrixV().transpose();
      if (rotation.determinant() < 0) rotation = -rotation;
      const Rigid3d pose{Eigen::Quaterniond(rotation), sign * svd.matrixU().col(2)};
      int ahead = 0;
      for (const Match& match : matches) {
        // depth_second * second = depth_first * R first + t
        Eigen::Matrix<double, 3, 2> rays;
        rays << match.second, -(pose.rotation * match.first);
        const Eigen::Vector2d depths =
            (rays.transpose() * rays).inverse() * rays.transpose() * pose.translation_mm;
        ahead += depths.minCoeff() > 0;
      }
      if (ahead > most_ahead) {
        most_ahead = ahead;
        best = pose;
      }
    }
  return best;
}

}  // namespace

std::optional<RelativePose> FindRelativePose(const std::vector<PointPairView>& views,
                                             double tolerance) {
  constexpr int kSampleViews = 4;
  constexpr int kSamples = 120;
  if (views.size() < 2 * kSampleViews) return std::nullopt;
  std::mt19937 random(1);
  Judgement best;
  const int enough = static_cast<int>(views.size()) * 19 / 20;
  for (int sample = 0; sample < kSamples && best.num_inliers < enough; ++sample) {
    std::array<std::size_t, kSampleViews> chosen;
    for (std::size_t& index : chosen) index = random() % views.size();
    for (int pairing = 0; pairing < 1 << kSampleViews; ++pairing) {
      std::vector<Match> matches;
      for (int i = 0; i < kSampleViews; ++i)
        AddMatches(views[chosen[i]], ((pairing >> i) & 1) != 0, matches);
      Judgement judgement = Judge(EssentialOf(matches), views, tolerance);
      if (judgement.num_inliers > best.num_inliers) best = std::move(judgement);
    }
  }
  if (best.num_inliers < 2 * kSampleViews) return std::nullopt;
  Eigen::Matrix3d essential;
  for (int round = 0; round < 5; ++round) {
    essential = EssentialOf(MatchesOf(views, best));
    Judgement again = Judge(essential, views, tolerance);
    if (again.num_inliers < best.num_inliers) break;
    best = std::move(again);
  }
  RelativePose result;
  result.second_from_first = PoseOf(essential, MatchesOf(views, best));
  result.swapped = best.swapped;
  result.inlier = best.inlier;
  result.num_inliers = best.num_inliers;
  return result;
}

}  // namespace articap
