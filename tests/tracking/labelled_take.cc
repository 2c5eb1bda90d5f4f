// SPDX-License-Identifier: MIT
#include "tests/tracking/labelled_take.h"

#include <cmath>

#include "synthetic/random.h"
#include "tracking/labelled_markers.h"

namespace articap {
namespace {

constexpr double kBetweenMarkers_mm = 20;

// Two cameras a metre away, to the left and to the right.
CameraArray TwoCameras() {
  CameraArray array;
  for (const double side : {-1.0, 1.0}) {
    Camera camera;
    camera.name = side < 0 ? "left" : "right";
    camera.width = 640;
    camera.height = 480;
    camera.lens = CentredLens(1000, camera.width, camera.height);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(side * 0.3, Eigen::Vector3d::UnitY()));
    camera.cam_from_stage = {turn, Eigen::Vector3d(0, 0, 1000)};
    array.cameras.push_back(camera);
  }
  return array;
}

Dot DotAt(const Eigen::Vector2d& center_px) {
  Dot dot;
  dot.center_px = center_px;
  dot.covariance_px2 = 0.03 * 0.03 * Eigen::Matrix2d::Identity();
  dot.shape_px2 = 9 * Eigen::Matrix2d::Identity();
  dot.contrast = 0.5;
  return dot;
}

}  // namespace

MarkerRecording LabelledTake::Recording() const {
  return RecordingOf(clouds, marker_template, labelling, array);
}

LabelledTake MakeLabelledTake(const std::vector<std::string>& names, int num_frames, double rate_hz,
                              double noise_mm) {
  RandomGenerator random(1, 0);
  LabelledTake take;
  take.array = TwoCameras();
  take.clouds.rate_hz = rate_hz;
  for (const std::string& name : names)
    take.marker_template.markers.push_back({name, {}, 3, false});
  for (int frame = 0; frame < num_frames; ++frame) {
    std::vector<CloudPoint> cloud;
    std::vector<std::vector<Dot>> dots(take.array.cameras.size());
    LabelledFrame labelled;
    labelled.template_from_stage = Rigid3d{};
    for (int m = 0; m < static_cast<int>(names.size()); ++m) {
      CloudPoint point;
      point.position_in_stage_mm =
          Eigen::Vector3d(kBetweenMarkers_mm * m, 5 * std::sin(2 * M_PI * frame / rate_hz), 0) +
          noise_mm * random.NormalVector();
      point.covariance_mm2 = noise_mm * noise_mm * Eigen::Matrix3d::Identity();
      point.residual_px = 0.03;
      point.residual_mm = 0.02;
      for (int camera = 0; camera < 2; ++camera) {
        point.sights.push_back({{camera, -1}, m});
        dots[camera].push_back(
            DotAt(*Project(take.array, {camera, -1}, point.position_in_stage_mm)));
      }
      labelled.points.push_back(m);
      labelled.margins.push_back(20);
      labelled.places.push_back({point.position_in_stage_mm, point.covariance_mm2});
      cloud.push_back(std::move(point));
    }
    take.clouds.frames.push_back(std::move(cloud));
    take.instants.push_back(std::move(dots));
    take.labelling.frames.push_back(std::move(labelled));
  }
  for (int m = 0; m < static_cast<int>(names.size()); ++m)
    take.marker_template.markers[m].position_mm = {kBetweenMarkers_mm * m, 0, 0};
  return take;
}

}  // namespace articap
