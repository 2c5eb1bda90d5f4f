// SPDX-License-Identifier: MIT
#include "calib/lens_model.h"

#include <Eigen/Cholesky>
#include <utility>

namespace articap {
namespace {

// Coefficients are kept where they lower Akaike's criterion, 2 a coefficient: leaving out what is
// there, if only just above the noise, costs more than keeping what is not, and the sigmas of all
// others would not say so. (H. Akaike, IEEE Trans. Automatic Control 19(6), 1974.)
constexpr double kWorthOfCoefficient = 2;

// What each model adds to the one before.
std::vector<int> AddedBy(LensModel model) {
  switch (model) {
    case LensModel::kPinhole:
      return {};
    case LensModel::kK1:
      return {Lens::kK1};
    case LensModel::kK1K2:
      return {Lens::kK2};
    case LensModel::kBrown4:
      return {Lens::kP1, Lens::kP2};
    case LensModel::kBrown5:
      return {Lens::kK3};
    case LensModel::kRational:
      return {Lens::kK4, Lens::kK5, Lens::kK6};
  }
  return {};
}

LensModel Below(LensModel model) { return static_cast<LensModel>(static_cast<int>(model) - 1); }

}  // namespace

LensFreedom FreedomOf(LensModel model, const LensOptions& options) {
  LensFreedom freedom;
  freedom.focal = true;
  freedom.aspect = !options.fixed_aspect;
  freedom.principal_point = !options.fixed_principal_point;
  for (LensModel part = model; part != LensModel::kPinhole; part = Below(part))
    for (int coefficient : AddedBy(part)) freedom.distortion[coefficient] = true;
  return freedom;
}

bool IsSupported(const AdjustedNetwork& adjusted, int camera, LensModel model) {
  std::vector<int> columns;
  std::vector<double> values;
  for (int coefficient : AddedBy(model))
    for (int i = 0; i < static_cast<int>(adjusted.parameters.size()); ++i)
      if (adjusted.parameters[i] ==
          CameraParameter{CameraParameter::Kind::kDistortion, camera, coefficient}) {
        columns.push_back(i);
        values.push_back(adjusted.network.array.cameras[camera].lens.distortion[coefficient]);
      }
  const int count = static_cast<int>(columns.size());
  Eigen::MatrixXd covariance(count, count);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b) covariance(a, b) = adjusted.covariance(columns[a], columns[b]);
  if (!covariance.allFinite()) return false;
  const Eigen::Map<const Eigen::VectorXd> value(values.data(), count);
  return value.dot(covariance.ldlt().solve(value)) > kWorthOfCoefficient * count;
}

AdjustedNetwork SimplifyLenses(AdjustedNetwork adjusted, const LensOptions& options,
                               AdjustOptions& adjust, std::vector<LensModel>& models) {
  for (;;) {
    bool simpler = false;
    for (int camera = 0; camera < static_cast<int>(models.size()); ++camera) {
      LensModel& model = models[camera];
      if (!adjust.lenses[camera].any() || model == LensModel::kPinhole ||
          model == LensModel::kRational || IsSupported(adjusted, camera, model))
        continue;
      auto& distortion = adjusted.network.array.cameras[camera].lens.distortion;
      for (int coefficient : AddedBy(model)) distortion[coefficient] = 0;
      model = Below(model);
      adjust.lenses[camera] = FreedomOf(model, options);
      simpler = true;
    }
    if (!simpler) return adjusted;
    adjusted = Adjust(adjusted.network, adjust);
  }
}

std::vector<HeldLens> JudgeHeldLenses(const AdjustedNetwork& adjusted, AdjustOptions adjust) {
  std::vector<int> held;
  for (int camera = 0; camera < static_cast<int>(adjust.lenses.size()); ++camera)
    if (!adjust.lenses[camera].any()) {
      held.push_back(camera);
      adjust.lenses[camera].focal = true;
    }
  if (held.empty()) return {};
  const AdjustedNetwork free = Adjust(adjusted.network, adjust);
  std::vector<HeldLens> lenses;
  for (int camera : held) {
    const double held_px = adjusted.network.array.cameras[camera].lens.fx_px;
    const Camera& found = free.network.array.cameras[camera];
    lenses.push_back({camera, found.lens.fx_px / held_px, found.sigmas.fx_px / held_px});
  }
  return lenses;
}

}  // namespace articap
