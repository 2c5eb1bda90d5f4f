// SPDX-License-Identifier: MIT
// Every sighting of a camera with its root mean square; those set aside with their reasons.
import {element, formatFixed, formatNumber} from '../src/text.js';

import {isKnown, isUsed, nameOf, pixels} from './statistics.js';

function row(sighting, mirrors, full_px) {
  const {rms_px: rms, used, reason} = sighting;
  const share = Math.min(1, (rms ?? 0) / full_px);
  const bar = element(
      'span', {class: 'track'}, element('i', {style: `width: ${(100 * share).toFixed(1)}%`}));
  return element(
      'li', {class: used ? 'used' : 'aside'},
      element('span', {class: 'source'}, used ? '' : '✗ ', nameOf(sighting, mirrors)), bar,
      element('span', {class: 'value'}, isKnown(rms) ? formatFixed(rms, 3) : '–'),
      used ? '' : element('span', {class: 'reason'}, `set aside: ${reason}`));
}

export function viewBars(sightings, mirrors) {
  const kShown = 30;
  const byRms = (a, b) => (b.rms_px ?? Infinity) - (a.rms_px ?? Infinity);
  const used = sightings.filter(isUsed).sort(byRms);
  const aside = sightings.filter(({used}) => !used).sort(byRms);
  const full_px = 1.1 * Math.max(1e-6, ...used.map(({rms_px: rms}) => rms));
  const list = (chosen) =>
      element('ol', {class: 'views'}, ...chosen.map((sighting) => row(sighting, mirrors, full_px)));
  const card = element(
      'article', {class: 'card view-bars'}, element('h3', {}, 'Views'),
      element(
          'p', {class: 'explains'},
          'Root mean square of the residuals of each view, px, the largest first. A full bar is ' +
              `${pixels(full_px)}.`));
  if (aside.length > 0) card.append(list(aside));
  card.append(list(used.slice(0, kShown)));
  if (used.length > kShown)
    card.append(element(
        'details', {},
        element(
            'summary', {},
            `${formatNumber(used.length - kShown)} more, none above ` +
                pixels(used[kShown].rms_px)),
        list(used.slice(kShown))));
  return card;
}
