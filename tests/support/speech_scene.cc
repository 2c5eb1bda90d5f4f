// SPDX-License-Identifier: MIT
#include "tests/support/speech_scene.h"

#include <random>
#include <utility>

#include "rig/default_head/default_head.h"
#include "rig/virtual_marker_evaluator.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"

namespace articap {

SpeechScene MakeSpeechScene(int num_sentences, double noise_mm, int seed) {
  const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml").value();
  SyntheticTakeOptions options;
  options.seed = seed;
  options.speech.num_sentences = num_sentences;
  options.identity_spread = 0;
  options.misplacement_mm = 0;
  FaceRig rig = MakeDefaultHead().value();
  const SyntheticTake take = SynthesizeTake(rig, set, options).value();

  SpeechScene scene{std::move(rig), {}, take.truth.values, {}, {}, {}};
  for (const VirtualMarker& marker : take.true_attachments)
    if (set.Find(marker.name)->face) scene.markers.push_back(marker);
  const int num_parameters = scene.rig.num_parameters();
  scene.lower.resize(num_parameters);
  scene.upper.resize(num_parameters);
  for (int k = 0; k < num_parameters; ++k) {
    scene.lower[k] = scene.rig.definition().parameters[k].min;
    scene.upper[k] = scene.rig.definition().parameters[k].max;
  }
  const VirtualMarkerEvaluator evaluator(scene.rig, scene.markers);
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> noise(0, noise_mm);
  for (Eigen::Index frame = 0; frame < scene.truth.rows(); ++frame) {
    const Eigen::VectorXd y = scene.truth.row(frame);
    const Eigen::Matrix3Xd positions =
        evaluator.Positions({y.data(), static_cast<std::size_t>(y.size())});
    std::vector<Eigen::Vector3d> measured;
    for (Eigen::Index i = 0; i < positions.cols(); ++i)
      measured.push_back(positions.col(i) +
                         Eigen::Vector3d{noise(random), noise(random), noise(random)});
    scene.measured.push_back(std::move(measured));
  }
  return scene;
}

}  // namespace articap
