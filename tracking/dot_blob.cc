// SPDX-License-Identifier: MIT
#include "tracking/dot_blob.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace articap {
namespace {

// A start for the fit; lenses and pixels together blur by about this.
constexpr double kUsualBlur_px = 0.75;
// What the edge reaches outwards.
constexpr double kEdge_px = 2.5;

double RoundnessOf(const Eigen::Matrix2d& shape) {
  const double mean = shape.trace() / 2;
  const double apart = std::sqrt(std::max(0.0, mean * mean - shape.determinant()));
  return std::sqrt(std::max(0.0, mean - apart) / (mean + apart));
}

float ShortestOf(const Eigen::Matrix2d& shape) {
  const double mean = shape.trace() / 2;
  const double apart = std::sqrt(std::max(0.0, mean * mean - shape.determinant()));
  return static_cast<float>(std::sqrt(std::max(0.0, mean - apart)));
}

// How much plain surface around a dot is fitted with it: for its level, and its slope.
double MarginOf(double radius_px) {
  return std::max(3.0, 0.35 * radius_px) + kEdge_px * kUsualBlur_px;
}

DotEllipse EllipseOf(const Eigen::Vector2d& center_px, const Eigen::Matrix2d& shape_px2) {
  const Eigen::Matrix2d inverse = shape_px2.inverse();
  const double xx = std::sqrt(inverse(0, 0)), xy = inverse(0, 1) / xx;
  const double yy = std::sqrt(inverse(1, 1) - xy * xy);
  return {center_px.cast<float>(), static_cast<float>(xx), static_cast<float>(xy),
          static_cast<float>(yy), static_cast<float>(kUsualBlur_px)};
}

// The pixels of each row that are within an ellipse.
class EllipseRows {
 public:
  struct Range {
    int begin = 0, end = 0;
  };

  EllipseRows(const Eigen::Vector2d& center_px, const Eigen::Matrix2d& shape_px2)
      : center_(center_px),
        height2_(shape_px2(1, 1)),
        lean_(shape_px2(0, 1) / shape_px2(1, 1)),
        width2_(shape_px2.determinant() / shape_px2(1, 1)) {}

  // Of row y, within a range that is not empty.
  Range At(int y, int begin, int end) const {
    const double dy = y - center_.y();
    const double part = 1 - dy * dy / height2_;
    const double middle = center_.x() + lean_ * dy;
    const double half = part > 0 ? std::sqrt(width2_ * part) : -1;
    begin = std::clamp(static_cast<int>(std::ceil(middle - half)), begin, end);
    return {begin, std::clamp(static_cast<int>(std::floor(middle + half)) + 1, begin, end)};
  }

 private:
  Eigen::Vector2d center_;
  double height2_, lean_, width2_;
};

}  // namespace

Eigen::Matrix2d Grown(const Eigen::Matrix2d& shape_px2, double by_px) {
  const double radius_px = std::pow(shape_px2.determinant(), 0.25);
  return shape_px2 + by_px * (2 * radius_px + by_px) * Eigen::Matrix2d::Identity();
}

double LargestBlur(double radius_px) { return 0.8 + 0.3 * radius_px; }

int RunJoiner::RootOf(int run) {
  while (parents_[run] != run) run = parents_[run] = parents_[parents_[run]];
  return run;
}

void RunJoiner::Join(const std::vector<DotRun>& runs, int step_y, std::vector<DotSeed>& seeds) {
  const int count = static_cast<int>(runs.size());
  parents_.resize(count);
  std::iota(parents_.begin(), parents_.end(), 0);
  int above = 0;  // the first run of the row before that may still touch
  for (int i = 0; i < count; ++i) {
    const DotRun& run = runs[i];
    while (above < i && (runs[above].y < run.y - step_y ||
                         (runs[above].y == run.y - step_y && runs[above].end_x < run.begin_x)))
      ++above;
    for (int j = above; j < i && runs[j].y == run.y - step_y && runs[j].begin_x <= run.end_x; ++j) {
      const float larger = std::max(runs[j].contrast, run.contrast);
      if (runs[j].contrast < larger / 2 || run.contrast < larger / 2) continue;
      const int first = RootOf(j), second = RootOf(i);
      parents_[std::max(first, second)] = std::min(first, second);
    }
  }
  seeds.clear();
  seed_of_root_.assign(count, -1);
  for (int i = 0; i < count; ++i) {
    const DotRun& run = runs[i];
    int& index = seed_of_root_[RootOf(i)];
    if (index < 0) {
      index = static_cast<int>(seeds.size());
      seeds.push_back({{run.begin_x, run.y}, {run.end_x - 1, run.y}, run});
    }
    DotSeed& seed = seeds[index];
    seed.min_px = seed.min_px.cwiseMin(Eigen::Vector2i(run.begin_x, run.y));
    seed.max_px = seed.max_px.cwiseMax(Eigen::Vector2i(run.end_x - 1, run.y));
    if (run.contrast > seed.clearest.contrast) seed.clearest = run;
  }
}

void KnownBlobs::Add(const Eigen::Vector2i& middle_px, const Eigen::Matrix2d& shape_px2) {
  blobs_.push_back({middle_px.cast<float>(), shape_px2.inverse().cast<float>()});
}

bool KnownBlobs::Contains(const Eigen::Vector2i& point_px) const {
  const Eigen::Vector2f point = point_px.cast<float>();
  return std::any_of(blobs_.begin(), blobs_.end(), [&](const Blob& blob) {
    const Eigen::Vector2f away = point - blob.middle_px;
    return away.dot(blob.inverse_shape * away) <= 1;
  });
}

std::optional<DotBlob> DotBlobFinder::Find(const PixelReader& reader, const DotSeed& seed,
                                           const DotBlobLimits& limits, const PixelNoise& noise,
                                           const KnownBlobs& known, DotPixels& pixels) {
  const Eigen::Vector2i peak(seed.clearest.peak_x, seed.clearest.y);
  if (known.Contains(peak)) return std::nullopt;
  Eigen::Vector2i middle = peak;
  if (auto blob = FindAbove(reader, seed, limits, noise, known, {}, middle, pixels)) return blob;
  if (known.Contains(middle)) return std::nullopt;
  middle = peak;
  return FindAbove(reader, seed, limits, noise, known, {0.75, 0.6, 0.9, 1.028}, middle, pixels);
}

std::optional<DotBlob> DotBlobFinder::FindAbove(const PixelReader& reader, const DotSeed& seed,
                                                const DotBlobLimits& limits,
                                                const PixelNoise& noise, const KnownBlobs& known,
                                                const Heights& heights, Eigen::Vector2i& middle,
                                                DotPixels& pixels) {
  double threshold = seed.clearest.surround + heights.border * seed.clearest.contrast;
  const auto reach_px = FindReach(reader, threshold, limits, middle);
  if (!reach_px || known.Contains(middle)) return std::nullopt;
  ReadPatch(reader, middle, static_cast<int>(std::ceil(*reach_px + MarginOf(*reach_px) + 2)));
  DotBlob blob;
  blob.start.background = MedianBeyond(middle, *reach_px + kEdge_px);
  const double light = reader.Value(middle.x(), middle.y()) - blob.start.background;
  threshold = blob.start.background + heights.border * light;
  if (!Grow(reader, middle, threshold)) return std::nullopt;
  const Moments moments = MeasureInside();
  if (moments.area_px2 < limits.min_area_px2 || moments.area_px2 > limits.max_area_px2)
    return std::nullopt;
  if (!IsEllipse(moments)) return std::nullopt;
  // The variance of an ellipse's points is a quarter of its semi-axes' squares.
  const double filled_px2 =
      4 * std::numbers::pi * std::sqrt(std::max(0.0, moments.covariance_px2.determinant()));
  constexpr double kLeastFilled = 0.8;
  if (moments.area_px2 < kLeastFilled * filled_px2) return std::nullopt;
  if (RoundnessOf(moments.covariance_px2) < limits.min_roundness) return std::nullopt;
  if (!HasEdge(moments, blob.start.background, light, heights)) return std::nullopt;
  blob.shape_px2 = 4 * (moments.area_px2 / filled_px2) * moments.covariance_px2;
  blob.origin_px = moments.mean_px.array().round().matrix().cast<int>();
  if (known.Contains(blob.origin_px)) return std::nullopt;
  const Eigen::Vector2d center = WeightedCenter(moments, blob.start.background);
  blob.start.ellipse = EllipseOf(center - blob.origin_px.cast<double>(), blob.shape_px2);
  // The edge's pixels, half of which are of the spot, are darker.
  constexpr double kEdgesShare = 1.1;
  blob.start.contrast = kEdgesShare * (moments.mean_value - blob.start.background);
  if (blob.start.contrast < limits.least_contrast) return std::nullopt;
  found_ = moments;
  GatherPixels(reader, blob, noise, pixels);
  MarkBorders(reader, blob);
  return blob;
}

std::optional<double> DotBlobFinder::FindReach(const PixelReader& reader, double threshold,
                                               const DotBlobLimits& limits,
                                               Eigen::Vector2i& middle) {
  const Eigen::Vector2i size(reader.width(), reader.height());
  const int most = static_cast<int>(limits.largest_px) + 2;
  const auto is_above = [&](const Eigen::Vector2i& at) {
    return (at.array() >= 0).all() && (at.array() < size.array()).all() &&
           reader.Value(at.x(), at.y()) > threshold;
  };
  if (!is_above(middle)) return std::nullopt;
  for (int pass = 0; pass < 2; ++pass)
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Vector2i low = middle, high = middle;
      const Eigen::Vector2i step = Eigen::Vector2i::Unit(axis);
      while (high[axis] - low[axis] <= most && is_above(low - step)) low -= step;
      while (high[axis] - low[axis] <= most && is_above(high + step)) high += step;
      if (high[axis] - low[axis] > most) return std::nullopt;
      middle[axis] = (low[axis] + high[axis]) / 2;
    }
  SetWaysOut(most + 1);
  double shortest = most, longest = 0;
  for (int direction = 0; direction < kDirections; ++direction) {
    const Eigen::Vector2i* const way = &ways_out_[direction * (most + 1)];
    int forth = 0, back = 0;
    while (forth <= most && is_above(middle + way[forth])) ++forth;
    while (back <= most && is_above(middle - way[back])) ++back;
    const int across = forth + back + 1;
    // A part of the dot may be hidden.
    if (std::abs(forth - back) > 2 + 0.3 * across || across > most) return std::nullopt;
    shortest = std::min<double>(shortest, across);
    longest = std::max<double>(longest, across);
    if (shortest + 1 < limits.min_roundness * (longest - 1)) return std::nullopt;
  }
  return longest / 2;
}

void DotBlobFinder::SetWaysOut(int length) {
  if (ways_out_.size() == static_cast<std::size_t>(length) * kDirections) return;
  ways_out_.clear();
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    for (int step = 1; step <= length; ++step)
      ways_out_.push_back((step * direction).array().round().matrix().cast<int>());
  }
}

void DotBlobFinder::ReadPatch(const PixelReader& reader, const Eigen::Vector2i& middle, int reach) {
  patch_.left = std::max(0, middle.x() - reach);
  patch_.top = std::max(0, middle.y() - reach);
  patch_.width = std::min(reader.width(), middle.x() + reach + 1) - patch_.left;
  patch_.height = std::min(reader.height(), middle.y() + reach + 1) - patch_.top;
  patch_.values.resize(static_cast<std::size_t>(patch_.width) * patch_.height);
  for (int y = 0; y < patch_.height; ++y)
    reader.ReadValues(patch_.left, patch_.top + y, patch_.width,
                      &patch_.values[static_cast<std::size_t>(y) * patch_.width]);
}

bool DotBlobFinder::Grow(const PixelReader& reader, const Eigen::Vector2i& from, double threshold) {
  const int right = patch_.left + patch_.width - 1, bottom = patch_.top + patch_.height - 1;
  patch_.inside.assign(patch_.values.size(), 0);
  patch_.begin = {patch_.width, patch_.height};
  patch_.end = {0, 0};
  open_.clear();
  const auto try_at = [&](int x, int y) {
    const int index = patch_.Index(x, y);
    if (patch_.inside[index] != 0 || !(patch_.values[index] > threshold)) return;
    patch_.inside[index] = 1;
    const Eigen::Vector2i at(x - patch_.left, y - patch_.top);
    patch_.begin = patch_.begin.cwiseMin(at);
    patch_.end = patch_.end.cwiseMax(at + Eigen::Vector2i::Ones());
    open_.emplace_back(x, y);
  };
  try_at(from.x(), from.y());
  while (!open_.empty()) {
    const Eigen::Vector2i at = open_.back();
    open_.pop_back();
    if (at.x() > patch_.left) try_at(at.x() - 1, at.y());
    if (at.x() < right) try_at(at.x() + 1, at.y());
    if (at.y() > patch_.top) try_at(at.x(), at.y() - 1);
    if (at.y() < bottom) try_at(at.x(), at.y() + 1);
    const bool leaves_patch = (at.x() == patch_.left && at.x() > 0) ||
                              (at.y() == patch_.top && at.y() > 0) ||
                              (at.x() == right && at.x() < reader.width() - 1) ||
                              (at.y() == bottom && at.y() < reader.height() - 1);
    if (leaves_patch) return false;
  }
  return true;
}

DotBlobFinder::Moments DotBlobFinder::MeasureInside() const {
  // Places are whole numbers: exact.
  long count = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0, sum_yy = 0;
  double values = 0;
  for (int y = patch_.begin.y(); y < patch_.end.y(); ++y) {
    long in_row = 0, row_x = 0;
    for (int x = patch_.begin.x(); x < patch_.end.x(); ++x) {
      const int index = y * patch_.width + x;
      const long inside = patch_.inside[index];
      if (inside != 0) values += patch_.values[index];
      in_row += inside;
      row_x += inside * x;
      sum_xx += inside * x * x;
    }
    count += in_row;
    sum_x += row_x;
    sum_y += in_row * y;
    sum_xy += row_x * y;
    sum_yy += in_row * y * y;
  }
  if (count == 0) return {};
  const auto total = static_cast<double>(count);
  const auto part = [&](long sum) { return static_cast<double>(sum) / total; };
  const Eigen::Vector2d mean(part(sum_x), part(sum_y));
  Eigen::Matrix2d squares;
  squares << part(sum_xx), part(sum_xy), part(sum_xy), part(sum_yy);
  return {total, mean + Eigen::Vector2d(patch_.left, patch_.top),
          squares - mean * mean.transpose() + Eigen::Matrix2d::Identity() / 12, values / total};
}

void DotBlobFinder::MarkBorders(const PixelReader& reader, DotBlob& blob) const {
  const Eigen::Vector2i corner(patch_.left, patch_.top);
  const Eigen::Vector2i begin = corner + patch_.begin, end = corner + patch_.end;
  blob.at_border =
      begin.x() == 0 || begin.y() == 0 || end.x() == reader.width() || end.y() == reader.height();
  for (int y = begin.y(); y < end.y(); ++y)
    for (int x = begin.x(); x < end.x(); ++x) {
      const int index = patch_.Index(x, y);
      if (patch_.inside[index] != 0 && reader.IsSaturated(x, y, patch_.values[index])) {
        blob.saturated = true;
        return;
      }
    }
}

template <class Use>
void DotBlobFinder::ForEachPixel(const Moments& moments, const Use& use) const {
  const Eigen::Matrix2f inverse = (4 * moments.covariance_px2).inverse().cast<float>();
  const auto mean_x = static_cast<float>(moments.mean_px.x() - patch_.left);
  const auto mean_y = static_cast<float>(moments.mean_px.y() - patch_.top);
  // Edges, and some more, around what is inside.
  constexpr int kAround = static_cast<int>(2 * kEdge_px) + 1;
  const int left = std::max(0, patch_.begin.x() - kAround);
  const int right = std::min(patch_.width, patch_.end.x() + kAround);
  const int bottom = std::min(patch_.height, patch_.end.y() + kAround);
  for (int y = std::max(0, patch_.begin.y() - kAround); y < bottom; ++y) {
    const float dy = static_cast<float>(y) - mean_y;
    int index = y * patch_.width + left;
    for (int x = left; x < right; ++x, ++index) {
      const float dx = static_cast<float>(x) - mean_x;
      use(index, dx, dy,
          inverse(0, 0) * dx * dx + 2 * inverse(0, 1) * dx * dy + inverse(1, 1) * dy * dy);
    }
  }
}

bool DotBlobFinder::IsEllipse(const Moments& moments) const {
  constexpr float kTolerance_px = 0.8f;  // pixels on the edge may fall to either side
  const float shortest_px = ShortestOf(4 * moments.covariance_px2);
  const float inner = std::max(0.0f, 1 - kTolerance_px / shortest_px);
  const float outer = 1 + kTolerance_px / shortest_px;
  int wrong = 0;
  ForEachPixel(moments, [&](int index, float, float, float f2) {
    wrong += patch_.inside[index] != 0 ? f2 > outer * outer : f2 < inner * inner;
  });
  constexpr double kMostWrong = 0.06;
  return wrong <= kMostWrong * moments.area_px2;
}

double DotBlobFinder::MedianBeyond(const Eigen::Vector2i& middle, double radius_px) {
  outside_.clear();
  const auto radius2 = static_cast<int>(radius_px * radius_px);
  // Every fifth pixel, of other columns from row to row, tells enough.
  for (int y = 0; y < patch_.height; ++y)
    for (int x = 2 * y % 5; x < patch_.width; x += 5) {
      const int dx = x + patch_.left - middle.x(), dy = y + patch_.top - middle.y();
      if (dx * dx + dy * dy > radius2) outside_.push_back(patch_.values[y * patch_.width + x]);
    }
  if (outside_.empty()) return 0;
  const auto middle_value = outside_.begin() + static_cast<std::ptrdiff_t>(outside_.size() / 2);
  std::nth_element(outside_.begin(), middle_value, outside_.end());
  return *middle_value;
}

bool DotBlobFinder::HasEdge(const Moments& moments, double background, double light,
                            const Heights& heights) const {
  const float within =
      1 + static_cast<float>(2 * kEdge_px) / ShortestOf(4 * moments.covariance_px2);
  const auto low = static_cast<float>(background + heights.low * light);
  const auto high = static_cast<float>(background + heights.high * light);
  int above_low = 0, above_high = 0;
  ForEachPixel(moments, [&](int index, float, float, float f2) {
    const float value = patch_.values[index];
    if (value <= low || f2 > within * within) return;
    ++above_low;
    above_high += value > high;
  });
  const double blur_px = (std::sqrt(above_low) - std::sqrt(above_high)) /
                         std::sqrt(std::numbers::pi) / heights.apart_sigma;
  return blur_px <= LargestBlur(std::sqrt(moments.area_px2 / std::numbers::pi));
}

std::optional<DotBlob::Cut> DotBlobFinder::FindCut(const DotBlob& blob) const {
  const Moments& moments = found_;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(moments.covariance_px2);
  const Eigen::Vector2f deviation = axes.eigenvalues().cwiseSqrt().cast<float>();
  const Eigen::Matrix2f directions = axes.eigenvectors().cast<float>();
  Eigen::Vector2f least = Eigen::Vector2f::Zero(), most = least;
  // Moments of the light, which tells parts of pixels too.
  const float within = 1 + 2 / ShortestOf(4 * moments.covariance_px2);
  const auto dark = static_cast<float>(blob.start.background);
  const auto full = static_cast<float>(1 / blob.start.contrast);
  float sum = 0;
  Eigen::Array2f first = Eigen::Array2f::Zero(), second = first, third = first;
  ForEachPixel(moments, [&](int index, float dx, float dy, float f2) {
    if (f2 > within * within) return;
    const Eigen::Vector2f at = directions.transpose() * Eigen::Vector2f(dx, dy);
    const float light = std::clamp((patch_.values[index] - dark) * full, 0.0f, 1.0f);
    const Eigen::Array2f by = light * at.array();
    sum += light;
    first += by;
    second += by * at.array();
    third += by * at.array().square();
    if (patch_.inside[index] == 0) return;
    least = least.cwiseMin(at);
    most = most.cwiseMax(at);
  });
  first /= sum;
  second /= sum;
  const Eigen::Array2f variance = second - first.square();
  const Eigen::Array2f skewness =
      (third / sum - 3 * first * second + 2 * first.cube()) / (variance * variance.sqrt());
  // The shorter axis is the one that something was taken from. With a tenth cut off there is 0.1.
  constexpr float kCut = 0.06f;
  if (std::abs(skewness[0]) < kCut || std::abs(skewness[0]) < std::abs(skewness[1]))
    return std::nullopt;
  // The light thins out towards the side that is there.
  const float towards = skewness[0] < 0 ? 1 : -1;
  const float there = towards > 0 ? -least[0] : most[0], gone = towards > 0 ? most[0] : -least[0];
  DotBlob::Cut cut;
  cut.direction = towards * directions.col(0);
  const Eigen::Vector2f mean = (moments.mean_px - blob.origin_px.cast<double>()).cast<float>();
  const float radius = 2 * deviation[1];
  cut.whole = EllipseOf((mean + (radius - there - 0.5f) * cut.direction).cast<double>(),
                        Eigen::Matrix2d(radius * radius * Eigen::Matrix2d::Identity()));
  // Without the edge of what hides.
  cut.limit_px = cut.direction.dot(mean) + gone - 1.5f;
  return cut;
}

Eigen::Vector2d DotBlobFinder::WeightedCenter(const Moments& moments, double background) const {
  const float within = 1 + 1 / ShortestOf(4 * moments.covariance_px2);
  const auto dark = static_cast<float>(background);
  float weights = 0, sum_x = 0, sum_y = 0;
  ForEachPixel(moments, [&](int index, float dx, float dy, float f2) {
    const float light = patch_.values[index] - dark;
    if (light <= 0 || f2 > within * within) return;
    const float weight = light * std::sqrt(light);
    weights += weight;
    sum_x += weight * dx;
    sum_y += weight * dy;
  });
  if (weights <= 0) return moments.mean_px;
  return moments.mean_px + Eigen::Vector2d(sum_x / weights, sum_y / weights);
}

void DotBlobFinder::GatherPixels(const PixelReader& reader, const DotBlob& blob,
                                 const PixelNoise& noise, DotPixels& pixels) const {
  const double radius_px = std::pow(blob.shape_px2.determinant(), 0.25);
  const Eigen::Vector2d center = blob.start.ellipse.center_px.cast<double>();
  const EllipseRows window(center, Grown(blob.shape_px2, MarginOf(radius_px)));
  const EllipseRows own(center, Grown(blob.shape_px2, kEdge_px));
  // A slope of light stays below this, other things do not.
  const auto background = static_cast<float>(blob.start.background);
  const auto foreign = static_cast<float>(
      std::max(6 * std::sqrt(noise.VarianceAt(background)), 0.3 * blob.start.contrast));
  const int left = patch_.left - blob.origin_px.x(), top = patch_.top - blob.origin_px.y();
  pixels.Start(patch_.width * patch_.height);
  for (int row = 0; row < patch_.height; ++row) {
    const int y = row + top;
    const auto all = window.At(y, left, left + patch_.width);
    const auto dot = own.At(y, all.begin, all.end);
    const float* const values = &patch_.values[row * patch_.width] - left;
    const auto add = [&](int x) {
      pixels.Add(static_cast<float>(x), static_cast<float>(y), values[x],
                 reader.IsSaturated(x + blob.origin_px.x(), y + blob.origin_px.y(), values[x]));
    };
    // Of the ground every second pixel tells enough.
    const auto add_ground = [&](int begin, int end) {
      const int odd = (begin + y + blob.origin_px.sum()) & 1;
      for (int x = begin + odd; x < end; x += 2)
        if (std::abs(values[x] - background) <= foreign) add(x);
    };
    add_ground(all.begin, dot.begin);
    for (int x = dot.begin; x < dot.end; ++x) add(x);
    add_ground(dot.end, all.end);
  }
  pixels.Finish();
}

}  // namespace articap
