// SPDX-License-Identifier: MIT
import {element} from '../src/text.js';

import {doubtsPart} from './doubts.js';
import {numbersPart} from './numbers.js';
import {subPixelPart} from './sub_pixel.js';
import {showSummary} from './summary.js';
import {stripsParts} from './strips.js';

const data = JSON.parse(document.getElementById('data').textContent);
const {review} = data;

function optionsPart(stages) {
  const rows = stages.flatMap(
      ({stage, options}) => Object.entries(options).map(
          ([name, value]) => element(
              'tr', {}, element('td', {}, stage), element('td', {class: 'text'}, name),
              element('td', {}, value === '' ? '–' : value))));
  return element(
      'details', {id: 'options'}, element('summary', {}, 'Options used'),
      element('table', {class: 'numbers'}, ...rows));
}

const stages = Object.values(data).filter((value) => value?.stage);
showSummary(data.title, stages, review);
const parts = document.getElementById('parts');
parts.append(...stripsParts(review), numbersPart(review), doubtsPart(review, data.pictures));
if (review.sub_pixel.length > 0) parts.append(subPixelPart(review));
parts.append(optionsPart(stages));
document.getElementById('footer').textContent =
    `articap ${stages[0].articap_version}. This page is complete in itself and needs no network.`;
document.documentElement.dataset.ready = 'true';
