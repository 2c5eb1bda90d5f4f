// SPDX-License-Identifier: MIT
#include "rig/default_head/skin.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/check.h"
#include "rig/default_head/contours.h"
#include "rig/default_head/curve.h"
#include "rig/default_head/palette.h"

namespace articap {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Rings on the vermilion between its border and the seam.
constexpr int kVermilionRings = 5;

Vector3f Mix(const Vector3f& a, const Vector3f& b, double amount) {
  return a + static_cast<float>(std::clamp(amount, 0.0, 1.0)) * (b - a);
}

Vector3f SkinColor(const Vector2d& section_level, const Vector3d& p) {
  static const Vector3f kSkin = LinearRgb(palette::kSkin);
  static const Vector3f kBlush = LinearRgb(palette::kBlush);
  static const Vector3f kHair = LinearRgb(palette::kHair);
  static const Vector3f kDark = LinearRgb(palette::kThroat);
  double blush = 0.55 * Bell((p.x() - 40) / 13) * Bell((p.y() + 16) / 13);
  blush += 0.5 * Bell(p.x() / 10) * Bell((p.y() + 20) / 8);
  blush += 0.35 * Bell((p.x() - 33) / 12) * Bell((p.y() - 15) / 7);
  Vector3f color = Mix(kSkin, kBlush, section_level.x() < 3.5 ? blush : 0);
  // the nostril's opening
  if (p.z() > 96)
    color = Mix(color, kDark, 0.95 * Bell((p.x() - 6.0) / 2.4) * Bell((p.y() + 27.6) / 1.7));
  return Mix(color, kHair, FaceShape::HairCover(section_level));
}

// Region of a grid cell by the section and level of its middle.
Region RegionOfCell(double s, double t) {
  if (t < 3.3) return Region::kNeck;
  if (s > 4.3) return t < 6.5 ? Region::kNeck : Region::kSkull;
  if (s < 0.95 && t > 8 && t < 9.6) return Region::kNose;
  if (s < 1.0 && t > 7 && t <= 8) return Region::kUpperLip;
  // From below the corner of the mouth to the ear lobe the cheek borders on the jaw.
  const double jaw_top = 6.1 - 0.12 * s;
  if (t < jaw_top) return Region::kJaw;
  return t < 9.35 && s < 4.0 ? Region::kLeftCheek : Region::kSkull;
}

class SkinMaker {
 public:
  SkinMaker(const FaceShape& shape, HalfMesh& half) : shape_(shape), half_(half) {}

  Skin Make() {
    skin_.layout = MakeSkinLayout(shape_.base());
    skin_.mouth_rings = skin_.layout.mouth_rings;
    skin_.eye_rings = skin_.layout.eye_rings;
    skin_.border_ring = static_cast<int>(skin_.mouth_rings.size()) - 1;
    skin_.lid_ring = static_cast<int>(skin_.eye_rings.size()) - 1;
    AddLayoutVertices();
    AddGridCells();
    AddVermilion();
    AddMouthBag();
    AddLidEdge();
    AddRingCells();
    return std::move(skin_);
  }

 private:
  void AddLayoutVertices() {
    for (const Vector2d& node : skin_.layout.nodes) {
      Vector3d p = shape_.At(node);
      if (node.x() == 0 || node.x() == BaseSurface::kBackSection) p.x() = 0;
      half_.AddVertex(p, SkinColor(node, p), Part::kSkin, Carrier::kSkin);
    }
    for (const int vertex : skin_.mouth_rings[skin_.border_ring])
      half_.vertices[vertex].color =
          Mix(half_.vertices[vertex].color, LinearRgb(palette::kLips), 0.7);
    const std::vector<int>& margin = skin_.eye_rings[skin_.lid_ring];
    for (std::size_t k = 0; k < margin.size(); ++k)
      half_.vertices[margin[k]].color =
          Mix(half_.vertices[margin[k]].color, LinearRgb(palette::kLash),
              static_cast<int>(k) > skin_.layout.eye_outer ? 0.85 : 0.25);
  }

  void AddGridCells() {
    const SkinLayout& layout = skin_.layout;
    for (int row = 0; row + 1 < layout.num_rows; ++row)
      for (int column = 0; column + 1 < layout.num_columns; ++column) {
        const int a = layout.At(column, row), b = layout.At(column + 1, row);
        const int c = layout.At(column + 1, row + 1), d = layout.At(column, row + 1);
        if (a < 0 || b < 0 || c < 0 || d < 0) continue;
        const Vector2d middle = 0.25 * (layout.nodes[a] + layout.nodes[b] + layout.nodes[c] +
                                        layout.nodes[d]);
        const bool crown = row + 2 == layout.num_rows;
        const Region region = crown ? Region::kSkull : RegionOfCell(middle.x(), middle.y());
        half_.AddQuad(a, b, c, d, Part::kSkin, region);
      }
  }

  double Fraction(int k) const { return skin_.MouthFraction(k); }

  void AddVermilion() {
    static const Vector3f kLips = LinearRgb(palette::kLips);
    static const Vector3f kInside = LinearRgb(palette::kMouthInside);
    const std::vector<int> border = skin_.mouth_rings[skin_.border_ring];
    const int corner = skin_.layout.mouth_corner;
    for (int ring = 1; ring <= kVermilionRings + 1; ++ring) {
      const double u = ring / (kVermilionRings + 1.0);
      std::vector<int> vertices;
      for (int k = 0; k < skin_.num_mouth_columns(); ++k) {
        const Vector3d from = half_.position(border[k]);
        const Vector3d seam = LipSeam(Fraction(k));
        const Vector3d p = ring > kVermilionRings ? seam : LipProfile(from, seam, k, u);
        vertices.push_back(half_.AddVertex(p, Mix(kLips, kInside, (u - 0.8) * 2.0), Part::kSkin,
                                           Carrier::kSkin));
      }
      skin_.mouth_rings.push_back(std::move(vertices));
    }
    skin_.seam_ring = skin_.border_ring + kVermilionRings + 1;
    ARTICAP_CHECK_EQ(corner * 2 + 1, skin_.num_mouth_columns());
  }

  // From the border over the full lip and inwards to the seam: a cubic that leaves the skin forward
  // and arrives from the front.
  Vector3d LipProfile(const Vector3d& border, const Vector3d& seam, int k, double u) const {
    const bool upper = skin_.IsUpper(k);
    const double f = Fraction(k);
    const double full = std::pow(1 - f * f, 0.8);  // thins out towards the corner
    const double sign = upper ? 1 : -1;
    const Vector3d leave = border + full * Vector3d(0, -2.6 * sign, upper ? 2.6 : 3.6);
    const Vector3d arrive = seam + full * Vector3d(0, 1.6 * sign, upper ? 8.4 : 8.0) +
                            (1 - full) * Vector3d(0.4, 0, 0.6);
    const double v = 1 - u;
    Vector3d p = v * v * v * border + 3 * v * v * u * leave + 3 * v * u * u * arrive +
                 u * u * u * seam;
    if (f == 0) p.x() = 0;
    return p;
  }

  void AddMouthBag() {
    struct BagRing {
      double half_width, up, down, front_z, side_z, throat;
    };
    // From behind the seam round the vestibule, outside of the teeth, to the throat.
    static constexpr BagRing kRings[] = {
        {25.0, 1.2, 1.2, 96.6, 84.0, 0.0},  {26.0, 5.5, 5.0, 95.4, 81.0, 0.1},
        {28.5, 13, 11, 93.6, 76.0, 0.3},    {30.5, 18, 14, 86, 67.0, 0.5},
        {31.0, 18, 17, 70, 57.0, 0.75},     {24.0, 15, 15, 50, 46.0, 1.0}};
    for (const BagRing& bag : kRings) {
      std::vector<int> vertices;
      const Vector3f color =
          Mix(LinearRgb(palette::kMouthInside), LinearRgb(palette::kThroat), bag.throat);
      for (int k = 0; k < skin_.num_mouth_columns(); ++k) {
        const double f = Fraction(k);
        const double across = LipSeam(f).x() / LipSeam(1).x();
        const double height = std::pow(1 - std::pow(across, 2.5), 0.4);
        const double y = LipSeam(f).y() + height * (skin_.IsUpper(k) ? bag.up : -bag.down);
        const double z = bag.front_z + (bag.side_z - bag.front_z) * std::pow(across, 1.8);
        vertices.push_back(half_.AddVertex({bag.half_width * across, y, z}, color, Part::kSkin,
                                           Carrier::kSkin));
      }
      skin_.mouth_rings.push_back(std::move(vertices));
    }
    const int end = half_.AddVertex({0, face::kStomionY, 44}, LinearRgb(palette::kThroat),
                                    Part::kSkin, Carrier::kSkin);
    skin_.mouth_rings.emplace_back(skin_.num_mouth_columns(), end);
  }

  void AddLidEdge() {
    const std::vector<int> margin = skin_.eye_rings[skin_.lid_ring];
    const Vector3d center(face::kPupilX, face::kPupilY, face::kEyeZ);
    const Vector3f color = LinearRgb(palette::kCaruncle);
    std::vector<int> rim, orbit;
    for (const int vertex : margin) {
      const Vector3d p = half_.position(vertex);
      // Down to the eyeball where it is near, else merely backwards.
      Vector3d q = center + (face::kEyeRadius - 0.15) * (p - center).normalized();
      if ((p - q).norm() > 2.0) q = p + 2.0 * (q - p).normalized();
      rim.push_back(half_.AddVertex(q, Mix(half_.vertices[vertex].color, color, 0.5), Part::kSkin,
                                    Carrier::kSkin));
      const Vector3d opening(30.5, 13.8, q.z() - 1.5);
      orbit.push_back(half_.AddVertex(q + 0.22 * (opening - q), color, Part::kSkin,
                                      Carrier::kSkin));
    }
    skin_.eye_rings.push_back(std::move(rim));
    skin_.eye_rings.push_back(std::move(orbit));
    const int end = half_.AddVertex(center, color, Part::kSkin, Carrier::kSkin);
    skin_.eye_rings.emplace_back(margin.size(), end);
  }

  void AddRingCells() {
    for (std::size_t ring = 0; ring + 1 < skin_.mouth_rings.size(); ++ring)
      for (int k = 0; k + 1 < skin_.num_mouth_columns(); ++k) {
        const Region outside = skin_.IsUpper(k) ? Region::kUpperLip : Region::kLowerLip;
        const Region region =
            static_cast<int>(ring) < skin_.seam_ring ? outside : Region::kInside;
        const std::vector<int>& outer = skin_.mouth_rings[ring];
        const std::vector<int>& inner = skin_.mouth_rings[ring + 1];
        half_.AddQuad(outer[k], inner[k], inner[k + 1], outer[k + 1], Part::kSkin, region);
      }
    for (std::size_t ring = 0; ring + 1 < skin_.eye_rings.size(); ++ring) {
      const std::vector<int>& outer = skin_.eye_rings[ring];
      const std::vector<int>& inner = skin_.eye_rings[ring + 1];
      for (std::size_t k = 0; k < outer.size(); ++k) {
        const std::size_t next = (k + 1) % outer.size();
        half_.AddQuad(outer[k], outer[next], inner[next], inner[k], Part::kSkin, Region::kSkull);
      }
    }
  }

  const FaceShape& shape_;
  HalfMesh& half_;
  Skin skin_;
};

}  // namespace

double Skin::MouthFraction(int k) const {
  return 1 - std::abs(k - layout.mouth_corner) / static_cast<double>(layout.mouth_corner);
}

Skin AddSkin(const FaceShape& shape, HalfMesh& half) { return SkinMaker(shape, half).Make(); }

}  // namespace articap
