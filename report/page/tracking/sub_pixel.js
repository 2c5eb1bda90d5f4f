// SPDX-License-Identifier: MIT
// Where within their pixels the centres of dots lie.
import {countOf} from '../calibration/statistics.js';
import {figure, legend, Plot} from '../calibration/svg.js';
import {element, formatFixed} from '../src/text.js';

import {part} from './parts.js';

function histogram({view, dots, x, y}) {
  const mean = dots / x.counts.length;
  const plot = new Plot({
    x: [-0.5, 0.5],
    y: [0, 1.1 * Math.max(...x.counts, ...y.counts, 1)],
    xLabel: 'from the middle of the pixel, px',
    yLabel: 'how many dots',
    label: `Sub-pixel histogram of ${view}`,
  });
  const width = 1 / x.counts.length;
  x.counts.forEach((count, i) => plot.bar(i * width - 0.5, (i + 1) * width - 0.5, count, 'bar'));
  plot.line(
      y.counts.flatMap((count, i) => [[i * width - 0.5, count], [(i + 1) * width - 0.5, count]]),
      'curve');
  plot.line([[-0.5, mean], [0.5, mean]], 'limit');
  const words = (axis, {peak_to_mean: peak, chi_square: chi}) =>
      `${axis}: peak ${formatFixed(peak, 2)} times the mean, χ² ${formatFixed(chi, 0)}`;
  return figure(
      'sub-pixel', view, plot.svg, legend([['bar', 'along x'], ['curve', 'along y']]),
      `${countOf(dots, 'dot')}. ${words('x', x)}; ${words('y', y)}; a flat one has χ² of about ${
          x.counts.length - 1}.`);
}

export function subPixelPart({sub_pixel: views}) {
  return part(
      'sub-pixel', 'Sub-pixel histogram',
      'Centres should lie anywhere within their pixels alike. Peaks at the middle or the edges ' +
          'say that centres are drawn there: dots too small, saturated, or thresholded. A head ' +
          'that hardly moves makes peaks too, as its dots stay where they are.',
      element(
          'div', {class: 'figure-row'},
          ...views.filter(({dots}) => dots > 0).map(histogram)));
}
