// SPDX-License-Identifier: MIT
// The panel around the head in 3D: play, scrub, toggles, and the keys of the page.
import {kLegendColors} from './scene.js';
import {element, formatFixed} from './text.js';

const kPlayIcon = '<svg viewBox="0 0 16 16"><path d="M3 1.5v13l11-6.5z"/></svg>';
const kPauseIcon = '<svg viewBox="0 0 16 16"><path d="M3 1.5h3.6v13H3zM9.4 1.5H13v13H9.4z"/></svg>';

export class Player {
  constructor(clock, {phoneAt}) {
    this.clock = clock;
    this.phoneAt = phoneAt;
    this.isPlaying = false;
    this.speed = 1;
    this.first = clock.window ? clock.window.first : 0;
    this.last = clock.window ? clock.window.first + clock.window.count - 1 : clock.take.num_frames - 1;
    document.addEventListener('keydown', (event) => this.onKey(event));
  }

  mount(panel, scene) {
    panel.hidden = false;
    this.picture = element('div', {class: 'stage-3d', tabindex: '-1'});
    panel.append(this.picture);
    const isShown = scene.mount(this.picture);
    if (isShown) this.picture.append(this.viewButtons(scene), this.legend(scene));
    else this.picture.append(element('p', {class: 'hint'},
        'This browser offers no WebGL, so the head cannot be shown in 3D. All figures and plots are below.'));
    this.playButton = element('button', {class: 'play', title: 'Play or pause (space)', 'aria-label': 'Play', onclick: () => this.toggle()});
    this.playButton.innerHTML = kPlayIcon;
    this.slider = element('input', {
      type: 'range', min: this.first, max: this.last, step: 1, value: this.clock.frame, 'aria-label': 'Frame',
      oninput: () => { this.pause(); this.clock.setFrame(Number(this.slider.value)); },
    });
    const speed = element('select', {title: 'Speed', 'aria-label': 'Speed', onchange: () => { this.speed = Number(speed.value); }});
    for (const [value, text] of [[1, '1×'], [0.5, '½×'], [0.25, '¼×'], [0.1, '⅒×']])
      speed.append(element('option', {value}, text));
    this.readout = element('p', {class: 'readout', id: 'readout'});
    panel.append(element('div', {class: 'transport'}, this.playButton, this.slider, speed), this.readout);
    if (isShown) panel.append(this.toggles(scene));
    this.clock.on('frame', () => this.showFrame());
    this.showFrame();
  }

  viewButtons(scene) {
    const views = [['Front', 0, 2], ['Three-quarter', 28, 6], ['Side', 90, 2]];
    return element('div', {class: 'views'}, ...views.map(([name, azimuth, elevation]) =>
        element('button', {onclick: () => scene.look(azimuth, elevation)}, name)));
  }

  legend(scene) {
    const entries = [];
    if (scene.measured) entries.push(['measured', 'measured marker']);
    if (scene.virtual) entries.push(['virtual', 'virtual marker (on the rig)']);
    const rows = entries.map(([key, text]) =>
        element('span', {}, element('i', {style: `background:${kLegendColors[key]}`}), text));
    if (scene.rigIsTooLarge) rows.push(element('span', {}, 'The rig has too many vertices for this page.'));
    return element('div', {class: 'legend'}, ...rows);
  }

  toggles(scene) {
    const box = element('div', {class: 'toggles'});
    const add = (what, text) => {
      const input = element('input', {type: 'checkbox', checked: true, onchange: () => scene.show(what, input.checked)});
      box.append(element('label', {}, input, text));
    };
    if (scene.measured) add('measured', 'Measured');
    if (scene.virtual) add('virtual', 'Virtual');
    if (scene.measured && scene.virtual) add('lines', 'Lines');
    for (const part of ['spectacles', 'hair'])
      if (scene.parts.has(part)) add(part, part[0].toUpperCase() + part.slice(1));
    if (scene.rig) {
      const opacity = element('input', {type: 'range', min: 0, max: 1, step: 0.05, value: 1, 'aria-label': 'Opacity of the head',
        oninput: () => scene.setOpacity(Number(opacity.value))});
      box.append(element('label', {}, 'Head opacity', opacity));
    }
    return box;
  }

  showFrame() {
    const {clock} = this;
    this.slider.value = clock.frame;
    const phone = this.phoneAt(clock.frame);
    const isInside = clock.frame >= this.first && clock.frame <= this.last;
    this.readout.replaceChildren(
        element('b', {}, `frame ${clock.take.first_frame + clock.frame}`),
        ` · ${formatFixed(clock.timeOf(clock.frame), 3)} s`,
        phone ? ` · phone ${phone}` : '',
        isInside ? '' : ` · the 3D head covers ${formatFixed(clock.timeOf(this.first), 1)} to ${formatFixed(clock.timeOf(this.last), 1)} s`);
  }

  toggle() { this.isPlaying ? this.pause() : this.play(); }

  play() {
    if (this.clock.frame < this.first || this.clock.frame >= this.last) this.clock.setFrame(this.first);
    this.isPlaying = true;
    this.setIcon(kPauseIcon, 'Pause');
    let before = performance.now();
    let position = this.clock.frame;
    const step = (now) => {
      if (!this.isPlaying) return;
      position += (now - before) / 1000 * this.clock.take.rate_hz * this.speed;
      before = now;
      if (position > this.last) position = this.first;
      this.clock.setFrame(Math.floor(position));
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  pause() {
    this.isPlaying = false;
    this.setIcon(kPlayIcon, 'Play');
  }

  setIcon(icon, name) {
    if (!this.playButton) return;
    this.playButton.innerHTML = icon;
    this.playButton.setAttribute('aria-label', name);
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const tag = event.target.tagName;
    if (tag === 'SELECT' || tag === 'SUMMARY' || (tag === 'INPUT' && event.target !== this.slider)) return;
    const step = event.shiftKey ? 10 : 1;
    const actions = {
      ' ': () => this.toggle(),
      ArrowRight: () => this.stepBy(step),
      ArrowLeft: () => this.stepBy(-step),
      Home: () => this.clock.setFrame(this.first),
      End: () => this.clock.setFrame(this.last),
    };
    const action = actions[event.key];
    if (!action || (event.key === ' ' && !this.playButton)) return;
    event.preventDefault();
    action();
  }

  stepBy(frames) {
    this.pause();
    this.clock.setFrame(this.clock.frame + frames);
  }
}
