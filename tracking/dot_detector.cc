// SPDX-License-Identifier: MIT
#include "tracking/dot_detector.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/check.h"
#include "tracking/dot_blob.h"
#include "tracking/dot_fit.h"
#include "tracking/dot_options.h"
#include "tracking/dot_scan.h"
#include "tracking/pixel_reader.h"

namespace articap {
namespace {

PixelValues ValuesOf(const DotDetectorOptions& options) {
  const auto color = ParseDotColor(options.color);
  ARTICAP_CHECK(color.has_value());
  return {options.polarity == DotPolarity::kDark, options.tone == DotTone::kSrgb, *color};
}

// Of max_misfit: above kMostLeft nothing can be a dot, and above kMostHiding nothing that hides a
// part of it makes it one; below kPlain it need not be asked whether something is near, and below
// kClean nothing.
constexpr double kMostLeft = 3;
constexpr double kMostHiding = 1.5;
constexpr double kPlain = 0.8;
constexpr double kClean = 0.36;

// The pixels of an image are not always square: lengths along x and y are divided by `scale`.
DotBlobLimits LimitsOf(const DotDetectorOptions& options, const Eigen::Vector2d& scale,
                       double least_contrast) {
  // Some room, as the fit decides.
  constexpr double kRoom = 1.25;
  const auto area_px2 = [&](double diameter_px) {
    return std::numbers::pi / 4 * diameter_px * diameter_px / scale.prod();
  };
  DotBlobLimits limits;
  limits.largest_px = kRoom * options.max_diameter_px /
                      std::sqrt(std::max(0.1, options.min_roundness)) / scale.minCoeff();
  limits.least_contrast = least_contrast / kRoom;
  limits.min_roundness = options.min_roundness / kRoom * scale.minCoeff() / scale.maxCoeff();
  limits.min_area_px2 = area_px2(options.min_diameter_px / kRoom);
  limits.max_area_px2 = area_px2(options.max_diameter_px * kRoom);
  return limits;
}

DotScanOptions ScanOptionsOf(const DotDetectorOptions& options, const Eigen::Vector2d& scale,
                             const PixelNoise& noise) {
  DotScanOptions scan;
  // The smallest dot is met by two rows.
  scan.step_y = std::clamp(static_cast<int>(options.min_diameter_px / scale.y() / 2.5), 1, 8);
  // From the middle of the largest dot, beyond its edge.
  constexpr double kBeyond_px = 3;
  const auto steps = [&](double axis_scale, int step) {
    const double distance_px = (options.max_diameter_px / 2 + kBeyond_px) / axis_scale;
    return step * static_cast<int>(std::ceil(distance_px / step));
  };
  scan.distance_x = steps(scale.x(), 1);
  scan.distance_y = steps(scale.y(), scan.step_y);
  // A row may pass a small dot beside its middle, where blur has taken more than half of it.
  constexpr double kBesideMiddle = 0.4;
  scan.margin = kBesideMiddle * options.min_contrast;
  // Of four that it stands out from by chance, and of the brightest pixel of a run.
  scan.margin_sigma = options.sensitivity;
  scan.noise = noise;
  scan.most_runs = 20000 + 40 * options.most_dots;
  return scan;
}

// From where the ellipse of a fit is in the image to the picture.
Dot DotOf(const DotBlob& blob, const DotFit& fit, const PictureFromImage& picture_from_image) {
  const DotEllipse& ellipse = fit.model.ellipse;
  const Eigen::Vector2d center = ellipse.center_px.cast<double>();
  Eigen::Matrix2d to_circle;
  to_circle << ellipse.xx, ellipse.xy, 0, ellipse.yy;
  const auto scale = picture_from_image.scale.asDiagonal();
  Dot dot;
  dot.center_px = picture_from_image * (center + blob.origin_px.cast<double>());
  dot.covariance_px2 = scale * fit.covariance_px2 * scale;
  dot.shape_px2 = scale * (to_circle.transpose() * to_circle).inverse() * scale;
  dot.contrast = fit.model.contrast;
  dot.background = fit.model.background + fit.model.slope_per_px.dot(center);
  dot.misfit = fit.misfit;
  dot.saturated = blob.saturated;
  return dot;
}

// Whether the edge leaves the picture, whose size is the image's.
bool LeavesPicture(const Dot& dot, const Eigen::Vector2d& size_px) {
  const Eigen::Vector2d reach = dot.shape_px2.diagonal().cwiseSqrt();
  return ((dot.center_px - reach).array() < -0.5).any() ||
         ((dot.center_px + reach).array() > size_px.array() - 0.5).any();
}

}  // namespace

class DotDetector::Implementation {
 public:
  explicit Implementation(const DotDetectorOptions& options)
      : options_(options), reader_(ValuesOf(options)) {
    ARTICAP_CHECK(CheckOptions(options).has_value());
    for (const std::string& region : options.regions) regions_.push_back(*ParseRegion(region));
  }

  std::vector<Dot> Detect(const ImageView& image, const PictureFromImage& picture_from_image) {
    report_ = {};
    if (image.empty()) return {};
    reader_.Open(image);
    report_.noise = Noise();
    const Eigen::Vector2d scale = picture_from_image.scale;
    FindCandidates(ScanOptionsOf(options_, scale, report_.noise), picture_from_image);
    const double least_contrast = std::max(
        options_.min_contrast, options_.sensitivity * std::sqrt(report_.noise.VarianceAt(0)));
    const DotBlobLimits limits = LimitsOf(options_, scale, least_contrast);
    std::vector<Dot> dots;
    known_.Clear();
    for (const DotSeed& seed : seeds_) {
      // What it stands out from by the rows that were read may be more than what surrounds it.
      constexpr double kLeastSeen = 0.75;
      if (seed.clearest.contrast < kLeastSeen * limits.least_contrast) break;
      if (static_cast<int>(dots.size()) == options_.most_dots) {
        report_.too_many = true;
        break;
      }
      if (const auto dot = Examine(seed, limits, picture_from_image)) dots.push_back(*dot);
    }
    std::sort(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) {
      return std::pair(a.center_px.y(), a.center_px.x()) <
             std::pair(b.center_px.y(), b.center_px.x());
    });
    if (options_.polarity == DotPolarity::kDark && image.format != PixelFormat::kRgb8)
      for (Dot& dot : dots) {
        dot.contrast *= -1;
        dot.background = 1 - dot.background;
      }
    return dots;
  }

  const DotDetectorReport& report() const { return report_; }
  void set_simd_level(SimdLevel level) {
    scanner_ = DotScanner(level);
    fitter_ = DotFitter(level);
  }
  SimdLevel simd_level() const { return scanner_.level(); }

 private:
  // Of the values that dots are fitted to.
  PixelNoise Noise() {
    const double least = reader_.least_variance();
    PixelNoise noise;
    if (!options_.read_noise || !options_.noise_gain) {
      reader_.SampleNoise(noise_samples_);
      noise = noise_samples_.Estimate(least);
    }
    if (options_.read_noise)
      noise.read_variance = *options_.read_noise * *options_.read_noise + least;
    if (options_.noise_gain) noise.gain = *options_.noise_gain;
    return options_.polarity == DotPolarity::kDark ? noise.Negative() : noise;
  }

  bool IsWanted(const Eigen::Vector2d& point_px) const {
    return regions_.empty() ||
           std::any_of(regions_.begin(), regions_.end(),
                       [&](const DotRegion& region) { return region.Contains(point_px); });
  }

  // The clearest first.
  void FindCandidates(const DotScanOptions& scan, const PictureFromImage& picture_from_image) {
    report_.too_many = !scanner_.Scan(reader_, scan, runs_);
    joiner_.Join(runs_, scan.step_y, seeds_);
    const auto is_none = [&](const DotSeed& seed) {
      const Eigen::Vector2d extent =
          (seed.max_px - seed.min_px).cast<double>().cwiseProduct(picture_from_image.scale);
      const Eigen::Vector2d peak(seed.clearest.peak_x, seed.clearest.y);
      return extent.maxCoeff() > 2 * options_.max_diameter_px ||
             !IsWanted(picture_from_image * peak);
    };
    seeds_.erase(std::remove_if(seeds_.begin(), seeds_.end(), is_none), seeds_.end());
    report_.candidates = static_cast<int>(seeds_.size());
    std::stable_sort(seeds_.begin(), seeds_.end(), [](const DotSeed& a, const DotSeed& b) {
      return a.clearest.contrast > b.clearest.contrast;
    });
    // Most candidates in a face are none, and soon found to be none.
    const std::size_t most = 1000 + 10 * static_cast<std::size_t>(options_.most_dots);
    if (seeds_.size() <= most) return;
    seeds_.resize(most);
    report_.too_many = true;
  }

  std::optional<Dot> Examine(const DotSeed& seed, const DotBlobLimits& limits,
                             const PictureFromImage& picture_from_image) {
    auto blob = finder_.Find(reader_, seed, limits, report_.noise, known_, pixels_);
    if (!blob) return std::nullopt;
    known_.Add(blob->origin_px, blob->shape_px2);
    ++report_.blobs;
    bool hidden = false;
    const auto fit = Fit(*blob, hidden);
    if (fit) {
      Dot dot = DotOf(*blob, *fit, picture_from_image);
      const Eigen::Vector2d size_px =
          Eigen::Vector2d(reader_.width(), reader_.height()).cwiseProduct(picture_from_image.scale);
      dot.occluded = hidden || blob->at_border || LeavesPicture(dot, size_px);
      if (IsDot(dot)) return dot;
    }
    ++report_.refused;
    return std::nullopt;
  }

  // What a dot leaves of a fit, within its edge.
  bool Follows(const std::optional<DotFit>& fit, const DotBlob& blob, double part) const {
    return fit && fit->left <= part * options_.max_misfit && Confirms(*fit, blob);
  }

  // As if all were to be seen, evenly lit; else what explains it better: that a part is hidden,
  // that it is a ball in the light of a lamp, that the ground is uneven, or that something is near.
  std::optional<DotFit> Fit(DotBlob& blob, bool& hidden) {
    hidden = false;
    const auto even = fitter_.Fit(pixels_, blob.start, report_.noise, DotGround::kSupported,
                                  kMostLeft * options_.max_misfit);
    if (!even) return std::nullopt;
    const double clean = kClean * options_.max_misfit;
    if (Follows(even, blob, kPlain) && even->left_of_all <= clean && even->left <= clean)
      return even;
    blob.cut = finder_.FindCut(blob);
    const bool follows = Follows(even, blob, kPlain);
    // With a side cut off the even ellipse, and the shaded one too, would lie beside the middle.
    constexpr double kCutExplains = 0.5;
    if (blob.cut)
      if (const auto whole = FitWhole(blob);
          Follows(whole, blob, 1) && whole->left < kCutExplains * even->left) {
        hidden = true;
        return whole;
      }
    Eigen::Vector2d doubt_px = Eigen::Vector2d::Zero();
    if (even->left > clean) {
      const auto shaded = fitter_.FitShaded(pixels_, even->model, report_.noise);
      constexpr double kShadeExplains = 0.75;
      if (shaded && shaded->misfit < kShadeExplains * even->misfit) {
        if (Follows(shaded, blob, 1)) return shaded;
        doubt_px = DoubtOf(*even, *shaded);
      }
    }
    auto found = follows ? even : FitBeside(blob, *even, hidden);
    if (found) found->covariance_px2 += doubt_px * doubt_px.transpose();
    return found;
  }

  // How far aside the middle of a dot may be where a shade would explain it better, but hardly can
  // be.
  static Eigen::Vector2d DoubtOf(const DotFit& even, const DotFit& shaded) {
    const Eigen::Vector2d aside_px =
        (shaded.model.ellipse.center_px - even.model.ellipse.center_px).cast<double>();
    return aside_px / std::max(1.0, aside_px.norm() / RadiusOf(even.model.ellipse));
  }

  std::optional<DotFit> FitBeside(const DotBlob& blob, const DotFit& even, bool& hidden) {
    if (auto near = FitNear(blob); Follows(near, blob, 1)) return near;
    if (auto robust = FitHidden(blob, even, hidden)) return robust;
    return Follows(even, blob, 1) ? std::optional(even) : std::nullopt;
  }

  // Without what is not the dot's.
  std::optional<DotFit> FitHidden(const DotBlob& blob, const DotFit& even, bool& hidden) {
    if (even.left > kMostHiding * options_.max_misfit) return std::nullopt;
    constexpr double kScale = 0.15;  // of the robust loss, part of the contrast
    constexpr double kWidening = 6, kLeastHidden = 0.05, kMostHidden = 0.25;
    auto robust = fitter_.FitRobustly(pixels_, even.model, report_.noise, kScale, kWidening);
    if (!Follows(robust, blob, kPlain) || robust->disbelieved >= kMostHidden) return std::nullopt;
    hidden = robust->disbelieved > kLeastHidden;
    return robust;
  }

  // To the ground near the edge alone, where it is more even.
  std::optional<DotFit> FitNear(const DotBlob& blob) {
    constexpr double kNear_px = 2;
    const Eigen::Matrix2d shape = Grown(blob.shape_px2, kNear_px);
    rest_.CopyWithin(pixels_, blob.start.ellipse.center_px, shape.inverse().cast<float>());
    return fitter_.Fit(rest_, blob.start, report_.noise, DotGround::kUneven);
  }

  // The disc that the blob may be the rest of.
  std::optional<DotFit> FitWhole(const DotBlob& blob) {
    DotModel start = blob.start;
    start.ellipse = blob.cut->whole;
    rest_.CopyBefore(pixels_, blob.cut->direction, blob.cut->limit_px);
    auto whole = fitter_.Fit(rest_, start, report_.noise);
    if (!whole) return std::nullopt;
    // What is there says enough of what is not: its area, and the middle to a part of the radius.
    constexpr double kLeastThere = 0.4, kMostUncertain = 0.2;
    const double radius_px = RadiusOf(whole->model.ellipse);
    if (std::sqrt(blob.shape_px2.determinant()) < kLeastThere * radius_px * radius_px ||
        std::sqrt(whole->covariance_px2.trace() / 2) > kMostUncertain * radius_px)
      return std::nullopt;
    return whole;
  }

  // Whether the fit is one of what was seen: where the edge is not round, contrast and blur may
  // replace one another, and where the ground is not even, the dot may spread over it.
  bool Confirms(const DotFit& fit, const DotBlob& blob) const {
    const DotModel& model = fit.model;
    const double part = model.contrast / blob.start.contrast;
    const double seen_px = std::pow(blob.shape_px2.determinant(), 0.25);
    const bool is_ball = IsBall(model);
    return part > (is_ball ? 0.4 : 0.7) && part < (blob.saturated ? 5 : 1.5) &&
           model.ellipse.blur_px <= std::min(options_.max_blur_px, LargestBlur(seen_px) + 0.5) &&
           (blob.cut || IsThere(model.ellipse, blob, is_ball ? 2.2 : 1.2, is_ball ? 1.2 : 0.25)) &&
           HasEdgeAllAround(model);
  }

  static double RadiusOf(const DotEllipse& ellipse) {
    return 1 / std::sqrt(ellipse.xx * ellipse.yy);
  }

  // Of a ball what is seen first is the part that the lamp shines on.
  static bool IsBall(const DotModel& model) {
    constexpr double kLeastShade = 0.5;
    return model.shade.norm() > kLeastShade * model.contrast;
  }

  // growth, move: in radii of what was seen.
  static bool IsThere(const DotEllipse& ellipse, const DotBlob& blob, double growth, double move) {
    constexpr double kRoom_px = 0.3;
    const double radius_px = std::pow(blob.shape_px2.determinant(), 0.25);
    return RadiusOf(ellipse) <= growth * radius_px + kRoom_px &&
           (ellipse.center_px - blob.start.ellipse.center_px).norm() <= move * radius_px + kRoom_px;
  }

  // The dark side of a ball may be as dark as the ground; but with few pixels a shade that takes
  // the edge away turns glints into dots.
  static bool HasEdgeAllAround(const DotModel& model) {
    constexpr double kLeastAtEdge = 0.1, kLeastOfLarge = -0.7, kLarge_px = 3.5;
    const double at_edge =
        model.contrast - model.shade.head<2>().norm() - 2.0 / 3 * model.shade.z();
    const double least = RadiusOf(model.ellipse) < kLarge_px ? kLeastAtEdge : kLeastOfLarge;
    return at_edge >= least * model.contrast;
  }

  bool IsDot(const Dot& dot) const {
    const double diameter_px = dot.diameter_px();
    const double noise = std::sqrt(report_.noise.VarianceAt(dot.background));
    return diameter_px >= options_.min_diameter_px && diameter_px <= options_.max_diameter_px &&
           dot.roundness() >= options_.min_roundness && dot.contrast >= options_.min_contrast &&
           dot.contrast >= options_.sensitivity * noise && IsWanted(dot.center_px);
  }

  DotDetectorOptions options_;
  std::vector<DotRegion> regions_;
  PixelReader reader_;
  NoiseSamples noise_samples_;
  DotScanner scanner_;
  RunJoiner joiner_;
  DotBlobFinder finder_;
  DotPixels pixels_;
  DotPixels rest_;  // of a dot that is hidden in part
  DotFitter fitter_;
  std::vector<DotRun> runs_;
  std::vector<DotSeed> seeds_;
  KnownBlobs known_;
  DotDetectorReport report_;
};

DotDetector::DotDetector(const DotDetectorOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}
DotDetector::~DotDetector() = default;
DotDetector::DotDetector(DotDetector&&) noexcept = default;
DotDetector& DotDetector::operator=(DotDetector&&) noexcept = default;

std::vector<Dot> DotDetector::Detect(const ImageView& image,
                                     const PictureFromImage& picture_from_image) {
  return implementation_->Detect(image, picture_from_image);
}

const DotDetectorReport& DotDetector::report() const { return implementation_->report(); }
void DotDetector::set_simd_level(SimdLevel level) { implementation_->set_simd_level(level); }
SimdLevel DotDetector::simd_level() const { return implementation_->simd_level(); }

}  // namespace articap
