// SPDX-License-Identifier: MIT
// The figures of every marker, and which view sees it.
import {element, formatFixed, formatNumber} from '../src/text.js';

import {part} from './parts.js';

const kColumns = [
  ['seen by two', ({measured_percent: share}) => `${formatFixed(share, 1)}%`],
  ['by one', ({one_view_percent: share}) => `${formatFixed(share, 1)}%`],
  ['filled', ({filled_percent: share}) => `${formatFixed(share, 1)}%`],
  ['missing', ({gap_percent: share}) => `${formatFixed(share, 1)}%`],
  ['gaps', ({gaps}) => formatNumber(gaps)],
  ['longest, s', ({longest_gap_s: length}) => formatFixed(length, 2)],
  ['residual, px', ({residual_rms_px: rms}) => formatFixed(rms, 3)],
  ['residual, mm', ({residual_rms_mm: rms}) => formatFixed(rms, 4)],
  ['jitter at rest, mm', ({jitter_at_rest_mm: jitter}) => formatFixed(jitter, 4)],
  ['margin', ({median_margin: margin}) => formatFixed(margin, 1)],
  ['lowest', ({lowest_margin: margin}) => formatFixed(margin, 1)],
  ['in frame', ({lowest_margin_frame: frame}) => formatNumber(frame)],
];

function shareCell(share) {
  return element(
      'td', {class: 'share', style: `--share:${formatFixed(share, 1)}%`}, `${formatFixed(share, 1)}%`);
}

export function numbersPart({markers, views}) {
  const isFile = views.length === 0;
  const columns = kColumns.filter(([name]) => !isFile || !/by one|residual/.test(name))
                      .map(([name, text]) => [isFile ? name.replace(' by two', '') : name, text]);
  const head = [...columns.map(([name]) => name), ...views].map((name) => element('th', {}, name));
  const rows = markers.map(
      (marker) => element(
          'tr', {}, element('td', {}, marker.name),
          ...columns.map(([, text]) => element('td', {}, text(marker))),
          ...marker.seen_percent_by_view.map(shareCell)));
  return part(
      'numbers', 'In numbers',
      'Residuals are root mean squares. Jitter at rest: in the quietest second, the root of a ' +
          'sixth of the mean square of x(k−1) − 2x(k) + x(k+1), the standard deviation of white ' +
          'noise. Margin: the median.' +
          (isFile ? '' : ' On the right, in how many of the frames each view shows the marker.'),
      element(
          'div', {class: 'card table-card'},
          element(
              'table', {class: 'numbers'}, element('tr', {}, element('th', {}, 'marker'), ...head),
              ...rows)));
}
