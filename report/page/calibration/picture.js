// SPDX-License-Identifier: MIT
// What was seen where in a camera's picture: coverage and residuals.
import {formatNumber} from '../src/text.js';

import {cornersOf, countOf, isUsed, percent, pixels, quantile} from './statistics.js';
import {arrowPath, decimalsOf, figure, legend, niceBelow, svg} from './svg.js';

const kWidth = 440;  // of every picture, in the units of its drawing

function pictureSvg(camera, label, extraHeight = 0) {
  const height = kWidth * camera.height / camera.width;
  return svg('svg', {
    viewBox: `-1 -1 ${kWidth + 2} ${height + 2 + extraHeight}`,
    role: 'img',
    'aria-label': label
  });
}

function frameOf(camera) {
  return svg(
      'rect',
      {class: 'frame', x: 0, y: 0, width: kWidth, height: kWidth * camera.height / camera.width});
}

function hatchPattern(id) {
  return svg(
      'pattern',
      {id, width: 7, height: 7, patternUnits: 'userSpaceOnUse', patternTransform: 'rotate(45)'},
      svg('line', {class: 'hatch', x1: 0, x2: 0, y1: 0, y2: 7}));
}

let numHatches = 0;

export function coverageMap(camera) {
  const {columns, rows, part, corners_in_field: counts} = camera.coverage;
  const drawing = pictureSvg(camera, 'Number of corners in each field of the picture');
  const id = `hatch-${numHatches++}`;
  drawing.append(hatchPattern(id));
  const most = Math.max(1, ...counts);
  const [width, height] = [kWidth / columns, kWidth * camera.height / camera.width / rows];
  counts.forEach((count, i) => {
    const [x, y] = [(i % columns) * width, Math.floor(i / columns) * height];
    const shade = count === 0 ?
        {fill: `url(#${id})`} :
        {class: 'seen', 'fill-opacity': (0.1 + 0.55 * Math.sqrt(count / most)).toFixed(3)};
    drawing.append(
        svg('rect', {...shade, x, y, width, height}),
        svg('text',
            {class: 'count', x: x + width / 2, y: y + height / 2 + 4, 'text-anchor': 'middle'},
            formatNumber(count)));
  });
  drawing.append(frameOf(camera));
  const empty = counts.filter((count) => count === 0).length;
  return figure(
      'coverage', 'Coverage', drawing,
      `Corners seen in each field of the picture: ${percent(part)} of it is covered` +
          (empty > 0 ? `; in the ${countOf(empty, 'hatched field')} there were none.` : '.'));
}

/** Classes of the sightings' arrows: directly seen, in mirrors, set aside. */
function groupsOf(sightings, mirrors) {
  const used = sightings.filter(isUsed);
  const groups =
      [{name: 'direct', text: 'used', corners: cornersOf(used.filter(({mirror}) => mirror < 0))}];
  mirrors.forEach(({name}, i) => groups.push({
    name: `mirrored-${i % 2}`,
    text: `used, in the mirror ${name}`.replace('mirror mirror', 'mirror'),
    corners: cornersOf(used.filter(({mirror}) => mirror === i)),
  }));
  groups.push(
      {name: 'aside', text: 'set aside', corners: cornersOf(sightings.filter(({used}) => !used))});
  return groups.filter(({corners}) => corners.length > 0);
}

const lengthOf = ([, [x, y]]) => Math.hypot(x, y);

function scaleArrow(drawing, top, unitsPerPx) {
  const size = niceBelow(90 / unitsPerPx);
  const end = 2 + size * unitsPerPx;
  drawing.append(
      svg('path', {class: 'arrows scale', d: arrowPath([2, top], [end, top])}),
      svg('text', {x: end + 8, y: top + 4}, `${size.toFixed(decimalsOf(size))} px`));
}

export function residualArrows(camera, sightings, mirrors) {
  const kTypical = 15;  // length of an arrow of the 95th percentile, units of the drawing
  const kLongest = 45;
  const groups = groupsOf(sightings, mirrors);
  const drawing = pictureSvg(camera, 'Residuals as arrows over the picture', 22);
  const usual =
      groups.filter(({name}) => name !== 'aside').flatMap(({corners}) => corners.map(lengthOf));
  const typical_px = usual.length ? quantile(usual, 0.95) : 0;
  if (typical_px === 0) return null;
  const toDrawing = kWidth / camera.width;
  const enlarged = niceBelow(kTypical / (typical_px * toDrawing));
  const unitsPerPx = enlarged * toDrawing;
  let cut = 0;
  for (const {name, corners} of groups) {
    const paths = corners.map(([[u, v], [du, dv]]) => {
      const length = Math.hypot(du, dv) * unitsPerPx;
      if (length > kLongest) ++cut;
      const units = unitsPerPx * Math.min(1, kLongest / length);
      const from = [(u - du + 0.5) * toDrawing, (v - dv + 0.5) * toDrawing];
      return length === 0 ? '' : arrowPath(from, [from[0] + units * du, from[1] + units * dv]);
    });
    drawing.append(svg('path', {class: `arrows ${name}`, d: paths.join('')}));
  }
  drawing.append(frameOf(camera));
  scaleArrow(drawing, kWidth * camera.height / camera.width + 13, unitsPerPx);
  return figure(
      'residual-arrows', 'Residuals', drawing,
      legend(groups.map(
          ({name, text, corners}) => [name, `${text} (${countOf(corners.length, 'corner')})`])),
      `From where each corner should be towards where it was seen, ${
          formatNumber(enlarged)} times enlarged. ` +
          'Arrows that agree with their neighbours tell of a lens model that is too simple, or of ' +
          'a bent board.' +
          (cut > 0 ? ` ${countOf(cut, 'arrow')} of more than ${
                         pixels(kLongest / unitsPerPx)} drawn shorter.` :
                     ''));
}
