// SPDX-License-Identifier: MIT
// Strips over time, aligned with the plots: the ruler, the phones, the fit's status, and the heat
// strip of the residuals.
import {axisWidth, rightMargin} from './plots.js';
import {bytesOf, runAt} from './data.js';
import {cssColor, element, formatFixed} from './text.js';

/** A canvas as wide as the plots, with their zoom and cursor. */
class Strip {
  constructor(clock, height, {hasAxis = true} = {}) {
    this.clock = clock;
    this.height = height;
    this.left = hasAxis ? axisWidth : () => 0;
    this.canvas = element('canvas');
    this.now = element('div', {class: 'now'});
    this.element = element('div', {class: 'strip'}, this.canvas, this.now);
    this.canvas.addEventListener('mousemove', (event) => {
      clock.onHover?.();
      clock.setFrame(clock.frameAt(this.timeAt(event.offsetX)));
    });
    this.canvas.addEventListener('dblclick', () => clock.showAll());
  }

  get plotWidth() { return Math.max(1, this.element.clientWidth - this.left() - rightMargin()); }
  xOf(time) {
    const [begin, end] = this.clock.view;
    return this.left() + (time - begin) / (end - begin) * this.plotWidth;
  }
  timeAt(x) {
    const [begin, end] = this.clock.view;
    return begin + (x - this.left()) / this.plotWidth * (end - begin);
  }

  draw() {
    const width = this.element.clientWidth;
    const scale = devicePixelRatio;
    this.canvas.width = Math.round(width * scale);
    this.canvas.height = Math.round(this.height * scale);
    this.canvas.style.width = `${width}px`;
    this.canvas.style.height = `${this.height}px`;
    const context = this.canvas.getContext('2d');
    context.scale(scale, scale);
    context.save();
    context.beginPath();
    context.rect(this.left(), 0, this.plotWidth, this.height);
    context.clip();
    this.paint(context);
    context.restore();
    this.showFrame();
  }

  showFrame() {
    const x = this.xOf(this.clock.timeOf(this.clock.frame));
    this.now.hidden = x < this.left() || x > this.left() + this.plotWidth;
    this.now.style.transform = `translateX(${x}px)`;
  }

  /** The runs in view with their pixels. */
  visibleRuns(runs) {
    const first = runAt(runs, this.clock.frameAt(this.clock.view[0]));
    const visible = [];
    for (let i = runs.indexOf(first); i < runs.length; ++i) {
      const begin = this.xOf(this.clock.timeOf(runs[i].begin - 0.5));
      if (begin > this.left() + this.plotWidth) break;
      visible.push({...runs[i], x: begin, width: this.xOf(this.clock.timeOf(runs[i].end - 0.5)) - begin});
    }
    return visible;
  }
}

export class Ruler extends Strip {
  constructor(clock) { super(clock, 20); }

  paint(context) {
    const [begin, end] = this.clock.view;
    const step = niceStep((end - begin) * 80 / this.plotWidth);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    context.font = '11px system-ui, sans-serif';
    context.textBaseline = 'top';
    for (let i = Math.ceil(begin / step); i * step <= end; ++i) {
      const x = this.xOf(i * step);
      context.fillStyle = cssColor('--line');
      context.fillRect(x, 0, 1, this.height);
      context.fillStyle = cssColor('--muted');
      context.fillText(timeText(i * step, decimals, end), x + 4, 3);
    }
  }
}

/** 1, 2 or 5 times a power of ten; from a minute on, steps that suit minutes. */
function niceStep(least) {
  const kOfMinutes = [60, 120, 300, 600, 1200, 1800, 3600];
  if (least > 30) return kOfMinutes.find((step) => step >= least) ?? 3600 * Math.ceil(least / 3600);
  const power = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= least) * power;
  return step > 10 && step < 60 ? (step <= 20 ? 20 : 30) : step;
}

function timeText(time, decimals, longest) {
  if (longest < 120) return `${formatFixed(time, decimals)} s`;
  const sign = time < 0 ? '−' : '';
  const whole = Math.abs(time);
  const minutes = Math.floor(whole / 60 + 1e-9);
  const seconds = Math.max(0, whole - 60 * minutes).toFixed(decimals);
  return `${sign}${minutes}:${seconds.padStart(decimals ? decimals + 3 : 2, '0')}`;
}

export class PhoneStrip extends Strip {
  constructor(clock, labels, runs) {
    super(clock, 22);
    Object.assign(this, {labels, runs});
  }

  paint(context) {
    context.font = '12px system-ui, "DejaVu Sans", sans-serif';
    context.textBaseline = 'middle';
    context.textAlign = 'center';
    const visible = this.visibleRuns(this.runs);
    const [line, ink, soft] = [cssColor('--line'), cssColor('--ink'), cssColor('--sigma')];
    for (const {x, width, code, begin} of visible) {
      const label = this.labels[code];
      if (!label) continue;
      context.fillStyle = soft;
      context.fillRect(x, 1, width, this.height - 3);
      if (width > 3) {
        context.fillStyle = line;
        context.fillRect(x, 0, 1, this.height);
      }
      if (context.measureText(label).width + 4 < width) {
        context.fillStyle = ink;
        context.fillText(label, x + width / 2, this.height / 2);
      }
    }
  }
}

// Told apart by their lightness as well as their hue.
const kStatusColors = {
  ok: null, no_head_pose: '#7a1f5c', too_few_markers: '#b0360a', not_converged: '#e69f00', weak: '#56b4e9',
};

export class StatusStrip extends Strip {
  constructor(clock, labels, runs) {
    super(clock, 8);
    Object.assign(this, {labels, runs});
  }

  paint(context) {
    context.fillStyle = cssColor('--good-soft');
    context.fillRect(this.left(), 1, this.plotWidth, this.height - 3);
    for (const {x, width, code} of this.visibleRuns(this.runs)) {
      const color = kStatusColors[this.labels[code]];
      if (!color) continue;
      context.fillStyle = color;
      context.fillRect(x, 0, Math.max(width, 1.5), this.height - 1);
    }
  }
}

export function statusColor(name) { return kStatusColors[name]; }

const kHeatStops = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];  // viridis

function heatColor(share) {
  const at = Math.max(0, Math.min(1, share)) * (kHeatStops.length - 1);
  const i = Math.min(kHeatStops.length - 2, Math.floor(at));
  return [0, 1, 2].map((k) => Math.round(kHeatStops[i][k] + (at - i) * (kHeatStops[i + 1][k] - kHeatStops[i][k])));
}

export const kHeatRow = 20;

/** Markers x time; each pixel shows the largest distance of its stretch of time. */
export class HeatStrip extends Strip {
  /** order: indices of the markers as the rows show them. */
  constructor(clock, residuals, order, largest_mm) {
    super(clock, kHeatRow * order.length, {hasAxis: false});
    Object.assign(this, {order, largest_mm});
    this.names = residuals.markers.map(({name}) => name);
    this.mmPerStep = residuals.mm_per_step;
    this.framesPerColumn = residuals.frames_per_column;
    this.numColumns = Math.ceil(clock.take.num_frames / this.framesPerColumn);
    this.heat = bytesOf(residuals.heat);
    this.colors = Array.from({length: 255}, (_, step) => heatColor(step * this.mmPerStep / largest_mm));
    this.tip = element('div', {class: 'tip', hidden: true});
    this.element.append(this.tip);
    this.canvas.addEventListener('mousemove', (event) => this.explain(event));
    this.canvas.addEventListener('mouseleave', () => {
      this.tip.hidden = true;
      clock.setMarker(null);
    });
  }

  paint(context) {
    const width = Math.max(1, Math.round(this.plotWidth));
    const image = new ImageData(width, this.order.length);
    for (let row = 0; row < this.order.length; ++row)
      for (let x = 0; x < width; ++x) {
        const step = this.largestIn(this.order[row], x / width, (x + 1) / width);
        if (step < 0) continue;
        const [r, g, b] = this.colors[step];
        image.data.set([r, g, b, 255], 4 * (row * width + x));
      }
    const small = new OffscreenCanvas(width, this.order.length);
    small.getContext('2d').putImageData(image, 0, 0);
    context.imageSmoothingEnabled = false;
    context.fillStyle = cssColor('--outside');
    for (let row = 0; row < this.order.length; ++row) {
      context.fillRect(this.left(), row * kHeatRow + 1, this.plotWidth, kHeatRow - 2);
      context.drawImage(small, 0, row, width, 1, this.left(), row * kHeatRow + 1, this.plotWidth, kHeatRow - 2);
    }
  }

  /** The largest step between two shares of the view; -1 where the marker was not used. */
  largestIn(marker, from, to) {
    const [begin, end] = this.clock.view;
    const columnOf = (share) => (begin + share * (end - begin) - this.clock.take.start_s) *
        this.clock.take.rate_hz / this.framesPerColumn + 0.5 / this.framesPerColumn;
    const first = Math.max(0, Math.floor(columnOf(from)));
    const last = Math.min(this.numColumns - 1, Math.max(first, Math.ceil(columnOf(to)) - 1));
    let largest = -1;
    for (let column = first; column <= last; ++column) {
      const step = this.heat[marker * this.numColumns + column];
      if (step !== 255 && step > largest) largest = step;
    }
    return largest;
  }

  explain(event) {
    const row = Math.floor(event.offsetY / kHeatRow);
    const marker = this.order[row];
    if (marker === undefined) return;
    this.clock.setMarker(this.names[marker]);
    const column = Math.floor(this.clock.frame / this.framesPerColumn);
    const step = this.heat[marker * this.numColumns + column];
    this.tip.hidden = false;
    this.tip.textContent = `${this.names[marker]} · ${formatFixed(this.clock.timeOf(this.clock.frame), 2)} s · ` +
        (step === 255 ? 'not used' : `${formatFixed(step * this.mmPerStep, 2)} mm`);
    this.tip.style.left = `${Math.min(event.offsetX, this.element.clientWidth - 210)}px`;
    this.tip.style.top = `${event.offsetY}px`;
  }
}

export function heatLegend(largest_mm) {
  const canvas = element('canvas', {width: 90, height: 10});
  const context = canvas.getContext('2d');
  for (let x = 0; x < 90; ++x) {
    context.fillStyle = `rgb(${heatColor(x / 89)})`;
    context.fillRect(x, 0, 1, 10);
  }
  return [ '0', canvas, `${formatFixed(largest_mm, 1)} mm and above`];
}
