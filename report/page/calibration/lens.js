// SPDX-License-Identifier: MIT
// A lens: its numbers, and its distortion drawn. The model is that of core/camera.h.
import {element, formatFixed, formatNumber, withUnit} from '../src/text.js';

import {isUsed, pixels} from './statistics.js';
import {decimalsOf, figure, legend, linePath, niceBelow, Plot, svg} from './svg.js';

const radialOf = ({k1, k2, k3, k4, k5, k6}, r2) =>
    (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));

function distort(lens, [x, y]) {
  const r2 = x * x + y * y;
  const radial = radialOf(lens, r2);
  return [
    x * radial + 2 * lens.p1 * x * y + lens.p2 * (r2 + 2 * x * x),
    y * radial + lens.p1 * (r2 + 2 * y * y) + 2 * lens.p2 * x * y
  ];
}

const kMeanings = {
  fx_px: 'focal length, horizontal',
  fy_px: 'focal length, vertical',
  cx_px: 'axis meets the picture, from left',
  cy_px: 'axis meets the picture, from top',
  k1: 'radial distortion, r³',
  k2: 'radial distortion, r⁵',
  p1: 'tangential distortion',
  p2: 'tangential distortion',
  k3: 'radial distortion, r⁷',
  k4: 'radial distortion, divisor r²',
  k5: 'radial distortion, divisor r⁴',
  k6: 'radial distortion, divisor r⁶',
};

/** [value, sigma] to two digits of the sigma. */
export function withSigma(value, sigma) {
  if (sigma === null) return [formatNumber(value, 6), 'not known'];
  if (sigma === 0) return [formatNumber(value, 6), 'held'];
  const decimals = Math.min(8, decimalsOf(sigma) + 1);
  return [formatFixed(value, decimals), formatFixed(sigma, decimals)];
}

export function lensTable({lens, lens_sigmas: sigmas, width, height}) {
  const rows =
      Object.keys(lens)
          .filter((name) => name.endsWith('_px') || lens[name] !== 0 || sigmas[name])
          .map((name) => {
            const [value, sigma] = withSigma(lens[name], sigmas[name]);
            return element(
                'tr', {}, element('td', {}, name.replace('_px', ' (px)')), element('td', {}, value),
                element('td', {}, sigma), element('td', {class: 'text'}, kMeanings[name]));
          });
  const field_deg = (size, focal) =>
      withUnit(formatFixed(2 * Math.atan(size / 2 / focal) * 180 / Math.PI, 1), '°');
  return figure(
      'lens-table', 'Lens',
      element(
          'table', {class: 'numbers'},
          element('tr', {}, ...['', 'value', 'sigma', ''].map((text) => element('th', {}, text))),
          ...rows),
      'Sigma: standard deviation. Field of view without distortion: ' +
          `${field_deg(width, lens.fx_px)} by ${field_deg(height, lens.fy_px)}.`);
}

const distanceFromAxis = ({lens}) => ([u, v]) => Math.hypot(u - lens.cx_px, v - lens.cy_px);

function farthestCorner(camera) {
  const [right, bottom] = [camera.width - 0.5, camera.height - 0.5];
  return Math.max(...[[-0.5, -0.5], [right, -0.5], [-0.5, bottom], [right, bottom]].map(
      distanceFromAxis(camera)));
}

/**
 * [radius in the picture, radial displacement], px, out to the picture's farthest corner or to
 * where the lens folds.
 */
function radialCurve({lens}, farthest_px) {
  const kSteps = 200;
  const kMostSteps = 1000;  // a lens may press a wide field into the picture
  const curve = [[0, 0]];
  for (let i = 1; i <= kMostSteps && curve.at(-1)[0] < farthest_px; ++i) {
    const ideal_px = farthest_px * i / kSteps;
    const seen_px = ideal_px * radialOf(lens, (ideal_px / lens.fx_px) ** 2);
    if (!(seen_px > curve.at(-1)[0])) break;
    curve.push([seen_px, seen_px - ideal_px]);
  }
  const [from, before] = curve.at(-2) ?? curve[0];
  const [to, after] = curve.at(-1);
  if (to > farthest_px)
    curve[curve.length - 1] =
        [farthest_px, before + (after - before) * (farthest_px - from) / (to - from)];
  return curve;
}

export function distortionCurve(camera, sightings) {
  const farthest_px = farthestCorner(camera);
  const curve = radialCurve(camera, farthest_px);
  const displacements = curve.map(([, displacement]) => displacement);
  const [low, high] = [Math.min(0, ...displacements), Math.max(0, ...displacements)];
  if (high - low < 1e-3) return null;
  const margin = 0.06 * (high - low);
  const plot = new Plot({
    x: [0, farthest_px],
    y: [low < 0 ? low - margin : 0, high > 0 ? high + margin : 0],
    xLabel: 'distance from the lens’ axis, px',
    yLabel: 'displacement outwards, px',
    label: 'Radial distortion',
  });
  const seen_px = sightings.filter(isUsed)
                      .flatMap(({points_px: points}) => points)
                      .map(distanceFromAxis(camera))
                      .reduce((most, radius) => Math.max(most, radius), 0);
  const last = Math.max(0, curve.findLastIndex(([radius]) => radius <= seen_px));
  if (last > 0) {
    plot.line(curve.slice(0, last + 1), 'curve');
    if (seen_px < 0.995 * farthest_px)
      plot.mark(seen_px, 'corners seen up to here', 'limit', {anchor: 'end', atFoot: -low > high});
  }
  plot.line(curve.slice(last), last > 0 ? 'curve unseen' : 'curve');
  return figure(
      'distortion-curve', 'Radial distortion', plot.svg,
      `How far points appear from where a lens without distortion would show them, at most ` +
          `${pixels(Math.max(high, -low))}. The axis ends at the farthest corner of the picture` +
          (last > 0 && seen_px < 0.995 * farthest_px ? '; the dashed part is extrapolated.' : '.') +
          (curve.at(-1)[0] < 0.99 * farthest_px ?
               ' Where the curve ends, the distortion folds the picture over: nothing can be ' +
                   'measured beyond.' :
               ''));
}

/** Lines of a grid, as points of the picture. */
function gridLines({width, height}) {
  const kColumns = 16;
  const kPoints = 60;
  const rows = Math.round(kColumns * height / width);
  const along = Array.from({length: kPoints + 1}, (_, i) => i / kPoints);
  const at = (x, y) => [x * width - 0.5, y * height - 0.5];
  return [
    ...Array.from({length: kColumns + 1}, (_, i) => along.map((t) => at(i / kColumns, t))),
    ...Array.from({length: rows + 1}, (_, i) => along.map((t) => at(t, i / rows)))
  ];
}

export function distortionGrid(camera) {
  const kScale = 440 / camera.width;
  const {lens} = camera;
  const moved = ([u, v]) => {
    const [x, y] = distort(lens, [(u - lens.cx_px) / lens.fx_px, (v - lens.cy_px) / lens.fy_px]);
    return [lens.fx_px * x + lens.cx_px - u, lens.fy_px * y + lens.cy_px - v];
  };
  const lines = gridLines(camera);
  const largest_px = Math.max(...lines.flat().map((point) => Math.hypot(...moved(point))));
  if (!(largest_px > 1e-3)) return null;
  const enlarged = Math.max(1, niceBelow(0.06 * camera.width / largest_px));
  const drawn = lines.map((line) => line.map((point) => {
    const [du, dv] = moved(point);
    return [kScale * (point[0] + enlarged * du), kScale * (point[1] + enlarged * dv)];
  }));
  const straight =
      lines.map((line) => [line[0], line.at(-1)].map(([u, v]) => [kScale * u, kScale * v]));
  const points = [...drawn.flat(), ...straight.flat()];
  const [left, right] = [Math.min(...points.map(([x]) => x)), Math.max(...points.map(([x]) => x))];
  const [top, bottom] =
      [Math.min(...points.map(([, y]) => y)), Math.max(...points.map(([, y]) => y))];
  const drawing = svg(
      'svg', {
        viewBox: `${left - 2} ${top - 2} ${right - left + 4} ${bottom - top + 4}`,
        role: 'img',
        'aria-label': 'A grid as the lens shows it'
      },
      svg('path', {class: 'straight', d: straight.map(linePath).join('')}),
      svg('path', {class: 'distorted', d: drawn.map(linePath).join('')}),
      svg('circle', {class: 'axis-point', cx: kScale * lens.cx_px, cy: kScale * lens.cy_px, r: 4}));
  return figure(
      'distortion-grid', 'A grid as the lens shows it', drawing, legend([
        ['straight', 'without distortion'],
        [
          'distorted',
          enlarged > 1 ? `with it, ${formatNumber(enlarged)} times enlarged` : 'with it'
        ]
      ]),
      'The dot is where the lens’ axis meets the picture. The grid, which fills the picture, is ' +
          `displaced by at most ${pixels(largest_px)}.`);
}
