// SPDX-License-Identifier: MIT
#include "tracking/corrections.h"

#include "fuzz/fuzz_input.h"
#include "tracking/apply_corrections.h"

namespace articap {
namespace {

// Two markers that one camera sees in five frames, named like those of the corpus.
struct SmallTake {
  CameraArray array;
  PointClouds clouds;
  std::vector<InstantDots> instants;
  MarkerTemplate marker_template;
};

SmallTake MakeSmallTake() {
  SmallTake take;
  Camera camera;
  camera.name = "front";
  camera.width = camera.height = 100;
  camera.lens = CentredLens(100, 100, 100);
  take.array.cameras = {camera};
  for (const char* name : {"chin", "nose"})
    take.marker_template.markers.push_back({name, Eigen::Vector3d::Zero(), 3, false});
  for (int frame = 0; frame < 5; ++frame) {
    std::vector<Dot> dots(2);
    dots[1].center_px = {50, 50};
    take.instants.push_back({dots});
    std::vector<CloudPoint> cloud(2);
    for (int i = 0; i < 2; ++i) {
      cloud[i].position_in_stage_mm = {20.0 * i, 0, 500};
      cloud[i].covariance_mm2 = Eigen::Matrix3d::Identity();
      cloud[i].sights = {{{0, -1}, i}};
    }
    take.clouds.frames.push_back(cloud);
  }
  return take;
}

}  // namespace
}  // namespace articap

// Whatever can be read can be applied, and no correction changes more samples than there are.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = articap::ParseCorrections(articap::TextOf(data, size), "fuzz");
  if (!read) return 0;
  for (const articap::Correction& correction : read->list)
    articap::Require(correction.first <= correction.last && correction.line > 0);
  articap::SmallTake take = articap::MakeSmallTake();
  articap::AppliedCorrections corrections(*read, 1);
  if (!corrections.CheckViews(take.array) || !corrections.CheckMarkers(take.marker_template))
    return 0;
  corrections.CorrectDots(take.array, take.instants);
  const articap::Labelling labelling =
      corrections.Label(take.clouds, take.marker_template, {}, take.array, take.instants);
  articap::Require(labelling.frames.size() == 5);
  const articap::StageReport report = corrections.Report();
  articap::Require(report.figures.size() == 3);
  return 0;
}
