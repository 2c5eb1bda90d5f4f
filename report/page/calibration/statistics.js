// SPDX-License-Identifier: MIT
// Figures of the sightings, and their numbers as people read them.
import {formatFixed, formatNumber, withUnit} from '../src/text.js';

export const pixels = (value) => withUnit(formatNumber(value, 3), 'px');
export const millimetres = (value) => withUnit(formatNumber(value, 3), 'mm');
export const percent = (part) => `${formatFixed(100 * part, part > 0.9 && part < 1 ? 1 : 0)}%`;
export const isKnown = (value) => value !== null && value !== undefined;

export function countOf(count, what) {
  return `${formatNumber(count)} ${what}${count === 1 ? '' : 's'}`;
}

export const isUsed = ({used}) => used;

/** [[corner, residual], ...] of sightings whose pose was found. */
export function cornersOf(sightings) {
  return sightings.flatMap(
      ({points_px: points, residuals_px: residuals}) =>
          residuals.map((residual, i) => [points[i], residual]));
}

/** Not to be called with none. */
export function quantile(values, part) {
  const sorted = Float64Array.from(values).sort();
  return sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
}

/** "003.png", "003.png in the mirror left" */
export function nameOf({source, mirror}, mirrors) {
  return mirror < 0 ?
      source :
      `${source} in the mirror ${mirrors[mirror].name}`.replace('mirror mirror', 'mirror');
}
