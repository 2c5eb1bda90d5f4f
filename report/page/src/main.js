// SPDX-License-Identifier: MIT
import {Clock} from './clock.js';
import {Player} from './player.js';
import {HeadScene} from './scene.js';
import {showMasthead, showStages, showWarnings} from './summary.js';
import {Timeline} from './timeline.js';

const data = JSON.parse(document.getElementById('data').textContent);

showMasthead(data);
showWarnings(data.stages);
showStages(data.stages);

const window3d = data.scene &&
    {first: data.scene.first, count: Math.min(data.scene.count * data.scene.stride, data.take.num_frames - data.scene.first)};
const clock = new Clock(data.take, window3d);
const timeline = new Timeline(clock, data);
const player = new Player(clock, {phoneAt: (frame) => timeline.phoneAt(frame)});
clock.onHover = () => player.pause();

if (data.scene) {
  document.querySelector('.split').classList.add('with-scene');
  player.mount(document.getElementById('scene'), new HeadScene(data.scene, clock));
}
timeline.mount(document.getElementById('timeline'));
document.getElementById('footer').textContent =
    `articap ${data.articap_version}. This page is complete in itself and needs no network.`;

document.documentElement.dataset.ready = 'true';
