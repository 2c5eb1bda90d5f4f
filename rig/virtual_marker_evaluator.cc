// SPDX-License-Identifier: MIT
#include "rig/virtual_marker_evaluator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>

#include "core/check.h"

namespace articap {
namespace {

// Parameters other than the jaw's that may move one marker, and one for the constant term.
constexpr int kMaxTerms = 512;

struct WeightedVertex {
  int vertex = 0;
  double weight = 0;
};

// The displacement of a vertex per unit of a parameter; fields list their vertices in ascending
// order.
Eigen::Vector3d DisplacementAt(const DisplacementField& field, int vertex) {
  const auto found = std::lower_bound(field.vertices.begin(), field.vertices.end(), vertex);
  if (found == field.vertices.end() || *found != vertex) return Eigen::Vector3d::Zero();
  return field.displacements_mm[found - field.vertices.begin()];
}

// The affine form of a weighted sum of vertices: 3 x (1 + columns) coefficients of A - B and of B.
struct Form {
  Eigen::Matrix3Xd fixed, turned;
  double slide_weight = 0;
};

Form FormOf(const FaceRig& rig, std::span<const int> linear_columns,
            std::span<const WeightedVertex> sum) {
  const int num_terms = 1 + static_cast<int>(linear_columns.size());
  Form form{Eigen::Matrix3Xd::Zero(3, num_terms), Eigen::Matrix3Xd::Zero(3, num_terms), 0};
  const auto& jaw = rig.definition().jaw;
  const Eigen::Vector3d pivot =
      jaw ? rig.neutral_mesh().vertices[jaw->pivot_vertex] : Eigen::Vector3d::Zero();
  for (const auto& [vertex, share] : sum) {
    const double weight = share;  // lambdas of C++20 capture no structured bindings in clang 14
    const double jaw_weight = weight * rig.jaw_weight(vertex);
    const auto add = [&](int term, const Eigen::Vector3d& point, const Eigen::Vector3d& arm) {
      form.fixed.col(term) += weight * point - jaw_weight * arm;
      form.turned.col(term) += jaw_weight * arm;
    };
    const Eigen::Vector3d& point = rig.neutral_mesh().vertices[vertex];
    add(0, point, point - pivot);
    for (int k = 1; k < num_terms; ++k) {
      const Eigen::Vector3d displacement = DisplacementAt(rig.field(linear_columns[k - 1]), vertex);
      add(k, displacement, displacement);
    }
    form.slide_weight += jaw_weight;
  }
  return form;
}

// The numbers of a pair of terms in Marker::normal_forms, padded to whole vector registers.
constexpr int kStillBlock = 4;
constexpr int kTurningBlock = 16;
template <int kSize>
using Block = Eigen::Array<double, kSize, 1>;

Eigen::Vector3d StillCross(const Block<kTurningBlock>& block) { return block.segment<3>(0); }
Eigen::Vector3d TurnedCross(const Block<kTurningBlock>& block) { return block.segment<3>(3); }
Eigen::Matrix3d MixedProduct(const Block<kTurningBlock>& block) {
  return Eigen::Map<const Eigen::Matrix3d>(block.data() + 6);
}

// Row k of the quadratic form, times the terms: sum_l block(k, l) terms_l.
template <int kSize>
[[gnu::always_inline]] inline Block<kSize> RowTimesTerms(const std::vector<double>& forms, int k,
                                                         int num_terms, const double* terms) {
  const double* block = forms.data() + static_cast<std::size_t>(k) * num_terms * kSize;
  Block<kSize> sum = terms[0] * Eigen::Map<const Block<kSize>>(block);
  for (int l = 1; l < num_terms; ++l)
    sum += terms[l] * Eigen::Map<const Block<kSize>>(block + l * kSize);
  return sum;
}

// axial(p r^T).
[[gnu::always_inline]] inline Eigen::Vector3d AxialOfProduct(const Eigen::Matrix3d& p,
                                                             const Eigen::Matrix3d& r) {
  return {p.row(1).dot(r.row(2)) - p.row(2).dot(r.row(1)),
          p.row(2).dot(r.row(0)) - p.row(0).dot(r.row(2)),
          p.row(0).dot(r.row(1)) - p.row(1).dot(r.row(0))};
}

// The triangles around a vertex as (a, b), turned so that the vertex comes first: (vertex, a, b).
std::vector<std::pair<int, int>> FanAround(const TriangleMesh& mesh, int vertex) {
  std::vector<std::pair<int, int>> fan;
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner)
      if (triangle[corner] == vertex)
        fan.emplace_back(triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]);
  return fan;
}

}  // namespace

VirtualMarkerEvaluator::VirtualMarkerEvaluator(const FaceRig& rig,
                                               std::span<const VirtualMarker> markers)
    : num_parameters_(rig.num_parameters()) {
  if (const auto& jaw = rig.definition().jaw) {
    rotation_parameter_ = jaw->rotation_parameter;
    thrust_parameter_ = jaw->thrust_parameter;
    shift_parameter_ = jaw->shift_parameter;
    axis_ = jaw->axis.normalized();
    thrust_direction_ = jaw->thrust_direction;
    shift_direction_ = jaw->shift_direction;
  }
  markers_.reserve(markers.size());
  for (const VirtualMarker& marker : markers) markers_.push_back(Compile(rig, marker));
}

VirtualMarkerEvaluator::Marker VirtualMarkerEvaluator::Compile(const FaceRig& rig,
                                                               const VirtualMarker& marker) const {
  const auto [v1, v2, v3] = std::array{marker.triangle[0], marker.triangle[1], marker.triangle[2]};
  for (const int vertex : {v1, v2, v3}) {
    ARTICAP_CHECK_GE(vertex, 0);
    ARTICAP_CHECK_LT(vertex, rig.num_vertices());
  }
  std::set<int> involved = {v1, v2, v3};
  if (marker.u_mm != 0)
    for (const auto& [a, b] : FanAround(rig.neutral_mesh(), v1)) involved.insert({a, b});

  Marker compiled;
  compiled.u_mm = marker.u_mm;
  for (int k = 0; k < num_parameters_; ++k)
    if (std::any_of(involved.begin(), involved.end(),
                    [&](int vertex) { return !DisplacementAt(rig.field(k), vertex).isZero(0); }))
      compiled.columns.push_back(k);
  compiled.num_linear = static_cast<int>(compiled.columns.size());

  const std::array<WeightedVertex, 3> barycentric = {
      {{v1, 1 - marker.s - marker.t}, {v2, marker.s}, {v3, marker.t}}};
  const Form form = FormOf(rig, compiled.columns, barycentric);
  compiled.fixed = form.fixed;
  compiled.turned = form.turned;
  compiled.slide_weight = form.slide_weight;
  compiled.turns = std::any_of(involved.begin(), involved.end(),
                               [&](int vertex) { return rig.jaw_weight(vertex) > 0; });
  if (marker.u_mm != 0) CompileNormal(rig, v1, &compiled);
  if (compiled.turns)
    for (const int parameter : {rotation_parameter_, thrust_parameter_, shift_parameter_})
      if (parameter >= 0) compiled.columns.push_back(parameter);
  return compiled;
}

void VirtualMarkerEvaluator::CompileNormal(const FaceRig& rig, int vertex, Marker* marker) const {
  const auto fan = FanAround(rig.neutral_mesh(), vertex);
  ARTICAP_CHECK(!fan.empty());
  const int num_terms = 1 + marker->num_linear;
  ARTICAP_CHECK_LE(num_terms, kMaxTerms);
  const int block_size = marker->turns ? kTurningBlock : kStillBlock;
  marker->normal_forms.assign(static_cast<std::size_t>(num_terms) * num_terms * block_size, 0);
  marker->slide_fixed.setZero(3, num_terms);
  marker->slide_turned.setZero(3, num_terms);
  const auto linear_columns = std::span(marker->columns).first(marker->num_linear);
  const auto edge_to = [&](int end) {
    return FormOf(rig, linear_columns, std::array<WeightedVertex, 2>{{{vertex, -1}, {end, 1}}});
  };
  for (const auto& [first, second] : fan) {
    const Form a = edge_to(first), b = edge_to(second);
    marker->slide_fixed += b.slide_weight * a.fixed - a.slide_weight * b.fixed;
    marker->slide_turned += b.slide_weight * a.turned - a.slide_weight * b.turned;
    for (int k = 0; k < num_terms; ++k)
      for (int l = 0; l < num_terms; ++l) {
        // Half to (k, l) and half to (l, k).
        const auto cross = [&](const Eigen::Matrix3Xd& left, const Eigen::Matrix3Xd& right) {
          return Eigen::Vector3d(
              0.5 * (left.col(k).cross(right.col(l)) + left.col(l).cross(right.col(k))));
        };
        double* const block =
            marker->normal_forms.data() + static_cast<std::size_t>(k * num_terms + l) * block_size;
        Eigen::Map<Eigen::Vector3d>(block) += cross(a.fixed, b.fixed);
        if (!marker->turns) continue;
        Eigen::Map<Eigen::Vector3d>(block + 3) += cross(a.turned, b.turned);
        Eigen::Map<Eigen::Matrix3d>(block + 6) +=
            0.5 * (a.fixed.col(k) * b.turned.col(l).transpose() +
                   a.fixed.col(l) * b.turned.col(k).transpose() -
                   b.fixed.col(k) * a.turned.col(l).transpose() -
                   b.fixed.col(l) * a.turned.col(k).transpose());
      }
  }
}

VirtualMarkerEvaluator::Pose VirtualMarkerEvaluator::PoseOf(
    std::span<const double> parameters) const {
  ARTICAP_CHECK_EQ(static_cast<int>(parameters.size()), num_parameters_);
  Pose pose{parameters, Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero(),
            Eigen::Vector3d::Zero()};
  if (rotation_parameter_ >= 0) {
    const double angle = parameters[rotation_parameter_];
    pose.jaw_rotation = Eigen::AngleAxisd(angle, axis_).toRotationMatrix();
    Eigen::Matrix3d cross_axis;
    cross_axis << 0, -axis_.z(), axis_.y(), axis_.z(), 0, -axis_.x(), -axis_.y(), axis_.x(), 0;
    pose.jaw_derivative = cross_axis * pose.jaw_rotation;
  }
  if (thrust_parameter_ >= 0)
    pose.jaw_slide_mm += parameters[thrust_parameter_] * thrust_direction_;
  if (shift_parameter_ >= 0) pose.jaw_slide_mm += parameters[shift_parameter_] * shift_direction_;
  return pose;
}

template <bool kWithJacobian>
Eigen::Vector3d VirtualMarkerEvaluator::Evaluate(const Pose& pose, const Marker& marker,
                                                 double* jacobian) const {
  const int num_linear = marker.num_linear;
  Eigen::Vector3d fixed = marker.fixed.col(0);
  for (int k = 0; k < num_linear; ++k)
    fixed += pose.parameters[marker.columns[k]] * marker.fixed.col(k + 1);
  if (!marker.turns) {
    if constexpr (kWithJacobian)
      Eigen::Map<Jacobian>(jacobian, 3, num_linear) = marker.fixed.rightCols(num_linear);
    return marker.u_mm == 0 ? fixed : fixed + AddNormal<kWithJacobian>(pose, marker, jacobian);
  }

  Eigen::Vector3d turned = marker.turned.col(0);
  for (int k = 0; k < num_linear; ++k)
    turned += pose.parameters[marker.columns[k]] * marker.turned.col(k + 1);
  Eigen::Vector3d position =
      fixed + pose.jaw_rotation * turned + marker.slide_weight * pose.jaw_slide_mm;
  if constexpr (kWithJacobian) {
    Eigen::Map<Jacobian> columns(jacobian, 3, static_cast<int>(marker.columns.size()));
    for (int k = 0; k < num_linear; ++k)
      columns.col(k) = marker.fixed.col(k + 1) + pose.jaw_rotation * marker.turned.col(k + 1);
    int column = num_linear;
    if (rotation_parameter_ >= 0) columns.col(column++) = pose.jaw_derivative * turned;
    if (thrust_parameter_ >= 0) columns.col(column++) = marker.slide_weight * thrust_direction_;
    if (shift_parameter_ >= 0) columns.col(column++) = marker.slide_weight * shift_direction_;
  }
  if (marker.u_mm != 0) position += AddNormal<kWithJacobian>(pose, marker, jacobian);
  return position;
}

// (1, y) of the parameters that a marker depends on, without the jaw's; returns their number.
int VirtualMarkerEvaluator::TermsOf(const Pose& pose, const Marker& marker, double* terms) {
  terms[0] = 1;
  for (int k = 0; k < marker.num_linear; ++k) terms[k + 1] = pose.parameters[marker.columns[k]];
  return 1 + marker.num_linear;
}

// N of a marker that the jaw does not turn, and its derivatives by the marker's columns.
template <bool kWithJacobian>
Eigen::Vector3d VirtualMarkerEvaluator::StillNormal(const Pose& pose, const Marker& marker,
                                                    Eigen::Vector3d* derivatives) {
  std::array<double, kMaxTerms> terms;  // NOLINT: filled as far as it is used
  const int num_terms = TermsOf(pose, marker, terms.data());
  Block<kStillBlock> sum = Block<kStillBlock>::Zero();
  for (int k = 0; k < num_terms; ++k) {
    const auto row = RowTimesTerms<kStillBlock>(marker.normal_forms, k, num_terms, terms.data());
    sum += terms[k] * row;
    if (kWithJacobian && k > 0) derivatives[k - 1] = 2 * row.head<3>();
  }
  return sum.head<3>();
}

// N of a marker that the jaw turns, and its derivatives by the marker's columns.
template <bool kWithJacobian>
Eigen::Vector3d VirtualMarkerEvaluator::TurningNormal(const Pose& pose, const Marker& marker,
                                                      Eigen::Vector3d* derivatives) const {
  const Eigen::Matrix3d& r = pose.jaw_rotation;
  const Eigen::Vector3d& slide = pose.jaw_slide_mm;
  const auto normal_of = [&](const Block<kTurningBlock>& block) -> Eigen::Vector3d {
    return StillCross(block) + r * TurnedCross(block) + AxialOfProduct(MixedProduct(block), r);
  };
  std::array<double, kMaxTerms> terms;  // NOLINT: filled as far as it is used
  const int num_terms = TermsOf(pose, marker, terms.data());
  Block<kTurningBlock> sum = Block<kTurningBlock>::Zero();
  Eigen::Vector3d m = Eigen::Vector3d::Zero(), n = Eigen::Vector3d::Zero();
  for (int k = 0; k < num_terms; ++k) {
    const auto row = RowTimesTerms<kTurningBlock>(marker.normal_forms, k, num_terms, terms.data());
    sum += terms[k] * row;
    m += terms[k] * marker.slide_fixed.col(k);
    n += terms[k] * marker.slide_turned.col(k);
    if (kWithJacobian && k > 0)
      derivatives[k - 1] =
          2 * normal_of(row) +
          (marker.slide_fixed.col(k) + r * marker.slide_turned.col(k)).cross(slide);
  }
  const Eigen::Vector3d slide_arm = m + r * n;
  if constexpr (kWithJacobian) {
    Eigen::Vector3d* derivative = derivatives + marker.num_linear;
    const Eigen::Matrix3d& dr = pose.jaw_derivative;
    if (rotation_parameter_ >= 0)
      *derivative++ =
          dr * TurnedCross(sum) + AxialOfProduct(MixedProduct(sum), dr) + (dr * n).cross(slide);
    if (thrust_parameter_ >= 0) *derivative++ = slide_arm.cross(thrust_direction_);
    if (shift_parameter_ >= 0) *derivative++ = slide_arm.cross(shift_direction_);
  }
  return normal_of(sum) + slide_arm.cross(slide);
}

// u e1 with e1 = N / |N|, and its derivatives, u (I - e1 e1^T) dN / |N|, added to the Jacobian.
template <bool kWithJacobian>
Eigen::Vector3d VirtualMarkerEvaluator::AddNormal(const Pose& pose, const Marker& marker,
                                                  double* jacobian) const {
  std::array<Eigen::Vector3d, kMaxTerms + 3> derivatives;
  const Eigen::Vector3d normal =
      marker.turns ? TurningNormal<kWithJacobian>(pose, marker, derivatives.data())
                   : StillNormal<kWithJacobian>(pose, marker, derivatives.data());
  const double length = normal.norm();
  if (length == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d e1 = normal / length;
  if constexpr (kWithJacobian) {
    const int num_columns = static_cast<int>(marker.columns.size());
    Eigen::Map<Jacobian> columns(jacobian, 3, num_columns);
    const double factor = marker.u_mm / length;
    for (int k = 0; k < num_columns; ++k)
      columns.col(k) += factor * (derivatives[k] - e1.dot(derivatives[k]) * e1);
  }
  return marker.u_mm * e1;
}

Eigen::Vector3d VirtualMarkerEvaluator::Position(const Pose& pose, int marker) const {
  return Evaluate<false>(pose, markers_[marker], nullptr);
}

Eigen::Vector3d VirtualMarkerEvaluator::PositionAndJacobian(const Pose& pose, int marker,
                                                            double* jacobian) const {
  return Evaluate<true>(pose, markers_[marker], jacobian);
}

Eigen::Matrix3Xd VirtualMarkerEvaluator::Positions(std::span<const double> parameters) const {
  const Pose pose = PoseOf(parameters);
  Eigen::Matrix3Xd positions(3, num_markers());
  for (int i = 0; i < num_markers(); ++i) positions.col(i) = Position(pose, i);
  return positions;
}

Eigen::MatrixXd VirtualMarkerEvaluator::DenseJacobian(std::span<const double> parameters) const {
  const Pose pose = PoseOf(parameters);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * num_markers(), num_parameters_);
  Jacobian columns(3, num_parameters_);
  for (int i = 0; i < num_markers(); ++i) {
    PositionAndJacobian(pose, i, columns.data());
    const auto active = active_parameters(i);
    for (std::size_t k = 0; k < active.size(); ++k)
      dense.block<3, 1>(3 * i, active[k]) = columns.col(static_cast<int>(k));
  }
  return dense;
}

}  // namespace articap
