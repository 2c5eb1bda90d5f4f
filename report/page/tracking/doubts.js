// SPDX-License-Identifier: MIT
// The frames at which a person should look, with their pictures.
import {element, formatFixed, formatNumber} from '../src/text.js';

import {frameText, part} from './parts.js';

function card(doubt, picture, review) {
  return element(
      'figure', {class: 'card doubt'},
      element(
          'h3', {}, doubt.marker, element('span', {class: 'aside'}, ` ${frameText(doubt.frame, review)}`)),
      element('img', {src: picture, alt: `${doubt.marker} in frame ${doubt.frame}, by view`}),
      element('figcaption', {}, doubt.why));
}

function row(doubt, review) {
  const frames = doubt.first === doubt.last ? `${doubt.first}` : `${doubt.first}–${doubt.last}`;
  return element(
      'tr', {}, element('td', {}, frames),
      element('td', {}, formatFixed((doubt.frame - review.first_frame) / review.rate_hz, 2)),
      element('td', {class: 'text'}, doubt.marker),
      element('td', {class: 'text'}, doubt.why), element('td', {}, formatFixed(doubt.score, 1)));
}

export function doubtsPart(review, pictures) {
  const {doubts} = review;
  if (doubts.length === 0)
    return part('doubts', 'Doubtful frames', 'There are none: no residual, margin, exchange or ' +
        'gap that is out of the usual.');
  const inTime = [...doubts].sort((a, b) => a.frame - b.frame);
  const heads = ['frames', 'time, s', 'marker', 'why', 'doubt'].map(
      (name, i) => element('th', i > 1 && i < 4 ? {class: 'text'} : {}, name));
  const list = element(
      'details', pictures.length === 0 ? {open: true} : {},
      element('summary', {}, `All ${formatNumber(doubts.length)} in the order of time`),
      element(
          'div', {class: 'card table-card'},
          element(
              'table', {class: 'numbers'}, element('tr', {}, ...heads),
              ...inTime.map((doubt) => row(doubt, review)))));
  return part(
      'doubts', 'Doubtful frames',
      'The greatest doubts first, spread over the take. ' +
          (pictures.length === 0 ? '' :
               'A ring is a dot that was found, a cross where the marker should be; the marker in ' +
                   'doubt is orange. ') +
          'What is wrong can be put right in a corrections file (--corrections).',
      element(
          'div', {class: 'doubt-row'},
          ...pictures.map((picture, i) => card(doubts[i], picture, review))),
      list);
}
