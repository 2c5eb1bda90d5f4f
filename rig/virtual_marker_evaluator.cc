// SPDX-License-Identifier: MIT
#include "rig/virtual_marker_evaluator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "core/check.h"

namespace articap {
namespace {

// More edges than any sensible mesh has at a vertex.
constexpr int kMaxLanes = 64;

// The edges are worked on in fours, so that the compiler can use vector registers.
constexpr int kLaneMultiple = 4;

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

// x, y, z of every lane, and one lane more.
using Lanes = std::array<std::array<double, kMaxLanes + 1>, 3>;

// sum over the lanes of (x, y, z) x right.
Eigen::Vector3d CrossSum(int lanes, const double* x, const double* y, const double* z,
                         const Lanes& right) {
  double sum_x = 0, sum_y = 0, sum_z = 0;
  for (int lane = 0; lane < lanes; ++lane) {
    sum_x += y[lane] * right[2][lane] - z[lane] * right[1][lane];
    sum_y += z[lane] * right[0][lane] - x[lane] * right[2][lane];
    sum_z += x[lane] * right[1][lane] - y[lane] * right[0][lane];
  }
  return {sum_x, sum_y, sum_z};
}

// Every lane turned by a matrix.
void Turn(const Eigen::Matrix3d& matrix, int lanes, const Lanes& source, Lanes* target) {
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < lanes; ++lane)
      (*target)[axis][lane] = matrix(axis, 0) * source[0][lane] +
                              matrix(axis, 1) * source[1][lane] + matrix(axis, 2) * source[2][lane];
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
  if (marker.u_mm != 0) CompileRing(rig, v1, &compiled);

  compiled.turns = std::any_of(involved.begin(), involved.end(),
                               [&](int vertex) { return rig.jaw_weight(vertex) > 0; });
  if (compiled.turns)
    for (const int parameter : {rotation_parameter_, thrust_parameter_, shift_parameter_})
      if (parameter >= 0) compiled.columns.push_back(parameter);
  return compiled;
}

void VirtualMarkerEvaluator::CompileRing(const FaceRig& rig, int vertex, Marker* marker) const {
  const auto fan = FanAround(rig.neutral_mesh(), vertex);
  ARTICAP_CHECK(!fan.empty());

  // A ring vertex is one lane; where more than two triangles share an edge it is several.
  std::vector<int> lane_vertices;
  std::map<int, int> lane_without_next, lane_without_previous;
  const auto lane_of = [&](int ring_vertex, std::map<int, int>& wanting,
                           std::map<int, int>& other) {
    const auto found = wanting.find(ring_vertex);
    if (found != wanting.end()) {
      const int lane = found->second;
      wanting.erase(found);
      return lane;
    }
    const int lane = static_cast<int>(lane_vertices.size());
    lane_vertices.push_back(ring_vertex);
    other[ring_vertex] = lane;
    return lane;
  };
  std::vector<std::pair<int, int>> links;
  for (const auto& [a, b] : fan) {
    const int lane_a = lane_of(a, lane_without_next, lane_without_previous);
    const int lane_b = lane_of(b, lane_without_previous, lane_without_next);
    links.emplace_back(lane_a, lane_b);
  }

  const int num_edges = static_cast<int>(lane_vertices.size());
  const int num_lanes = (num_edges + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple;
  ARTICAP_CHECK_LE(num_lanes, kMaxLanes);
  marker->num_lanes = num_lanes;
  marker->next_lane.assign(num_lanes, num_lanes);
  marker->previous_lane.assign(num_lanes, num_lanes);
  for (const auto& [a, b] : links) {
    marker->next_lane[a] = b;
    marker->previous_lane[b] = a;
  }
  const int num_forms = 1 + marker->num_linear;
  marker->edge_forms.assign(static_cast<std::size_t>(num_forms) * 6 * num_lanes, 0);
  marker->edge_slide_weights.assign(num_lanes, 0);
  for (int lane = 0; lane < num_edges; ++lane) {
    const std::array<WeightedVertex, 2> edge = {{{vertex, -1}, {lane_vertices[lane], 1}}};
    const Form form = FormOf(rig, std::span(marker->columns).first(marker->num_linear), edge);
    for (int k = 0; k < num_forms; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        double* const rows = marker->edge_forms.data() + k * 6 * num_lanes;
        rows[axis * num_lanes + lane] = form.fixed(axis, k);
        rows[(3 + axis) * num_lanes + lane] = form.turned(axis, k);
      }
    marker->edge_slide_weights[lane] = form.slide_weight;
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
    return marker.num_lanes == 0 ? fixed : fixed + AddNormal<kWithJacobian>(pose, marker, jacobian);
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
  if (marker.num_lanes > 0) position += AddNormal<kWithJacobian>(pose, marker, jacobian);
  return position;
}

// The edges round v1 of a posed marker, one a lane; the lane beyond the last is always zero.
struct VirtualMarkerEvaluator::Ring {
  Lanes turned;       // the jaw-weighted arms, before the jaw turns
  Lanes edges;        // e_j
  Lanes differences;  // g_j = e_(j+1) - e_(j-1)
};

void VirtualMarkerEvaluator::PoseRing(const Pose& pose, const Marker& marker, Ring* ring) {
  const int lanes = marker.num_lanes;
  auto& [turned, edges, differences] = *ring;
  const double* const constant = marker.edge_forms.data();
  for (int axis = 0; axis < 3; ++axis) {
    std::copy_n(constant + axis * lanes, lanes, edges[axis].begin());
    std::copy_n(constant + (3 + axis) * lanes, lanes, turned[axis].begin());
  }
  for (int k = 0; k < marker.num_linear; ++k) {
    const double value = pose.parameters[marker.columns[k]];
    const double* const form = constant + (k + 1) * 6 * lanes;
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < lanes; ++lane) {
        edges[axis][lane] += value * form[axis * lanes + lane];
        turned[axis][lane] += value * form[(3 + axis) * lanes + lane];
      }
  }
  if (marker.turns) {
    const Eigen::Matrix3d& r = pose.jaw_rotation;
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < lanes; ++lane)
        edges[axis][lane] += r(axis, 0) * turned[0][lane] + r(axis, 1) * turned[1][lane] +
                             r(axis, 2) * turned[2][lane] +
                             marker.edge_slide_weights[lane] * pose.jaw_slide_mm[axis];
  }
  for (int axis = 0; axis < 3; ++axis) {
    edges[axis][lanes] = 0;
    for (int lane = 0; lane < lanes; ++lane)
      differences[axis][lane] =
          edges[axis][marker.next_lane[lane]] - edges[axis][marker.previous_lane[lane]];
  }
}

// u e1, and its derivatives added to the Jacobian. With edges e_j round v1, g_j = e_(j+1) -
// e_(j-1):
//   N = sum_j e_j x e_(j+1) = 1/2 sum_j e_j x g_j,   e1 = N / |N|.
template <bool kWithJacobian>
Eigen::Vector3d VirtualMarkerEvaluator::AddNormal(const Pose& pose, const Marker& marker,
                                                  double* jacobian) const {
  Ring ring;
  PoseRing(pose, marker, &ring);
  const Eigen::Vector3d normal =
      0.5 * CrossSum(marker.num_lanes, ring.edges[0].data(), ring.edges[1].data(),
                     ring.edges[2].data(), ring.differences);
  const double length = normal.norm();
  if (length == 0) return Eigen::Vector3d::Zero();
  if constexpr (kWithJacobian) AddNormalDerivatives(pose, marker, ring, normal, jacobian);
  return (marker.u_mm / length) * normal;
}

// dN = sum_j de_j x g_j and de1 = (I - e1 e1^T) dN / |N|; as (R f) x g = R (f x (R^T g)), the
// derivatives need no turning edge by edge.
void VirtualMarkerEvaluator::AddNormalDerivatives(const Pose& pose, const Marker& marker,
                                                  const Ring& ring, const Eigen::Vector3d& normal,
                                                  double* jacobian) const {
  const int lanes = marker.num_lanes;
  const Lanes& differences = ring.differences;
  const double length = normal.norm();
  const Eigen::Vector3d e1 = normal / length;
  const double factor = marker.u_mm / length;
  Eigen::Map<Jacobian> columns(jacobian, 3, static_cast<int>(marker.columns.size()));
  const auto add = [&](int column, const Eigen::Vector3d& d_normal) {
    columns.col(column) += factor * (d_normal - e1.dot(d_normal) * e1);
  };
  const auto form = [&](int k) { return marker.edge_forms.data() + (k + 1) * 6 * lanes; };
  if (!marker.turns) {
    for (int k = 0; k < marker.num_linear; ++k)
      add(k, CrossSum(lanes, form(k), form(k) + lanes, form(k) + 2 * lanes, differences));
    return;
  }

  Lanes turned_back;
  Turn(pose.jaw_rotation.transpose(), lanes, differences, &turned_back);
  for (int k = 0; k < marker.num_linear; ++k) {
    const double* const turned_form = form(k) + 3 * lanes;
    add(k, CrossSum(lanes, form(k), form(k) + lanes, form(k) + 2 * lanes, differences) +
               pose.jaw_rotation * CrossSum(lanes, turned_form, turned_form + lanes,
                                            turned_form + 2 * lanes, turned_back));
  }
  int column = marker.num_linear;
  if (rotation_parameter_ >= 0) {
    Lanes swung;
    Turn(pose.jaw_derivative, lanes, ring.turned, &swung);
    add(column++, CrossSum(lanes, swung[0].data(), swung[1].data(), swung[2].data(), differences));
  }
  Eigen::Vector3d weighted_difference = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < lanes; ++lane)
      weighted_difference[axis] += marker.edge_slide_weights[lane] * differences[axis][lane];
  if (thrust_parameter_ >= 0) add(column++, thrust_direction_.cross(weighted_difference));
  if (shift_parameter_ >= 0) add(column++, shift_direction_.cross(weighted_difference));
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
