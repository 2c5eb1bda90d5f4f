// SPDX-License-Identifier: MIT
// Every marker over time, a row each: who was seen, how far the views disagree, how sure the label.
import {legend} from '../calibration/svg.js';
import {cssColor, element, formatNumber} from '../src/text.js';

import {frameText, medianOf, part} from './parts.js';

const kRow = 17;
const kAxis = 24;

/** By number of the origin; the order in which they are drawn: what is worse lies above. */
const kOrigins = [
  {name: 'missing', swatch: 'gap', color: '--muted'},
  {name: 'filled', swatch: 'filled', color: '--warm'},
  {name: 'one view', swatch: 'one-view', color: '--violet'},
  {name: 'two views or more', swatch: 'measured', color: '--accent'},
];

/** A canvas of all markers with a time axis; `drawRow(context, marker, x, top, height)`. */
class StripChart {
  constructor(review, drawRow, readout) {
    Object.assign(this, {review, drawRow, readout});
    this.canvas = element('canvas', {'aria-hidden': 'true'});
    this.says = element('p', {class: 'readout'}, '\u00a0');
    const names = review.markers.map(({name}) => element('li', {title: name}, name));
    this.element = element(
        'div', {class: 'card strips'},
        element('div', {class: 'strip-grid'}, element('ol', {class: 'names'}, ...names), this.canvas),
        this.says);
    this.canvas.addEventListener('mousemove', (event) => this.point(event));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
  }

  draw() {
    const {markers, frames} = this.review;
    const width = this.canvas.clientWidth;
    const height = kRow * markers.length + kAxis;
    const scale = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * scale);
    this.canvas.height = Math.round(height * scale);
    this.canvas.style.height = `${height}px`;
    const context = this.canvas.getContext('2d');
    context.scale(scale, scale);
    const x = (frame) => frame / Math.max(1, frames) * width;
    markers.forEach((marker, i) => this.drawRow(context, marker, x, i * kRow + 2, kRow - 4));
    this.drawAxis(context, x, width, kRow * markers.length);
  }

  drawAxis(context, x, width, top) {
    const {frames, rate_hz: rate} = this.review;
    const seconds = frames / rate;
    const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600];
    const step = steps.find((one) => seconds / one <= Math.max(2, width / 80)) ?? 1800;
    context.fillStyle = context.strokeStyle = cssColor('--muted');
    context.font = '11.5px sans-serif';
    context.textBaseline = 'top';
    context.beginPath();
    context.moveTo(0, top + 2.5);
    context.lineTo(width, top + 2.5);
    for (let i = 0; i * step <= seconds + 1e-9; ++i) {
      const at = x(i * step * rate);
      context.moveTo(at + 0.5, top + 2);
      context.lineTo(at + 0.5, top + 6);
      const text = `${Number((i * step).toFixed(1))} s`;
      const wide = context.measureText(text).width;
      context.fillText(text, Math.min(width - wide, Math.max(0, at - wide / 2)), top + 9);
    }
    context.stroke();
  }

  point(event) {
    const box = this.canvas.getBoundingClientRect();
    const {markers, frames, first_frame: first} = this.review;
    const marker = markers[Math.floor((event.clientY - box.top) / kRow)];
    const frame = Math.floor((event.clientX - box.left) / box.width * frames);
    if (!marker || frame < 0 || frame >= frames) return;
    this.says.textContent = `${marker.name}, ${frameText(first + frame, this.review)}: ${
        this.readout(marker, frame)}`;
  }
}

function drawOrigins(context, {runs}, x, top, height) {
  for (let origin = kOrigins.length - 1; origin >= 0; --origin) {
    context.fillStyle = cssColor(kOrigins[origin].color);
    let frame = 0;
    for (const [code, count] of runs) {
      // Missing samples are a thin line: what is not there should not shout.
      const [y, tall] = origin === 0 ? [top + height / 2 - 1.5, 3] : [top, height];
      if (code === origin) {
        const left = x(frame), wide = Math.max(1, x(frame + count) - x(frame));
        if (origin < 3) context.clearRect(left, top, wide, height);
        context.fillRect(left, y, wide, tall);
      }
      frame += count;
    }
  }
}

function originAt({runs}, frame) {
  let end = 0;
  for (const [code, count] of runs) {
    end += count;
    if (frame < end) return kOrigins[code].name;
  }
  return '';
}

function drawHeat(values, framesPerBin, color, shareOf) {
  return (context, marker, x, top, height) => {
    context.fillStyle = cssColor('--outside');
    context.fillRect(0, top, x(values(marker).length * framesPerBin), height);
    context.fillStyle = cssColor(color);
    values(marker).forEach((value, bin) => {
      if (value === null) return;
      context.globalAlpha = Math.min(1, Math.max(0, shareOf(value)));
      const left = x(bin * framesPerBin);
      context.fillRect(left, top, Math.max(1, x((bin + 1) * framesPerBin) - left), height);
    });
    context.globalAlpha = 1;
  };
}

function heatPart(review, {id, heading, explains, values, color, shareOf, unit}) {
  if (!review.markers.some((marker) => values(marker).some((value) => value !== null))) return [];
  const per = review.frames_per_bin;
  const chart = new StripChart(
      review, drawHeat(values, per, color, shareOf),
      (marker, frame) => {
        const value = values(marker)[Math.floor(frame / per)];
        return value === null ? 'none' : `${formatNumber(value, 3)}${unit}`;
      });
  return [part(id, heading, explains, chart.element)];
}

export function stripsParts(review) {
  const seen = new StripChart(review, drawOrigins, originAt);
  seen.element.prepend(legend(
      [...kOrigins].reverse().map(({swatch, name}) =>
          [swatch, review.views.length === 0 && swatch === 'measured' ? 'in the file' : name])));
  const usual_px =
      medianOf(review.markers.flatMap(({largest_residuals_px: values}) => values)) ?? 1;
  const kSure = 10;
  return [
    part(
        'seen', 'Who was seen when',
        'A row is a marker, time runs to the right. What one view alone sees has an estimated ' +
            'depth; what is filled was seen by none.',
        seen.element),
    ...heatPart(review, {
      id: 'residuals',
      heading: 'How far the views disagree',
      explains: `Residual of each sample, px; the strongest colour is four times the usual ${
          formatNumber(usual_px, 3)}\u202fpx or more. Grey: fewer than two views.`,
      values: (marker) => marker.largest_residuals_px,
      color: '--warm',
      shareOf: (value) => value / (4 * usual_px),
      unit: '\u202fpx',
    }),
    ...heatPart(review, {
      id: 'margins',
      heading: 'Where labels are least sure',
      explains: 'Margin of each label: the difference of log-likelihood from the next best ' +
          `explanation; no colour from ${kSure} on (one in 22 000 wrong), the strongest at 0. `,
      values: (marker) => marker.lowest_margins,
      color: '--violet',
      shareOf: (value) => 1 - value / kSure,
      unit: '',
    }),
  ];
}
