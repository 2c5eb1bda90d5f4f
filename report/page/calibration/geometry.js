// SPDX-License-Identifier: MIT
// Points of the stage, mm, as arrays of three.

export const plus = (a, b) => a.map((value, i) => value + b[i]);
export const minus = (a, b) => a.map((value, i) => value - b[i]);
export const times = (factor, a) => a.map((value) => factor * value);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross =
    (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** By the quaternion [w, x, y, z]. */
export function rotate([w, ...axis], point) {
  const turn = times(2, cross(axis, point));
  return plus(plus(point, times(w, turn)), cross(axis, turn));
}

export const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];

export const applied = ({rotation_wxyz: rotation, translation_mm: translation}, point) =>
    plus(rotate(rotation, point), translation);

export const appliedInverse = ({rotation_wxyz: rotation, translation_mm: translation}, point) =>
    rotate(conjugate(rotation), minus(point, translation));

export function reflected({normal_in_stage: normal, distance_mm: distance}, point) {
  return minus(point, times(2 * (dot(normal, point) - distance), normal));
}

/** Where a line from one point to another meets the mirror's plane. */
export function meetingPoint({normal_in_stage: normal, distance_mm: distance}, from, to) {
  const along = minus(to, from);
  return plus(from, times((distance - dot(normal, from)) / dot(normal, along), along));
}

/** The rectangle around points of a plane, which has one pair of sides as level as can be. */
export function rectangleAround(normal, points) {
  const kDown = [0, 1, 0];
  const side = cross(normal, Math.abs(normal[1]) < 0.9 ? kDown : [1, 0, 0]);
  const right = times(1 / Math.sqrt(dot(side, side)), side);
  const down = cross(normal, right);
  const across = points.map((point) => dot(right, point));
  const along = points.map((point) => dot(down, point));
  const height = dot(normal, points[0]);
  const corner = (x, y) => plus(times(height, normal), plus(times(x, right), times(y, down)));
  const [low, high] = [Math.min(...across), Math.max(...across)];
  const [top, bottom] = [Math.min(...along), Math.max(...along)];
  return [corner(low, top), corner(high, top), corner(high, bottom), corner(low, bottom)];
}
