// SPDX-License-Identifier: MIT
// Drawings: elements, scales, arrows, and plots with two axes.
import {element, formatFixed} from '../src/text.js';

export function svg(tag, attributes = {}, ...children) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** A card with a heading, a drawing and what is said of it. */
export function figure(id, heading, drawing, ...captions) {
  return element(
      'figure', {class: `card ${id}`}, element('h3', {}, heading), drawing,
      ...captions.filter(Boolean).map((caption) => element('figcaption', {}, caption)));
}

/** [[class of the swatch, text], ...] */
export function legend(entries) {
  return element(
      'span', {class: 'legend'},
      ...entries.map(([swatch, text]) => element('span', {}, element('i', {class: swatch}), text)));
}

export const fixed = (number) => Number(number.toFixed(2));

export const linePath = (points) =>
    points.map(([x, y], i) => `${i ? 'L' : 'M'}${fixed(x)} ${fixed(y)}`).join('');

export function arrowPath([x0, y0], [x1, y1]) {
  const length = Math.hypot(x1 - x0, y1 - y0);
  if (length === 0) return '';
  const head = Math.min(4, 0.35 * length);
  const [along, across] =
      [[(x1 - x0) / length, (y1 - y0) / length], [(y0 - y1) / length, (x1 - x0) / length]];
  const barb = (side) =>
      [x1 - head * (along[0] - side * 0.5 * across[0]),
       y1 - head * (along[1] - side * 0.5 * across[1])];
  return linePath([[x0, y0], [x1, y1]]) + linePath([barb(1), [x1, y1], barb(-1)]);
}

/** The largest of 1, 2 or 5 times a power of ten that is not above the number. */
export function niceBelow(number) {
  const power = 10 ** Math.floor(Math.log10(number) + 1e-9);
  return [5, 2, 1].find((factor) => factor * power <= number * (1 + 1e-9)) * power;
}

export function decimalsOf(step) {
  return Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
}

function ticksOf([low, high], most) {
  let step = niceBelow((high - low) / most);
  while ((high - low) / step > most) step *= 2;
  step = niceBelow(step * 1.3);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
    ticks.push(i * step);
  return {ticks, decimals: decimalsOf(step)};
}

/** A plot of a fixed size in its own units; the page scales it. */
export class Plot {
  constructor({x, y, xLabel, yLabel, label}) {
    Object.assign(this, {x, y, width: 440, height: 270, left: 58, right: 12, top: 12, bottom: 42});
    this.svg =
        svg('svg', {viewBox: `0 0 ${this.width} ${this.height}`, role: 'img', 'aria-label': label});
    this.drawAxes(xLabel, yLabel);
  }

  px(value) {
    return this.left +
        (value - this.x[0]) / (this.x[1] - this.x[0]) * (this.width - this.left - this.right);
  }

  py(value) {
    return this.height - this.bottom -
        (value - this.y[0]) / (this.y[1] - this.y[0]) * (this.height - this.top - this.bottom);
  }

  drawAxes(xLabel, yLabel) {
    const bottom = this.height - this.bottom;
    const horizontal = ticksOf(this.x, 7);
    for (const tick of horizontal.ticks)
      this.svg.append(
          svg('line',
              {class: 'tick', x1: this.px(tick), x2: this.px(tick), y1: bottom, y2: bottom + 4}),
          svg('text', {x: this.px(tick), y: bottom + 16, 'text-anchor': 'middle'},
              formatFixed(tick, horizontal.decimals)));
    const vertical = ticksOf(this.y, 5);
    for (const tick of vertical.ticks)
      this.svg.append(
          svg('line', {
            class: 'rule',
            x1: this.left,
            x2: this.width - this.right,
            y1: this.py(tick),
            y2: this.py(tick)
          }),
          svg('text', {x: this.left - 6, y: this.py(tick) + 4, 'text-anchor': 'end'},
              formatFixed(tick, vertical.decimals)));
    const middle = (this.top + bottom) / 2;
    this.svg.append(
        svg('line',
            {class: 'axis', x1: this.left, x2: this.width - this.right, y1: bottom, y2: bottom}),
        svg('text', {
          class: 'name',
          x: (this.left + this.width - this.right) / 2,
          y: this.height - 8,
          'text-anchor': 'middle'
        },
            xLabel),
        svg('text', {
          class: 'name',
          transform: `translate(13 ${middle}) rotate(-90)`,
          'text-anchor': 'middle'
        },
            yLabel));
  }

  line(points, className) {
    this.svg.append(svg(
        'path', {class: className, d: linePath(points.map(([x, y]) => [this.px(x), this.py(y)]))}));
  }

  bar(from, to, height, className) {
    const [left, right, top] = [this.px(from), this.px(to), this.py(height)];
    this.svg.append(svg('rect', {
      class: className,
      x: left + 0.4,
      width: right - left - 0.8,
      y: top,
      height: this.py(0) - top
    }));
  }

  /** A vertical line with a word beside its top or its foot. */
  mark(value, text, className, {anchor = 'start', atFoot = false} = {}) {
    const x = this.px(value);
    this.svg.append(
        svg('line', {class: className, x1: x, x2: x, y1: this.top, y2: this.height - this.bottom}),
        svg('text', {
          class: 'label',
          x: x + (anchor === 'start' ? 5 : -5),
          y: atFoot ? this.py(this.y[0]) - 8 : this.top + 10,
          'text-anchor': anchor
        },
            text));
  }
}

/** Bars of how often values fall into bins, and the Gaussian they should follow. */
export function histogramPlot(values, {mean, sigma, limit, axes}) {
  const kBins = 36;
  const [low, high] = [mean - limit, mean + limit];
  const width = (high - low) / kBins;
  const counts = new Array(kBins).fill(0);
  for (const value of values) {
    const bin = Math.floor((value - low) / width);
    if (bin >= 0 && bin < kBins) ++counts[bin];
  }
  const peak = values.length * width / (sigma * Math.sqrt(2 * Math.PI));
  const plot = new Plot({...axes, x: [low, high], y: [0, 1.08 * Math.max(peak, ...counts)]});
  counts.forEach((count, i) => plot.bar(low + i * width, low + (i + 1) * width, count, 'bar'));
  const curve = Array.from({length: 121}, (_, i) => low + (high - low) * i / 120);
  plot.line(curve.map((x) => [x, peak * Math.exp(-0.5 * ((x - mean) / sigma) ** 2)]), 'curve');
  return plot;
}
