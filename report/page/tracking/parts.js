// SPDX-License-Identifier: MIT
// What the parts of the page have in common.
import {element} from '../src/text.js';

export function part(id, heading, explains, ...children) {
  return element(
      'section', {class: 'part', id}, element('h2', {}, heading),
      element('p', {class: 'explains'}, explains), ...children);
}

/** How a frame of the recording is called: "frame 120, 1.98 s". */
export function frameText(frame, {rate_hz: rate, first_frame: first}) {
  return `frame ${frame}, ${((frame - first) / rate).toFixed(2)}\u202fs`;
}

export function medianOf(values) {
  const known = values.filter((value) => value !== null).sort((a, b) => a - b);
  return known.length > 0 ? known[known.length >> 1] : null;
}
