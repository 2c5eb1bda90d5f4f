// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/virtual_marker.h"
#include "rig/face_rig.h"

namespace articap {

// Positions of virtual markers and their derivatives with respect to the rig's parameters: the
// inner loop of the shape fit, so the rig is compiled into the few numbers that each marker depends
// on.
//
// A vertex of the rig is x(y) = A(y) + (R - I) B(y) + w slide, with A its displaced position, B its
// jaw-weighted arm from the condyles (both affine in the parameters y other than the jaw's), R the
// jaw's rotation; that is f(y) + R t(y) + w slide with f = A - B and t = B. So are its sums: q's
// barycentric point, and each edge from v1 to its one-ring. The normal at v1, up to its length, is
// N = sum e_a x e_b over the triangles (v1, a, b), and therefore
//   N = sum f_a x f_b + R sum t_a x t_b + axial(P R^T) + (m + R n) x slide,
//   P = sum f_a t_b^T - f_b t_a^T,  m = sum w_b f_a - w_a f_b,  n = sum w_b t_a - w_a t_b,
// where axial(Q)_i = eps_ijk Q_jk: quadratic forms in (1, y) for the first three, affine m and n.
// The mesh is not needed any more, however many triangles meet at v1.
class VirtualMarkerEvaluator {
 public:
  // Keeps no reference to the rig. Vertices and triangles must be the rig's.
  VirtualMarkerEvaluator(const FaceRig& rig, std::span<const VirtualMarker> markers);

  int num_markers() const { return static_cast<int>(markers_.size()); }
  int num_parameters() const { return num_parameters_; }

  // The jaw's rotation and slide of one vector of parameters, shared by all markers of a pose.
  struct Pose {
    std::span<const double> parameters;
    Eigen::Matrix3d jaw_rotation;    // R
    Eigen::Matrix3d jaw_derivative;  // dR/d(angle)
    Eigen::Vector3d jaw_slide_mm;
  };
  Pose PoseOf(std::span<const double> parameters) const;

  // q of one marker, mm, rig frame.
  Eigen::Vector3d Position(const Pose& pose, int marker) const;

  // The columns of dq/dy that can differ from zero, in the order of active_parameters(marker).
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  std::span<const int> active_parameters(int marker) const { return markers_[marker].columns; }
  // Writes 3 x active_parameters(marker).size() doubles, column by column; returns q.
  Eigen::Vector3d PositionAndJacobian(const Pose& pose, int marker, double* jacobian) const;

  // Conveniences over the two above: all markers, and the dense Jacobian of all of them (rows 3 i
  // .. 3 i + 2 belong to marker i).
  Eigen::Matrix3Xd Positions(std::span<const double> parameters) const;
  Eigen::MatrixXd DenseJacobian(std::span<const double> parameters) const;

 private:
  // One marker as sums of affine forms: value = (fixed + R turned) (1, y) + slide_weight slide.
  struct Marker {
    double u_mm = 0;
    bool turns = false;        // does the jaw move any of its vertices?
    std::vector<int> columns;  // parameters it depends on: num_linear of them, then the jaw's
    int num_linear = 0;
    Eigen::Matrix3Xd fixed;   // 3 x (1 + num_linear): A - B of the barycentric point
    Eigen::Matrix3Xd turned;  // 3 x (1 + num_linear): B
    double slide_weight = 0;
    // The normal at v1, where u is not 0.
    //   forms: for each pair (k, l) of terms of (1, y) a block of numbers, symmetric in k and l:
    //     sum f_a x f_b, and, where the jaw turns the marker, sum t_a x t_b and P.
    std::vector<double> normal_forms;
    Eigen::Matrix3Xd slide_fixed, slide_turned;  // 3 x (1 + num_linear): m and n
  };

  Marker Compile(const FaceRig& rig, const VirtualMarker& marker) const;
  void CompileNormal(const FaceRig& rig, int vertex, Marker* marker) const;
  template <bool kWithJacobian>
  Eigen::Vector3d Evaluate(const Pose& pose, const Marker& marker, double* jacobian) const;
  template <bool kWithJacobian>
  Eigen::Vector3d AddNormal(const Pose& pose, const Marker& marker, double* jacobian) const;
  static int TermsOf(const Pose& pose, const Marker& marker, double* terms);
  template <bool kWithJacobian>
  static Eigen::Vector3d StillNormal(const Pose& pose, const Marker& marker,
                                     Eigen::Vector3d* derivatives);
  template <bool kWithJacobian>
  Eigen::Vector3d TurningNormal(const Pose& pose, const Marker& marker,
                                Eigen::Vector3d* derivatives) const;

  int num_parameters_ = 0;
  int rotation_parameter_ = -1;
  int thrust_parameter_ = -1;
  int shift_parameter_ = -1;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitX();
  Eigen::Vector3d thrust_direction_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_direction_ = Eigen::Vector3d::Zero();
  std::vector<Marker> markers_;
};

}  // namespace articap
