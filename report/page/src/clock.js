// SPDX-License-Identifier: MIT
// What the whole page agrees on: the frame under the cursor, the stretch of time in view, the
// window of the head in 3D. Frames are counted from 0, times in seconds.

export class Clock {
  constructor(take, window) {
    this.take = take;
    this.window = window;  // {first, count} or null
    this.frame = window ? window.first : 0;
    this.view = this.firstView();
    this.listeners = {frame: [], view: [], marker: []};
    this.marker = null;
  }

  timeOf(frame) { return this.take.start_s + frame / this.take.rate_hz; }
  frameAt(time) {
    const frame = Math.round((time - this.take.start_s) * this.take.rate_hz);
    return Math.max(0, Math.min(this.take.num_frames - 1, frame));
  }
  wholeView() { return this.viewOf(0, this.take.num_frames); }
  windowView() { return this.viewOf(this.window.first, this.window.count); }
  viewOf(first, count) {
    return [this.timeOf(first - 0.5), this.timeOf(first + Math.max(count, 2) - 0.5)];
  }

  /** The whole take, unless it is so long that its curves would melt into a block. */
  firstView() {
    const kLongestReadable_s = 60;
    const {num_frames, rate_hz} = this.take;
    if (num_frames <= kLongestReadable_s * rate_hz) return this.wholeView();
    return this.viewOf(this.window ? this.window.first : 0, Math.round(kLongestReadable_s / 2 * rate_hz));
  }

  on(event, listener) { this.listeners[event].push(listener); }
  tell(event) { for (const listener of this.listeners[event]) listener(); }

  setFrame(frame) {
    const clamped = Math.max(0, Math.min(this.take.num_frames - 1, frame));
    if (clamped === this.frame) return;
    this.frame = clamped;
    this.tell('frame');
  }
  setView(begin, end) {
    const [first, last] = this.wholeView();
    const shortest = 4 / this.take.rate_hz;
    if (end - begin < shortest) return;
    this.view = [Math.max(first, begin), Math.min(last, end)];
    this.tell('view');
  }
  showAll() { this.setView(...this.wholeView()); }

  /** The marker that the pointer is on, by name, wherever it is shown. */
  setMarker(name) {
    if (name === this.marker) return;
    this.marker = name;
    this.tell('marker');
  }
}
