// SPDX-License-Identifier: MIT
// One view of the stage, drawn to scale.
import {formatNumber} from '../src/text.js';

import {arrowPath, linePath, niceBelow, svg} from './svg.js';

const kWidth = 600;
const kHeight = 400;
const kMargin = 34;
const kFoot = 34;     // for the scale bar and the axes
const kLetter = 7.2;  // of a label, at most usually
const kLine = 14;

// Of a label from its point.
const kDistances = [9, 24, 44];
const kDirections = [[1, 0], [-1, 0], [0, -1], [0, 1], [1, -1], [-1, -1], [1, 1], [-1, 1]];

const closed = (points) => `${linePath(points)}Z`;

/** Points of the outline of a polygon. */
function pointsAlong(polygon) {
  const kSteps = [0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875];
  return polygon.flatMap((from, i) => {
    const to = polygon[(i + 1) % polygon.length];
    return kSteps.map((step) => from.map((value, axis) => value + step * (to[axis] - value)));
  });
}

function boundsOf(points, view) {
  const [across, down] = [points.map(view.across), points.map(view.down)];
  return {
    left: Math.min(...across),
    right: Math.max(...across),
    top: Math.min(...down),
    bottom: Math.max(...down)
  };
}

function overlap(a, b) {
  return Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
      Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
}

export class SpaceDrawing {
  /** Drawings of several views at the same scale. */
  static alike(shapes, views) {
    const points = [
      ...shapes.boards.flat(), ...shapes.mirrors.flatMap(({outline}) => outline),
      ...shapes.cameras.flatMap(({centre, frustum}) => [centre, ...frustum])
    ];
    const bounds = views.map((view) => boundsOf(points, view));
    const unitsPerMm = Math.min(...bounds.map(
        ({left, right, top, bottom}) => Math.min(
            (kWidth - 2 * kMargin) / Math.max(1, right - left),
            (kHeight - 2 * kMargin) / Math.max(1, bottom - top))));
    return views.map((view, i) => new SpaceDrawing(view, bounds[i], unitsPerMm).draw(shapes));
  }

  constructor(view, bounds, unitsPerMm) {
    this.view = view;
    this.unitsPerMm = unitsPerMm;
    this.middle = [(bounds.left + bounds.right) / 2, (bounds.top + bounds.bottom) / 2];
    this.height = Math.max(160, (bounds.bottom - bounds.top) * unitsPerMm + 2 * kMargin);
    this.labels = [];
  }

  place(point) {
    return [
      kWidth / 2 + this.unitsPerMm * (this.view.across(point) - this.middle[0]),
      this.height / 2 + this.unitsPerMm * (this.view.down(point) - this.middle[1])
    ];
  }

  draw({boards, cameras, mirrors}) {
    this.svg = svg('svg', {
      viewBox: `0 0 ${kWidth} ${this.height + kFoot}`,
      role: 'img',
      'aria-label': this.view.label
    });
    for (const board of boards) this.polygon(board, 'board');
    for (const {outline} of mirrors) this.polygon(outline, 'mirror');
    for (const camera of cameras) this.drawCamera(camera);
    const obstacles = [
      ...cameras.flatMap(
          ({centre, frustum}) =>
              [...pointsAlong(frustum),
               ...frustum.flatMap((corner) => pointsAlong([centre, corner]))]),
      ...mirrors.flatMap(({outline}) => pointsAlong(outline))
    ].map((point) => this.place(point));
    for (const {name, centre} of cameras) this.label(name, this.place(centre), obstacles);
    for (const {name, outline} of mirrors) this.label(name, this.place(outline[0]), obstacles);
    this.drawScaleBar();
    this.drawAxes();
    return this.svg;
  }

  polygon(points, className) {
    this.svg.append(
        svg('path', {class: className, d: closed(points.map((point) => this.place(point)))}));
  }

  drawCamera({kind, centre, frustum}) {
    const [apex, ...corners] = [centre, ...frustum].map((point) => this.place(point));
    this.svg.append(
        svg('path', {
          class: kind,
          d: closed(corners) + corners.map((corner) => linePath([apex, corner])).join('')
        }),
        svg('circle', {class: `${kind} centre`, cx: apex[0], cy: apex[1], r: 3.5}));
  }

  /** Beside its point, where it covers least. */
  label(text, [x, y], obstacles) {
    const width = kLetter * text.length;
    const boxes = kDistances.flatMap((distance) => kDirections.map(([right, down]) => {
      const middle = [x + right * (distance + width / 2), y + down * (distance + kLine / 2)];
      return {
        left: middle[0] - width / 2,
        right: middle[0] + width / 2,
        top: middle[1] - kLine / 2,
        bottom: middle[1] + kLine / 2,
        anchor: ['end', 'middle', 'start'][right + 1],
        distance,
      };
    }));
    const frame = {left: 0, right: kWidth, top: 0, bottom: this.height};
    const costOf = (box) => box.distance + 10 * (width * kLine - overlap(box, frame)) +
        this.labels.reduce((sum, other) => sum + 10 * overlap(box, other), 0) +
        100 *
            obstacles
                .filter(
                    ([px, py]) =>
                        px > box.left - 2 && px < box.right + 2 && py > box.top && py < box.bottom)
                .length;
    const best = boxes.reduce((least, box) => costOf(box) < costOf(least) ? box : least);
    this.labels.push(best);
    const at = {
      start: best.left,
      middle: (best.left + best.right) / 2,
      end: best.right
    }[best.anchor];
    this.svg.append(svg(
        'text', {class: 'label', x: at, y: best.bottom - 3.5, 'text-anchor': best.anchor}, text));
  }

  drawScaleBar() {
    const length_mm = niceBelow(130 / this.unitsPerMm);
    const [left, right, y] = [14, 14 + length_mm * this.unitsPerMm, this.height + kFoot - 14];
    this.svg.append(
        svg('path', {
          class: 'scale-bar',
          d: `M${left} ${y - 5}V${y + 5}M${left} ${y}H${right}M${right} ${y - 5}V${y + 5}`
        }),
        svg('text', {x: right + 8, y: y + 4}, `${formatNumber(length_mm)} mm`));
  }

  drawAxes() {
    const {right, up, down} = this.view.axes;
    const [x, y] = [kWidth - 70, this.height + kFoot - 14];
    const from = up ? [x, y] : [x, y - 26];
    const tip = up ? [x, y - 30] : [x, y + 4];
    this.svg.append(
        svg('path', {class: 'axes', d: arrowPath(from, [x + 30, from[1]]) + arrowPath(from, tip)}),
        svg('text', {x: x + 36, y: from[1] + 4}, right),
        svg('text', {x: x - 6, y: tip[1] + 4, 'text-anchor': 'end'}, up ?? down));
  }
}
