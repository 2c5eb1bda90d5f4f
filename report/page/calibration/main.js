// SPDX-License-Identifier: MIT
import {element} from '../src/text.js';

import {distortionCurve, distortionGrid, lensTable} from './lens.js';
import {coverageMap, residualArrows} from './picture.js';
import {residualHistogram} from './residuals.js';
import {cameraTable, mirrorTable, rigidityWords, spaceViews} from './space.js';
import {showSummary} from './summary.js';
import {viewBars} from './views.js';
import {lengthHistogram, wandWords} from './wand.js';

const data = JSON.parse(document.getElementById('data').textContent);
const {calibration} = data;
const isWand = Boolean(calibration.wand);

function part(id, heading, ...children) {
  return element(
      'section', {class: 'part', id}, element('h2', {}, heading), ...children.filter(Boolean));
}

function figureRow(...figures) {
  return element('div', {class: 'figure-row'}, ...figures.filter(Boolean));
}

function cameraPart(camera, index) {
  const sightings =
      isWand ? [] : calibration.sightings.filter((sighting) => sighting.camera === index);
  const lens = [distortionCurve(camera, sightings), distortionGrid(camera), lensTable(camera)];
  const hasMirror = calibration.mirrors.some((mirror) => mirror.camera === index);
  const noise_px = hasMirror ? calibration.sigma_px : camera.noise_px;
  const size = element('span', {class: 'aside'}, ` ${camera.width} × ${camera.height} pixels`);
  const heading = element('span', {}, camera.name, size);
  if (isWand) return part(`camera-${index}`, heading, figureRow(...lens));
  return part(
      `camera-${index}`, heading,
      figureRow(
          coverageMap(camera), residualArrows(camera, sightings, calibration.mirrors),
          residualHistogram(sightings, noise_px), ...lens),
      viewBars(sightings, calibration.mirrors));
}

function spacePart() {
  const isArray = calibration.cameras.length > 1 || calibration.mirrors.length > 0;
  return part(
      'space', isArray ? 'Where everything stood' : 'Where the board was held',
      isArray && !isWand && rigidityWords(calibration), figureRow(...spaceViews(calibration)),
      calibration.cameras.length > 1 && cameraTable(calibration),
      calibration.mirrors.length > 0 && mirrorTable(calibration));
}

function wandPart() {
  return part('wand', 'The wand', wandWords(data), figureRow(lengthHistogram(data)));
}

function optionsPart() {
  const rows = Object.entries(data.options)
                   .map(
                       ([name, value]) => element(
                           'tr', {}, element('td', {}, name),
                           element('td', {}, value === '' ? '–' : value)));
  return element(
      'details', {id: 'options'}, element('summary', {}, 'Options used'),
      element('table', {class: 'numbers'}, ...rows));
}

showSummary(data);
const parts = document.getElementById('parts');
if (isWand) parts.append(wandPart());
if (calibration.cameras.length > 1) parts.append(spacePart());
parts.append(...calibration.cameras.map(cameraPart));
if (calibration.cameras.length === 1) parts.append(spacePart());
if (Object.keys(data.options).length > 0) parts.append(optionsPart());
document.getElementById('footer').textContent =
    `articap ${data.articap_version}. This page is complete in itself and needs no network.`;
document.documentElement.dataset.ready = 'true';
