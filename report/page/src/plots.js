// SPDX-License-Identifier: MIT
// The plots over time: one zoom and one cursor for all of them.
import uPlot from 'uplot';

import {extentOf} from './data.js';
import {cssColor, decimalsFor, element, formatFixed, unitText, withUnit} from './text.js';

const kHeight = 88;

export function axisWidth() { return parseFloat(cssColor('--axis')); }
export function rightMargin() { return parseFloat(cssColor('--right')); }

/** Times of the points, in the middle of the frames that each stands for. */
export function pointTimes(clock, count, framesPerPoint) {
  const times = new Float64Array(count);
  for (let i = 0; i < count; ++i) {
    const last = Math.min((i + 1) * framesPerPoint, clock.take.num_frames) - 1;
    times[i] = clock.timeOf((i * framesPerPoint + last) / 2);
  }
  return times;
}

/** uPlot draws gaps at null, not at NaN. */
function withGaps(numbers) {
  return Array.from(numbers, (number) => (Number.isFinite(number) ? number : null));
}

function combine(a, b, sign) {
  return Float32Array.from(a, (value, i) => value + sign * (Number.isFinite(b[i]) ? b[i] : 0));
}

/**
 * A row of the timeline: label with the value at the cursor, and a plot of one or more series.
 * series: [{low, high, sigma, color, name, dash}], low === high where a point is a frame.
 */
export class PlotRow {
  constructor(clock, {name, unit, title, series, framesPerPoint, range, fromZero}) {
    Object.assign(this, {clock, unit: unitText(unit), series, framesPerPoint, range, fromZero});
    this.times = pointTimes(clock, series[0].low.length, framesPerPoint);
    this.dataExtent = extentOf(...series.flatMap(({low, high}) => [low, high])) ?? [0, 1];
    this.showsRange = false;
    // A parameter that is held shows no noise of a billionth.
    this.leastSpan = range ? 0.04 * (range[1] - range[0]) : 1e-3;
    this.decimals = decimalsFor(Math.max(this.dataExtent[1] - this.dataExtent[0], this.leastSpan));
    this.value = element('div', {class: 'value'});
    this.label = element('div', {class: 'label', title: title ?? ''},
        element('div', {class: 'name'}, name), this.value);
    this.plot = element('div', {class: 'plot'});
    this.row = element('div', {class: 'row plot-row'}, this.label, this.plot);
    this.now = element('div', {class: 'now'});
    this.inWindow = element('div', {class: 'in-window'});
    this.isStale = true;
  }

  /** Builds the plot, or builds it anew for other colours or another width. */
  draw() {
    this.chart?.destroy();
    this.plot.replaceChildren();
    const {data, series, bands} = this.tables();
    const muted = cssColor('--muted');
    const grid = {stroke: cssColor('--line'), width: 1};
    this.chart = new uPlot({
      width: this.plot.clientWidth,
      height: kHeight,
      padding: [7, rightMargin(), 7, 0],
      legend: {show: false},
      cursor: {x: false, y: false, points: {show: false}, drag: {x: true, y: false, setScale: false}},
      select: {show: true},
      scales: {
        x: {time: false, range: () => this.clock.view},
        y: {range: () => this.extent()},
      },
      axes: [
        {show: false, grid: {show: false}},
        {size: axisWidth(), gap: 4, stroke: muted, font: '11px system-ui, sans-serif', grid, ticks: {show: false}, space: 22,
         values: (_, splits) => splits.map((value) => String(Number(value.toPrecision(6))).replace('-', '−'))},
      ],
      series,
      bands,
      hooks: {
        drawClear: [(chart) => this.drawOutside(chart)],
        setSelect: [(chart) => this.onSelect(chart)],
      },
    }, data, this.plot);
    const {over} = this.chart;
    over.append(this.inWindow, this.now);
    over.addEventListener('mousemove', (event) => this.onMove(event));
    over.addEventListener('dblclick', () => this.clock.showAll());
    this.isStale = false;
    this.placeOverlays();
    this.showFrame();
  }

  tables() {
    const data = [this.times];
    const series = [{}];
    const bands = [];
    const hidden = {stroke: 'transparent', width: 0, points: {show: false}};
    for (const {low, high, sigma, color, dash} of this.series) {
      const stroke = cssColor(color);
      if (sigma) {
        bands.push({series: [data.length, data.length + 1], fill: cssColor('--sigma')});
        data.push(withGaps(combine(high, sigma, 1)), withGaps(combine(low, sigma, -1)));
        series.push(hidden, hidden);
      }
      const line = {stroke, width: 1.35, dash, points: {show: false}};
      if (high !== low) {
        // What the frames between did is somewhere in here.
        bands.push({series: [data.length, data.length + 1], fill: `${stroke}90`});
        data.push(withGaps(high), withGaps(low));
        series.push(line, line);
      } else {
        data.push(withGaps(low));
        series.push(line);
      }
    }
    return {data, series, bands};
  }

  extent() {
    let [low, high] = this.dataExtent;
    if (this.showsRange && this.range) {
      low = Math.min(low, this.range[0]);
      high = Math.max(high, this.range[1]);
    }
    if (this.fromZero) low = Math.min(0, low);
    const margin = Math.max(0.08 * (high - low), (this.leastSpan - (high - low)) / 2);
    return [this.fromZero ? low : low - margin, high + margin];
  }

  /** Greys what lies outside the range of the parameter, so that a curve at its bound is seen. */
  drawOutside(chart) {
    if (!this.range) return;
    const {ctx, bbox} = chart;
    const [low, high] = this.range.map((value) => chart.valToPos(value, 'y', true));
    const top = Math.max(bbox.top, Math.min(bbox.top + bbox.height, high));
    const bottom = Math.max(bbox.top, Math.min(bbox.top + bbox.height, low));
    ctx.save();
    ctx.fillStyle = cssColor('--outside');
    ctx.fillRect(bbox.left, bbox.top, bbox.width, top - bbox.top);
    ctx.fillRect(bbox.left, bottom, bbox.width, bbox.top + bbox.height - bottom);
    ctx.strokeStyle = cssColor('--muted');
    ctx.setLineDash([5, 4]);
    ctx.lineWidth = devicePixelRatio;
    for (const [edge, shown] of [[high, top], [low, bottom]]) {
      if (edge !== shown) continue;
      ctx.beginPath();
      ctx.moveTo(bbox.left, edge);
      ctx.lineTo(bbox.left + bbox.width, edge);
      ctx.stroke();
    }
    ctx.restore();
  }

  onSelect(chart) {
    const {left, width} = chart.select;
    if (width < 4) return;
    const [begin, end] = [left, left + width].map((x) => chart.posToVal(x, 'x'));
    chart.setSelect({left: 0, top: 0, width: 0, height: 0}, false);
    this.clock.setView(begin, end);
  }

  onMove(event) {
    const x = event.clientX - this.chart.over.getBoundingClientRect().left;
    this.clock.onHover?.();
    this.clock.setFrame(this.clock.frameAt(this.chart.posToVal(x, 'x')));
  }

  showView() {
    if (!this.chart) return;
    this.chart.setScale('x', {min: this.clock.view[0], max: this.clock.view[1]});
    this.placeOverlays();
  }

  setShowsRange(shows) {
    this.showsRange = shows;
    this.showView();
  }

  placeOverlays() {
    if (!this.chart) return;
    const width = this.chart.over.clientWidth;
    const at = (time) => this.chart.valToPos(time, 'x');
    const x = at(this.clock.timeOf(this.clock.frame));
    this.now.hidden = !(x >= 0 && x <= width);
    this.now.style.transform = `translateX(${x}px)`;
    const {window} = this.clock;
    const [first, last] = window ? this.clock.windowView() : this.clock.wholeView();
    const isAllOfView = first <= this.clock.view[0] && last >= this.clock.view[1];
    this.inWindow.hidden = isAllOfView;
    if (isAllOfView) return;
    const [begin, end] = [first, last].map((time) => Math.max(0, Math.min(width, at(time))));
    this.inWindow.style.left = `${begin}px`;
    this.inWindow.style.width = `${end - begin}px`;
  }

  showFrame() {
    this.placeOverlays();
    const point = Math.floor(this.clock.frame / this.framesPerPoint);
    this.value.replaceChildren(...this.series.map((series) => this.valueOf(series, point)));
  }

  valueOf({name, low, high, sigma, color}, point) {
    const [a, b] = [low[point], high[point]];
    const number = a === b || !Number.isFinite(a) ? formatFixed(a, this.decimals)
                                                  : `${formatFixed(a, this.decimals)} … ${formatFixed(b, this.decimals)}`;
    if (name)
      return element('div', {class: 'key'}, element('i', {style: `background:var(${color})`}),
                     element('span', {}, name), element('span', {}, withUnit(number, this.unit)));
    const value = element('span', {}, element('b', {}, withUnit(number, this.unit)));
    if (!sigma || !Number.isFinite(a)) return value;
    value.append(Number.isFinite(sigma[point]) ? ` ± ${formatFixed(sigma[point], Math.max(this.decimals, 2))}`
                                               : ' not determined');
    return value;
  }
}
