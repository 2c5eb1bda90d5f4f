// SPDX-License-Identifier: MIT
// The column of plots over time, and the residuals of the markers below it.
import {numbersOf, runAt, runsOf, seriesOf} from './data.js';
import {PlotRow} from './plots.js';
import {HeatStrip, heatLegend, kHeatRow, PhoneStrip, Ruler, statusColor, StatusStrip} from './strips.js';
import {element, formatFixed, formatNumber} from './text.js';

const kAxisColors = ['--warm', '--green', '--accent'];

export class Timeline {
  constructor(clock, data) {
    this.clock = clock;
    this.data = data;
    this.rows = [];
    this.strips = [];
    this.phones = data.phones &&
        {labels: data.phones.labels, runs: runsOf(data.phones.runs, clock.take.num_frames)};
    this.statuses = {labels: data.statuses.labels, runs: runsOf(data.statuses.runs, clock.take.num_frames)};
  }

  phoneAt(frame) {
    if (!this.phones || this.phones.runs.length === 0) return '';
    return this.phones.labels[runAt(this.phones.runs, frame).code];
  }

  mount(container) {
    if (this.clock.take.num_frames === 0) {
      container.append(element('p', {}, 'The take has no frames.'));
      return;
    }
    container.append(this.rulerCard(), this.parameterPanel());
    if (this.data.residuals?.markers.length) container.append(this.residualPanel());
    if (this.data.head_pose) container.append(this.headPosePanel());
    this.redraw();
    this.clock.on('frame', () => { for (const row of [...this.rows, ...this.strips]) row.showFrame(); });
    this.clock.on('view', () => {
      for (const row of this.rows) row.showView();
      for (const strip of this.strips) strip.draw();
    });
    this.clock.on('marker', () => this.highlightMarker());
    let width = container.clientWidth;
    new ResizeObserver(() => {
      if (container.clientWidth === width) return;
      width = container.clientWidth;
      this.redraw();
    }).observe(container);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.redraw());
  }

  redraw() {
    for (const row of [...this.rows, ...this.strips]) row.draw();
  }

  addRow(panel, options) {
    const row = new PlotRow(this.clock, options);
    this.rows.push(row);
    panel.append(row.row);
  }

  addStrip(panel, strip, label) {
    this.strips.push(strip);
    panel.append(element('div', {class: 'row strip-row'}, element('div', {class: 'label'}, label), strip.element));
  }

  rulerCard() {
    const card = element('div', {class: 'card ruler-card'});
    card.append(this.toolbar());
    this.addStrip(card, new Ruler(this.clock), 'time');
    if (this.phones) this.addStrip(card, new PhoneStrip(this.clock, this.phones.labels, this.phones.runs), 'phones');
    const present = new Set(this.statuses.runs.map(({code}) => this.statuses.labels[code]));
    present.delete('ok');
    if (present.size) {
      const label = element('span', {title: 'frames whose fit is not plain: ' + [...present].join(', ').replaceAll('_', ' ')});
      for (const name of present)
        label.append(element('span', {style: `color:${statusColor(name)}`}, '■ '), name.replaceAll('_', ' '), ' ');
      this.addStrip(card, new StatusStrip(this.clock, this.statuses.labels, this.statuses.runs), label);
    }
    return card;
  }

  toolbar() {
    const {clock} = this;
    const zoom = element('span', {class: 'segmented'},
        element('button', {onclick: () => clock.showAll()}, 'Whole take'));
    if (clock.window && clock.window.count < clock.take.num_frames)
      zoom.append(element('button', {onclick: () => clock.setView(...clock.windowView())}, '3D window'));
    const choices = [['Fit to data', false], ['Full range', true]].map(([text, shows]) =>
        element('button', {'aria-pressed': String(!shows), onclick: () => choose(shows)}, text));
    const choose = (shows) => {
      choices.forEach((button, i) => button.setAttribute('aria-pressed', String(shows === (i === 1))));
      for (const row of this.rows) row.setShowsRange(shows);
    };
    const keys = element('span', {class: 'keys'});
    keys.innerHTML = '<kbd>space</kbd> plays, <kbd>←</kbd> <kbd>→</kbd> step; drag to zoom, double-click for all';
    return element('div', {class: 'toolbar'}, zoom, element('span', {class: 'segmented'}, ...choices),
                   element('span', {class: 'spacer'}), keys);
  }

  parameterPanel() {
    const {tracks} = this.data;
    const panel = element('section', {class: 'card panel', id: 'parameters'},
        element('header', {}, element('h2', {}, 'Parameters'),
                element('p', {}, 'Bands: one standard deviation. Grey: outside the parameter\u2019s range.')));
    for (const parameter of tracks.parameters)
      this.addRow(panel, {
        name: parameter.name.replaceAll('_', ' '),
        title: parameter.description,
        unit: parameter.unit,
        range: Number.isFinite(parameter.min) && Number.isFinite(parameter.max) ? [parameter.min, parameter.max] : null,
        framesPerPoint: tracks.frames_per_point,
        series: [{...seriesOf(parameter), sigma: numbersOf(parameter.sigma), color: '--accent'}],
      });
    this.addRow(panel, {
      name: 'mean residual', unit: 'mm', fromZero: true,
      title: 'Mean distance of the measured to the virtual markers of a frame',
      framesPerPoint: tracks.frames_per_point,
      series: [{...seriesOf(tracks.residual), color: '--warm'}],
    });
    return panel;
  }

  headPosePanel() {
    const {mode, frames_per_point: framesPerPoint, columns} = this.data.head_pose;
    const panel = element('section', {class: 'card panel', id: 'head-pose'},
        element('header', {}, element('h2', {}, 'Head motion'),
                element('p', {}, mode === 'none' ? 'The data were in a head frame already (mode none).'
                    : `Since the first known pose, in the axes of the head there (mode ${mode}).`)));
    if (mode === 'none') return panel;
    const series = columns.map(seriesOf);
    const triple = (first, names) => names.map((name, i) => ({...series[first + i], name, color: kAxisColors[i]}));
    this.addRow(panel, {name: 'translation', unit: 'mm', framesPerPoint, series: triple(0, ['left', 'up', 'forward'])});
    if (mode === 'rigid') {
      this.addRow(panel, {name: 'rotation', unit: 'deg', framesPerPoint, series: triple(3, ['nod', 'turn', 'tilt']),
        title: 'About the axes to the left (nod: positive down), up (turn: positive left) and forward (tilt)'});
      this.addRow(panel, {name: 'residual of references', unit: 'mm', framesPerPoint, fromZero: true,
        series: [{...series[6], color: '--warm'}]});
    }
    return panel;
  }

  residualPanel() {
    const {markers} = this.data.residuals;
    const rms = (i) => markers[i].rms_mm ?? -1;
    const order = markers.map((_, i) => i).sort((a, b) => rms(b) - rms(a));
    // The scale suits the usual marker, so that a bad one does not darken all others.
    const bulks = markers.map(({p95_mm}) => p95_mm ?? 0).sort((a, b) => a - b);
    const largest_mm = Math.max(0.05, 2 * bulks[bulks.length >> 1]);
    const strip = new HeatStrip(this.clock, this.data.residuals, order, largest_mm);
    this.strips.push(strip);
    const head = element('tr', {}, ...['marker', 'RMS', 'mean', '95%', 'max'].map((text) => element('th', {}, text)));
    const worst = Math.max(...order.map(rms), 1e-9);
    this.markerRows = new Map();
    const body = order.map((i) => this.markerRow(markers[i], worst));
    return element('section', {class: 'card panel', id: 'residuals'},
        element('header', {}, element('h2', {}, 'Residual per marker'),
                element('p', {}, 'Distance of measured to virtual marker in mm; largest RMS first.')),
        element('div', {class: 'residual-grid'},
                element('table', {}, head, ...body),
                element('div', {}, element('div', {class: 'heat-head'}, ...heatLegend(largest_mm)), strip.element)));
  }

  markerRow({name, count, rms_mm, mean_mm, p95_mm, max_mm}, worst) {
    const cell = element('td', {title: `${name}: used in ${formatNumber(count)} frames`,
      style: `--bar:var(--sigma);--share:${(100 * (rms_mm ?? 0) / worst).toFixed(1)}%`}, name);
    const row = element('tr', {
      onmouseenter: () => this.clock.setMarker(name), onmouseleave: () => this.clock.setMarker(null)}, cell,
      ...[rms_mm, mean_mm, p95_mm, max_mm].map((value) => element('td', {}, formatFixed(value, 2))));
    row.style.height = `${kHeatRow}px`;
    this.markerRows.set(name, row);
    return row;
  }

  highlightMarker() {
    if (!this.markerRows) return;
    for (const [name, row] of this.markerRows) row.classList.toggle('hot', name === this.clock.marker);
  }
}
