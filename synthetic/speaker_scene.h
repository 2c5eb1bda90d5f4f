// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/marker_set.h"
#include "render/render.h"
#include "rig/face_rig.h"
#include "rig/virtual_marker_evaluator.h"
#include "synthetic/speaker.h"
#include "synthetic/studio.h"

namespace articap {

enum class DotKind : std::uint8_t {
  kDisc,        // a flat round sticker
  kBall,        // rests on the skin
  kHemisphere,  // its middle lies in the skin
};

// How a speaker looks before cameras.
struct SpeakerLookOptions {
  // Flat stickers on the midline cannot be seen in an exact profile; balls are seen from all sides.
  DotKind dots = DotKind::kBall;
  double dot_diameter_mm = 4;
  // Dots that shine back at the cameras' own lamps, in a room that is nearly dark; else white ones
  // in the light of a room.
  bool retro_reflective = false;
  // Eyes, the lower lip, the forehead and the tip of the nose are wet or greasy and mirror the
  // lamp: bright spots that look like dots, but move against the skin, and lie elsewhere in every
  // view. Not in a dark room.
  bool glints = false;
  // The part of the room's light that comes from all sides; the rest comes from one lamp, shades
  // balls and throws shadows.
  double diffuse_light = 0.4;
  // The light of the room rises and falls by this part of it, once in drift_period_s, and flickers
  // by this part at flicker_hz. Retro-reflective dots have a steady light of their own.
  double light_drift = 0;
  double drift_period_s = 7;
  double light_flicker = 0;
  double flicker_hz = 100;
};
void VisitOptions(SpeakerLookOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const SpeakerLookOptions& options);

// The same markers with the heights over the skin that their centres have with these dots: 0 for
// discs and hemispheres, the radius for balls.
MarkerSet WithDots(MarkerSet set, const SpeakerLookOptions& look);

// The speaker at one instant, in the stage frame of SyntheticCameras. Dot i is that of marker i:
// scene.discs[i] or scene.spheres[i].
struct SpeakerScene {
  Scene scene;
  int num_dots = 0;
  std::vector<std::string> glint_names;  // of scene.wet_spots: "glint_forehead_center"

  const Eigen::Vector3d& center_mm(int dot) const;
  double radius_mm(int dot) const;
};

// A take's speaker with its dots, for pictures. The take must have the speaker ahead
// (SyntheticTakeOptions::speaker_ahead) and heights of markers as WithDots() makes them.
class FilmedSpeaker {
 public:
  // `rig` is that of the take, with its average identity.
  FilmedSpeaker(const FaceRig& rig, SyntheticTake take, const SpeakerLookOptions& look);

  const SyntheticTake& take() const { return take_; }
  // At frame / rate_hz of the take: between its frames parameters and the head's pose follow cubic
  // curves through those of four frames (Catmull and Rom 1974).
  SpeakerScene At(double frame, const Studio& studio) const;

 private:
  void AddGlints(const std::vector<Eigen::Vector3d>& posed_in_stage_mm,
                 const Rigid3d& stage_from_head, SpeakerScene& filmed) const;
  void AddDots(const std::vector<Eigen::Vector3d>& posed_in_stage_mm,
               const std::vector<Eigen::Vector3d>& centers_mm, SpeakerScene& filmed) const;
  void Light(double time_s, SpeakerScene& filmed) const;

  FaceRig speaker_;
  SyntheticTake take_;
  SpeakerLookOptions look_;
  VirtualMarkerEvaluator evaluator_;
  bool wears_spectacles_ = false;
};

// What a view shows of a dot.
struct DotTruth {
  // Where the dot's centre appears; NaN where the view does not look.
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  // How much of its outline, a circle of the dot's radius (of balls and hemispheres the one across
  // the line of sight), is truly to be seen, 0 to 1.
  double visible = 0;
  // Of the disc that has the area of the whole outline; NaN where the view does not look.
  double diameter_px = 0;
};

// Where a view looks from; glass, which hardly turns a line of sight, is not regarded.
Eigen::Vector3d EyeOf(const CameraArray& array, const View& view);

// For every view of the studio's array, in their order, every dot.
std::vector<std::vector<DotTruth>> TruthOfDots(const Studio& studio, const SpeakerScene& filmed);

// Where every view shows each glint: its brightest place; visible is 1 where it is to be seen, else
// 0 (also where nothing there mirrors the lamp), diameter_px is not known.
std::vector<std::vector<DotTruth>> TruthOfGlints(const Studio& studio, const SpeakerScene& filmed);

// Rows of a picture, the end excluded.
struct PictureRows {
  int begin = 0;
  int end = 0;
};

// The light that a camera gets, in these rows of its picture: dots are sampled finely enough that
// their centres are where they should be to 0.01 px.
LinearPicture RenderSpeaker(const Studio& studio, const SpeakerScene& filmed, int camera,
                            const PictureRows& rows);

}  // namespace articap
