// SPDX-License-Identifier: MIT
// The rig in its compact form (rig/face_rig.h): with n the neutral vertex, d_k the displacement per
// unit of parameter k, w the jaw's weight, c its pivot,
//   m = n + sum y_k d_k,   x = m + w ((R - I)(m - c) + thrust t + shift s).
import {bytesOf, indicesOf, numbersOf} from './data.js';

/** R - I of a turn about an axis, row by row (Rodrigues). */
function turnMinusIdentity([x, y, z], angle) {
  const s = Math.sin(angle);
  const c = 1 - Math.cos(angle);
  return [
    -c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y,
    c * x * y + s * z, -c * (x * x + z * z), c * y * z - s * x,
    c * x * z - s * y, c * y * z + s * x, -c * (x * x + y * y),
  ];
}

/** A byte of sRGB as linear light. */
function linearOf(byte) {
  const value = byte / 255;
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

export class Rig {
  constructor(packed) {
    this.name = packed.name;
    this.neutral = numbersOf(packed.vertices);
    this.colors = Float32Array.from(bytesOf(packed.colors), linearOf);
    this.parts = packed.parts.map((part) => ({name: part.name, corners: indicesOf(part.triangles)}));
    this.fields = packed.fields.map((field) => ({
      vertices: indicesOf(field.vertices),
      displacements: numbersOf(field.displacements),
    }));
    this.jaw = packed.jaw && {
      ...packed.jaw,
      vertices: indicesOf(packed.jaw.vertices),
      weights: numbersOf(packed.jaw.weights),
    };
    this.positions = Float32Array.from(this.neutral);
    this.normals = new Float32Array(this.neutral.length);
  }

  /** Poses this.positions and this.normals; values in the order of the rig's parameters. */
  pose(values) {
    const out = this.positions;
    out.set(this.neutral);
    this.fields.forEach(({vertices, displacements}, k) => {
      const y = values[k];
      if (!y) return;
      for (let i = 0; i < vertices.length; ++i)
        for (let axis = 0; axis < 3; ++axis)
          out[3 * vertices[i] + axis] += y * displacements[3 * i + axis];
    });
    if (this.jaw) this.moveJaw(values);
    this.updateNormals();
  }

  moveJaw(values) {
    const {vertices, weights, pivot, axis, thrust_direction, shift_direction} = this.jaw;
    const of = (parameter) => (parameter >= 0 ? values[parameter] : 0);
    const turn = turnMinusIdentity(axis, of(this.jaw.rotation_parameter));
    const thrust = of(this.jaw.thrust_parameter);
    const shift = of(this.jaw.shift_parameter);
    const slide = [0, 1, 2].map((k) => thrust * thrust_direction[k] + shift * shift_direction[k]);
    const out = this.positions;
    for (let i = 0; i < vertices.length; ++i) {
      const at = 3 * vertices[i];
      const x = out[at] - pivot[0];
      const y = out[at + 1] - pivot[1];
      const z = out[at + 2] - pivot[2];
      for (let k = 0; k < 3; ++k)
        out[at + k] += weights[i] *
            (turn[3 * k] * x + turn[3 * k + 1] * y + turn[3 * k + 2] * z + slide[k]);
    }
  }

  /** Area-weighted unit normals over all parts. */
  updateNormals() {
    const p = this.positions;
    const n = this.normals;
    n.fill(0);
    for (const {corners} of this.parts)
      for (let i = 0; i < corners.length; i += 3) {
        const a = 3 * corners[i];
        const b = 3 * corners[i + 1];
        const c = 3 * corners[i + 2];
        const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
        const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
        const x = uy * vz - uz * vy;
        const y = uz * vx - ux * vz;
        const z = ux * vy - uy * vx;
        for (const corner of [a, b, c]) {
          n[corner] += x;
          n[corner + 1] += y;
          n[corner + 2] += z;
        }
      }
    for (let i = 0; i < n.length; i += 3) {
      const length = Math.hypot(n[i], n[i + 1], n[i + 2]) || 1;
      n[i] /= length;
      n[i + 1] /= length;
      n[i + 2] /= length;
    }
  }
}
