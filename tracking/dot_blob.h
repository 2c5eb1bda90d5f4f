// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tracking/dot_fit.h"
#include "tracking/dot_scan.h"
#include "tracking/pixel_reader.h"

namespace articap {

// Runs that belong together: of one place that stands out.
struct DotSeed {
  Eigen::Vector2i min_px = Eigen::Vector2i::Zero();  // the box around them, inclusive
  Eigen::Vector2i max_px = Eigen::Vector2i::Zero();
  DotRun clearest;  // of its runs
};

// Joins runs of successive rows (step_y apart) that overlap and whose contrasts differ by less than
// a factor of two (union-find). In the order of their first runs.
class RunJoiner {
 public:
  void Join(const std::vector<DotRun>& runs, int step_y, std::vector<DotSeed>& seeds);

 private:
  int RootOf(int run);

  std::vector<int> parents_, seed_of_root_;
};

// What a dot may look like, in pixels of the image.
struct DotBlobLimits {
  double largest_px = 40;  // extent along x or y
  double least_contrast = 0.05;
  double min_roundness = 0.4;
  double min_area_px2 = 10;
  double max_area_px2 = 1300;
};

// The blobs of a picture that have been looked at: one dot often has several seeds.
class KnownBlobs {
 public:
  void Clear() { blobs_.clear(); }
  void Add(const Eigen::Vector2i& middle_px, const Eigen::Matrix2d& shape_px2);
  bool Contains(const Eigen::Vector2i& point_px) const;

 private:
  struct Blob {
    Eigen::Vector2f middle_px;
    Eigen::Matrix2f inverse_shape;
  };
  std::vector<Blob> blobs_;
};

// The most that a dot of this radius may be blurred by, SD. Bumps of light, which have no edge,
// come out with 0.38 (a paraboloid) to 0.57 (a Gaussian) of their radius at half height.
double LargestBlur(double radius_px);

// The ellipse with its border moved outwards; exact for circles.
Eigen::Matrix2d Grown(const Eigen::Matrix2d& shape_px2, double by_px);

// The pixels of a dot, with what can be said of it before it is fitted. The origin of coordinates
// is the middle of the pixel at `origin_px`.
struct DotBlob {
  Eigen::Vector2i origin_px = Eigen::Vector2i::Zero();
  DotModel start;
  Eigen::Matrix2d shape_px2 = Eigen::Matrix2d::Identity();
  bool saturated = false;
  bool at_border = false;  // of the picture
  // Where one side is cut off: the disc that this may be the rest of, and how far along the
  // direction towards that side the pixels are still the disc's.
  struct Cut {
    DotEllipse whole;
    Eigen::Vector2f direction = Eigen::Vector2f::UnitX();
    float limit_px = 0;
  };
  std::optional<Cut> cut;
};

// Gathers the pixels around a seed that are above half of the way from what surrounds it to what it
// has, and measures them; where these are no round spot, as the ground is half as bright on one
// side, those above three quarters. Keeps its scratch.
class DotBlobFinder {
 public:
  // Nothing where this is no round spot, or one that is known. What the fit needs is put into
  // `pixels`: the spot and a margin around it, without what else is there.
  std::optional<DotBlob> Find(const PixelReader& reader, const DotSeed& seed,
                              const DotBlobLimits& limits, const PixelNoise& noise,
                              const KnownBlobs& known, DotPixels& pixels);

  // Of the blob that was found last. Of an ellipse the third moments are zero; of one with a side
  // cut off they point away from it.
  std::optional<DotBlob::Cut> FindCut(const DotBlob& blob) const;

 private:
  // Parts of the way from what surrounds a dot to what it has.
  struct Heights {
    double border = 0.5;  // of what is the spot
    double low = 0.25;    // between these an edge is as wide as
    double high = 0.75;
    double apart_sigma = 1.349;  // so many SD of its blur
  };

  // From `middle`, which is moved to the middle of what is found, also where this is no dot.
  std::optional<DotBlob> FindAbove(const PixelReader& reader, const DotSeed& seed,
                                   const DotBlobLimits& limits, const PixelNoise& noise,
                                   const KnownBlobs& known, const Heights& heights,
                                   Eigen::Vector2i& middle, DotPixels& pixels);
  // A window of the picture, its values, and whether each pixel is of the spot.
  struct Patch {
    int left = 0, top = 0, width = 0, height = 0;
    std::vector<float> values;
    std::vector<std::uint8_t> inside;
    Eigen::Vector2i begin, end;  // the box around these, from the patch's corner; the end excluded

    int Index(int x, int y) const { return (y - top) * width + x - left; }
  };
  struct Moments {
    double area_px2 = 0;
    Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();  // in the picture
    Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
    double mean_value = 0;
  };

  // Goes to the middle of the row and the column that the seed is in, and from there outwards in
  // sixteen directions. Returns how far it is to the last pixel above the threshold, at most;
  // nothing where that differs too much from direction to direction for a dot. Most candidates are
  // none, and end here.
  std::optional<double> FindReach(const PixelReader& reader, double threshold,
                                  const DotBlobLimits& limits, Eigen::Vector2i& middle);
  void SetWaysOut(int length);
  void ReadPatch(const PixelReader& reader, const Eigen::Vector2i& middle, int reach);
  // Marks what hangs together with a pixel above the threshold. False where it reaches the patch's
  // border within the picture.
  bool Grow(const PixelReader& reader, const Eigen::Vector2i& from, double threshold);
  Moments MeasureInside() const;
  // Whether what is inside touches the picture's border, and whether some of it is saturated.
  void MarkBorders(const PixelReader& reader, DotBlob& blob) const;
  // Whether the pixels inside are those of an ellipse.
  bool IsEllipse(const Moments& moments) const;
  // Of the patch without a disc.
  double MedianBeyond(const Eigen::Vector2i& middle, double radius_px);
  // use(index, dx, dy, f2): away from the mean, and f2 = 1 on the ellipse that the moments tell.
  template <class Use>
  void ForEachPixel(const Moments& moments, const Use& use) const;
  // Whether the spot ends as a dot does, from the areas above two heights.
  bool HasEdge(const Moments& moments, double background, double light,
               const Heights& heights) const;
  Eigen::Vector2d WeightedCenter(const Moments& moments, double background) const;
  void GatherPixels(const PixelReader& reader, const DotBlob& blob, const PixelNoise& noise,
                    DotPixels& pixels) const;

  static constexpr int kDirections = 8;

  Patch patch_;
  Moments found_;  // of the last blob
  // The pixels on the way outwards in eight directions, which with their opposites go all around.
  std::vector<Eigen::Vector2i> ways_out_;
  std::vector<Eigen::Vector2i> open_;
  std::vector<float> outside_;
};

}  // namespace articap
