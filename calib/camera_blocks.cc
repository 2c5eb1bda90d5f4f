// SPDX-License-Identifier: MIT
#include "calib/camera_blocks.h"

#include <ceres/crs_matrix.h>
#include <ceres/manifold.h>
#include <ceres/ordered_groups.h>
#include <ceres/product_manifold.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/check.h"

namespace articap {
namespace {

using Kind = CameraParameter::Kind;

std::array<double, kLensSize> ToBlock(const Lens& lens) {
  std::array<double, kLensSize> block = {lens.fx_px, lens.fy_px / lens.fx_px, lens.cx_px,
                                         lens.cy_px};
  std::copy(lens.distortion.begin(), lens.distortion.end(), block.begin() + 4);
  return block;
}

Lens LensOf(const std::array<double, kLensSize>& block) {
  Lens lens = {block[0], block[0] * block[1], block[2], block[3], {}};
  std::copy(block.begin() + 4, block.end(), lens.distortion.begin());
  return lens;
}

// The mirror's plane in its camera's frame, as the foot of the perpendicular from the camera.
Eigen::Vector3d FootOf(const Mirror& mirror, const Rigid3d& cam_from_stage) {
  const Eigen::Vector3d normal = cam_from_stage.rotation * mirror.normal_in_stage;
  return normal * (mirror.distance_mm + normal.dot(cam_from_stage.translation_mm));
}

void SetFoot(const Eigen::Vector3d& foot, const Rigid3d& cam_from_stage, Mirror& mirror) {
  const Eigen::Vector3d normal = foot.normalized();
  mirror.normal_in_stage = cam_from_stage.rotation.conjugate() * normal;
  mirror.distance_mm = foot.norm() - normal.dot(cam_from_stage.translation_mm);
}

// Whether each entry of a lens' block is free.
std::array<bool, kLensSize> FreeEntries(const LensFreedom& free) {
  std::array<bool, kLensSize> entries = {free.focal, free.aspect, free.principal_point,
                                         free.principal_point};
  std::copy(free.distortion.begin(), free.distortion.end(), entries.begin() + 4);
  return entries;
}

CameraParameter LensParameter(int camera, int entry) {
  constexpr std::array<Kind, 4> kFirst = {Kind::kFocal, Kind::kAspect, Kind::kPrincipalX,
                                          Kind::kPrincipalY};
  if (entry < 4) return {kFirst[entry], camera, 0};
  return {Kind::kDistortion, camera, entry - 4};
}

// At the solution: the cameras' blocks first, then the places'.
ArrowJacobian JacobianOf(ceres::Problem& problem, const CameraBlocks& cameras,
                         const std::vector<double*>& places) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = cameras.free_blocks();
  ArrowJacobian jacobian;
  jacobian.camera_columns = static_cast<int>(cameras.parameters().size());
  for (double* block : places) {
    options.parameter_blocks.push_back(block);
    jacobian.group_sizes.push_back(problem.ParameterBlockTangentSize(block));
  }
  ceres::CRSMatrix matrix;
  ARTICAP_CHECK(problem.Evaluate(options, nullptr, nullptr, nullptr, &matrix));
  jacobian.rows = matrix.num_rows;
  jacobian.row_starts = std::move(matrix.rows);
  jacobian.columns = std::move(matrix.cols);
  jacobian.values = std::move(matrix.values);
  jacobian.views = cameras.num_views();
  return jacobian;
}

// Looks variances up by name; those of parameters that were held are 0.
class CovarianceTable {
 public:
  CovarianceTable(const std::vector<CameraParameter>& parameters, const Eigen::MatrixXd& covariance)
      : parameters_(parameters), covariance_(covariance) {}

  double Covariance(const CameraParameter& a, const CameraParameter& b) const {
    const int row = ColumnOf(a), column = ColumnOf(b);
    return row < 0 || column < 0 ? 0 : covariance_(row, column);
  }
  double Sigma(const CameraParameter& parameter) const {
    return std::sqrt(Covariance(parameter, parameter));
  }

 private:
  int ColumnOf(const CameraParameter& parameter) const {
    const auto found = std::find(parameters_.begin(), parameters_.end(), parameter);
    return found == parameters_.end() ? -1 : static_cast<int>(found - parameters_.begin());
  }

  const std::vector<CameraParameter>& parameters_;
  const Eigen::MatrixXd& covariance_;
};

CameraSigmas SigmasOf(const CovarianceTable& table, int camera, const Lens& lens) {
  const CameraParameter focal = {Kind::kFocal, camera}, aspect = {Kind::kAspect, camera};
  CameraSigmas sigmas;
  sigmas.fx_px = table.Sigma(focal);
  // fy = aspect fx
  const double ratio = lens.fy_px / lens.fx_px;
  sigmas.fy_px = std::sqrt(ratio * ratio * table.Covariance(focal, focal) +
                           2 * ratio * lens.fx_px * table.Covariance(focal, aspect) +
                           lens.fx_px * lens.fx_px * table.Covariance(aspect, aspect));
  sigmas.cx_px = table.Sigma({Kind::kPrincipalX, camera});
  sigmas.cy_px = table.Sigma({Kind::kPrincipalY, camera});
  for (int i = 0; i < Lens::kNumDistortion; ++i)
    sigmas.distortion[i] = table.Sigma({Kind::kDistortion, camera, i});
  for (int axis = 0; axis < 3; ++axis) {
    sigmas.rotation_rad[axis] = table.Sigma({Kind::kRotation, camera, axis});
    sigmas.translation_mm[axis] = table.Sigma({Kind::kTranslation, camera, axis});
  }
  sigmas.time_offset_s = table.Sigma({Kind::kTimeOffset, camera});
  return sigmas;
}

// The foot is distance times normal: along the normal its error is the distance's, across it the
// direction's.
void FillMirrorSigmas(const CovarianceTable& table, int index, CameraArray& array) {
  Mirror& mirror = array.mirrors[index];
  const Eigen::Vector3d foot = FootOf(mirror, array.cameras[mirror.camera].cam_from_stage);
  const Eigen::Vector3d normal = foot.normalized();
  Eigen::Matrix3d of_foot;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      of_foot(a, b) = table.Covariance({Kind::kMirror, index, a}, {Kind::kMirror, index, b});
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  mirror.distance_sigma_mm = std::sqrt(normal.dot(of_foot * normal));
  mirror.normal_sigma_rad =
      std::sqrt((across * of_foot * across).eval().operatorNorm()) / foot.norm();
}

}  // namespace

PoseBlock ToBlock(const Rigid3d& transform) {
  const Eigen::Quaterniond& q = transform.rotation;
  const Eigen::Vector3d& t = transform.translation_mm;
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

Rigid3d FromBlock(const PoseBlock& block) {
  return {Eigen::Quaterniond(block[3], block[0], block[1], block[2]).normalized(),
          {block[4], block[5], block[6]}};
}

void AddPose(ceres::Problem& problem, PoseBlock& pose) {
  using PoseManifold =
      ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
  problem.AddParameterBlock(pose.data(), kPoseSize, new PoseManifold());
}

CameraBlocks::CameraBlocks(const CameraArray& array, const AdjustOptions& options)
    : array_(array), options_(options) {
  options_.lenses.resize(array.cameras.size());
  for (const Camera& camera : array.cameras)
    cameras_.push_back(
        {ToBlock(camera.lens), articap::ToBlock(camera.cam_from_stage), camera.time_offset_s});
  for (const Mirror& mirror : array.mirrors) {
    const Eigen::Vector3d foot = FootOf(mirror, array.cameras[mirror.camera].cam_from_stage);
    mirrors_.push_back({foot.x(), foot.y(), foot.z()});
  }
}

void CameraBlocks::Constrain(ceres::Problem& problem) {
  for (int camera = 0; camera < static_cast<int>(cameras_.size()); ++camera) {
    ConstrainLens(problem, camera);
    ConstrainPose(problem, camera);
    ConstrainTimeOffset(problem, camera);
  }
  for (int mirror = 0; mirror < static_cast<int>(mirrors_.size()); ++mirror)
    ConstrainMirror(problem, mirror);
}

void CameraBlocks::ConstrainLens(ceres::Problem& problem, int camera) {
  double* block = lens(camera);
  if (!problem.HasParameterBlock(block)) return;
  const std::array<bool, kLensSize> free = FreeEntries(options_.lenses[camera]);
  std::vector<int> held;
  for (int entry = 0; entry < kLensSize; ++entry) {
    if (free[entry])
      parameters_.push_back(LensParameter(camera, entry));
    else
      held.push_back(entry);
  }
  if (held.size() == kLensSize) {
    problem.SetParameterBlockConstant(block);
    return;
  }
  free_blocks_.push_back(block);
  if (!held.empty()) problem.SetManifold(block, new ceres::SubsetManifold(kLensSize, held));
  problem.SetParameterLowerBound(block, 0, 1);  // a focal length stays one
}

void CameraBlocks::ConstrainPose(ceres::Problem& problem, int camera) {
  PoseBlock& block = cameras_[camera].pose;
  if (!problem.HasParameterBlock(block.data())) return;
  if (camera == 0) {
    problem.SetParameterBlockConstant(block.data());
    return;
  }
  AddPose(problem, block);
  free_blocks_.push_back(block.data());
  for (const Kind kind : {Kind::kRotation, Kind::kTranslation})
    for (int axis = 0; axis < 3; ++axis) parameters_.push_back({kind, camera, axis});
}

void CameraBlocks::ConstrainTimeOffset(ceres::Problem& problem, int camera) {
  double* block = time_offset(camera);
  if (!problem.HasParameterBlock(block)) return;
  if (camera == 0 || !options_.free_time_offsets) {
    problem.SetParameterBlockConstant(block);
    return;
  }
  free_blocks_.push_back(block);
  parameters_.push_back({Kind::kTimeOffset, camera, 0});
}

void CameraBlocks::ConstrainMirror(ceres::Problem& problem, int mirror_index) {
  double* block = mirror(mirror_index);
  if (!problem.HasParameterBlock(block)) return;
  free_blocks_.push_back(block);
  for (int axis = 0; axis < 3; ++axis) parameters_.push_back({Kind::kMirror, mirror_index, axis});
}

CameraArray CameraBlocks::Array() const {
  CameraArray array = array_;
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    array.cameras[camera].lens = LensOf(cameras_[camera].lens);
    array.cameras[camera].cam_from_stage = FromBlock(cameras_[camera].pose);
    array.cameras[camera].time_offset_s = cameras_[camera].time_offset_s;
  }
  for (std::size_t i = 0; i < mirrors_.size(); ++i) {
    Mirror& mirror = array.mirrors[i];
    SetFoot({mirrors_[i][0], mirrors_[i][1], mirrors_[i][2]},
            array.cameras[mirror.camera].cam_from_stage, mirror);
  }
  return array;
}

ceres::LossFunction* LossOf(const AdjustOptions& options, int view) {
  // Huber's loss of residuals over n is that from n k on, over n^2.
  const double noise = options.relative_noise.empty() ? 1 : options.relative_noise[view];
  ceres::LossFunction* const huber =
      options.huber_px > 0 ? new ceres::HuberLoss(noise * options.huber_px) : nullptr;
  if (noise == 1) return huber;
  return new ceres::ScaledLoss(huber, 1 / (noise * noise), ceres::TAKE_OWNERSHIP);
}

ceres::Solver::Summary SolveBySchur(ceres::Problem& problem, const std::vector<double*>& places,
                                    const AdjustOptions& options) {
  constexpr double kTolerance = 1e-10;
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  for (double* block : blocks) solver.linear_solver_ordering->AddElementToGroup(block, 1);
  for (double* block : places) solver.linear_solver_ordering->AddElementToGroup(block, 0);
  solver.max_num_iterations = options.max_iterations;
  // More threads add up in another order, to other last digits.
  solver.num_threads = 1;
  solver.function_tolerance = solver.parameter_tolerance = kTolerance;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary;
}

ArrowCovariance CovarianceOfCameras(ceres::Problem& problem, const CameraBlocks& cameras,
                                    const std::vector<double*>& places,
                                    const std::vector<int>& row_views) {
  ArrowJacobian jacobian = JacobianOf(problem, cameras, places);
  ARTICAP_CHECK(static_cast<int>(row_views.size()) == jacobian.rows);
  jacobian.row_views = row_views;
  ArrowCovariance covariance = CovarianceOf(jacobian);
  // Ceres' tangents of quaternions are half angles.
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(covariance.cameras.rows());
  for (int i = 0; i < scale.size(); ++i)
    if (cameras.parameters()[i].kind == Kind::kRotation) scale(i) = 2;
  covariance.cameras = scale.asDiagonal() * covariance.cameras * scale.asDiagonal();
  return covariance;
}

void FillSigmas(const std::vector<CameraParameter>& parameters, const Eigen::MatrixXd& covariance,
                CameraArray& array) {
  const CovarianceTable table(parameters, covariance);
  for (int camera = 0; camera < static_cast<int>(array.cameras.size()); ++camera)
    array.cameras[camera].sigmas = SigmasOf(table, camera, array.cameras[camera].lens);
  for (int mirror = 0; mirror < static_cast<int>(array.mirrors.size()); ++mirror)
    FillMirrorSigmas(table, mirror, array);
}

}  // namespace articap
