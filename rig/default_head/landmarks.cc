// SPDX-License-Identifier: MIT
#include "rig/default_head/landmarks.h"

#include <fmt/format.h>

#include <limits>

#include "core/check.h"

namespace articap {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct FrontPlace {
  const char* name;
  double x_mm, y_mm;  // as a view from the front shows it
};
constexpr FrontPlace kFrontPlaces[] = {
    {"nose_tip", 0, -19.5},         {"nose_bridge", 0, 20},        {"subnasale", 0, -31.5},
    {"nose_{}", 17.3, -23},         {"chin", 0, -85},              {"brow_center", 0, 33},
    {"forehead_center", 0, 56},     {"forehead_{}", 36, 56},       {"{}_brow_inner", 12, 30},
    {"{}_brow_middle", 31, 35.5},   {"{}_brow_outer", 47, 32.5},   {"{}_cheek", 49, -8},
    {"{}_cheek_middle", 40, -30},   {"{}_cheek_lower", 42, -52},   {"chin_{}", 15, -86}};

// Places on the side, at a section and level of the base surface.
struct SidePlace {
  const char* name;
  double section, level;
};
constexpr SidePlace kSidePlaces[] = {{"menton", 0, 4.0},
                                     {"jaw_{}", 2.5, 4.05},
                                     {"{}_jaw_angle", 4.0, 4.1}};

int NearestVertex(const HalfMesh& half, const Vector3d& place, std::size_t num_candidates,
                  Part part) {
  int best = -1;
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < num_candidates; ++i) {
    if (half.vertices[i].part != part) continue;
    // A landmark of the midline stays on it, and no other comes to lie there.
    if ((place.x() == 0) != (half.vertices[i].position.x() == 0)) continue;
    const double distance = (half.vertices[i].position - place).squaredNorm();
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = static_cast<int>(i);
  }
  ARTICAP_CHECK_GE(best, 0);
  return best;
}

}  // namespace

std::vector<HalfLandmark> FindLandmarks(const HalfMesh& half, const Skin& skin,
                                        const FaceShape& shape, const KnownVertices& known) {
  const std::size_t num_skin = skin.layout.nodes.size();
  std::vector<HalfLandmark> landmarks;
  for (const FrontPlace& place : kFrontPlaces)
    landmarks.push_back({place.name, NearestVertex(half, shape.InFront(place.x_mm, place.y_mm),
                                                   num_skin, Part::kSkin)});
  for (const SidePlace& place : kSidePlaces)
    landmarks.push_back(
        {place.name, NearestVertex(half, shape.At(Vector2d(place.section, place.level)), num_skin,
                                   Part::kSkin)});
  landmarks.push_back({"{}_tragion", NearestVertex(half, {69, 0, 0}, num_skin, Part::kSkin)});
  const std::size_t all = half.vertices.size();
  landmarks.push_back({"crown", NearestVertex(half, {0, 140, 2}, all, Part::kHair)});
  landmarks.push_back({"back_of_head", NearestVertex(half, {0, 38, -110}, all, Part::kHair)});

  const std::vector<int>& border = skin.mouth_rings[skin.border_ring];
  const int corner = skin.layout.mouth_corner;
  landmarks.push_back({"upper_lip_center", border.front()});
  landmarks.push_back({"lower_lip_center", border.back()});
  landmarks.push_back({"{}_mouth_corner", border[corner]});
  landmarks.push_back({"upper_lip_{}", border[corner / 2]});
  landmarks.push_back({"lower_lip_{}", border[2 * corner - corner / 2]});

  const std::vector<int>& lids = skin.eye_rings[skin.lid_ring];
  const int outer = skin.layout.eye_outer;
  landmarks.push_back({"{}_eye_inner", lids[0]});
  landmarks.push_back({"{}_eye_outer", lids[outer]});
  landmarks.push_back({"{}_eye_lower", lids[outer / 2]});
  landmarks.push_back({"{}_eye_upper", lids[2 * outer - outer / 2]});

  landmarks.push_back({"upper_incisor", known.incisors.upper});
  landmarks.push_back({"lower_incisor", known.incisors.lower});
  landmarks.push_back({"{}_eye_center", known.eye_center});
  landmarks.push_back({"jaw_pivot", known.jaw_pivot});
  landmarks.push_back({"mouth_pivot", known.mouth_pivot});
  // From the speaker's right temple over the bridge to the left.
  landmarks.push_back({"spectacles_3", known.spectacles[0]});
  landmarks.push_back({"spectacles_4|spectacles_2", known.spectacles[1]});
  landmarks.push_back({"spectacles_5|spectacles_1", known.spectacles[2]});
  return landmarks;
}

std::vector<Landmark> MirrorLandmarks(const std::vector<HalfLandmark>& half, const MirrorMap& map) {
  std::vector<Landmark> landmarks;
  for (const HalfLandmark& landmark : half) {
    const int left = map.left[landmark.vertex], right = map.right[landmark.vertex];
    const std::size_t bar = landmark.name.find('|');
    if (bar != std::string::npos) {
      landmarks.push_back({landmark.name.substr(0, bar), left});
      landmarks.push_back({landmark.name.substr(bar + 1), right});
    } else if (landmark.name.find("{}") != std::string::npos) {
      landmarks.push_back({fmt::format(fmt::runtime(landmark.name), "left"), left});
      landmarks.push_back({fmt::format(fmt::runtime(landmark.name), "right"), right});
    } else {
      ARTICAP_CHECK_EQ(left, right);
      landmarks.push_back({landmark.name, left});
    }
  }
  return landmarks;
}

}  // namespace articap
