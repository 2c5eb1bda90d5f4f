// SPDX-License-Identifier: MIT
// Decoding of what report/page_data.cc packs.

const kMissing = -32768;

export function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Quantised numbers as Float32Array, NaN where missing. */
export function numbersOf(packed) {
  const codes = new Int16Array(bytesOf(packed.data).buffer);
  const numbers = new Float32Array(codes.length);
  for (let i = 0; i < codes.length; ++i)
    numbers[i] = codes[i] === kMissing ? NaN : packed.offset + packed.scale * codes[i];
  return numbers;
}

export function indicesOf(packed) {
  const buffer = bytesOf(packed.data).buffer;
  return packed.bytes === 2 ? new Uint16Array(buffer) : new Uint32Array(buffer);
}

/** {low, high}: the same array twice where a point is a frame. */
export function seriesOf(packed) {
  const low = numbersOf(packed.low);
  return {low, high: packed.high ? numbersOf(packed.high) : low};
}

export function extentOf(...arrays) {
  let low = Infinity;
  let high = -Infinity;
  for (const numbers of arrays)
    for (const number of numbers) {
      if (number < low) low = number;
      if (number > high) high = number;
    }
  return low <= high ? [low, high] : null;
}

/** Runs [first frame, code, ...] as [{begin, end, code}], end not included. */
export function runsOf(flat, numFrames) {
  const runs = [];
  for (let i = 0; i < flat.length; i += 2)
    runs.push({begin: flat[i], end: i + 2 < flat.length ? flat[i + 2] : numFrames, code: flat[i + 1]});
  return runs;
}

/** The run that holds the frame. */
export function runAt(runs, frame) {
  let low = 0;
  let high = runs.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (runs[middle].begin <= frame) low = middle;
    else high = middle - 1;
  }
  return runs[low];
}
