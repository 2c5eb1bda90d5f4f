// SPDX-License-Identifier: MIT
// How residuals are distributed.
import {cornersOf, isUsed, percent, pixels} from './statistics.js';
import {figure, histogramPlot, legend} from './svg.js';

export function residualHistogram(sightings, sigma_px) {
  const values = cornersOf(sightings.filter(isUsed)).flatMap(([, residual]) => residual);
  const kFinest_px = 0.002;  // the file keeps residuals to 0.001 px
  if (values.length === 0 || !(sigma_px > kFinest_px)) return null;
  const limit = 4.5 * sigma_px;
  const plot = histogramPlot(values, {
    mean: 0,
    sigma: sigma_px,
    limit,
    axes: {xLabel: 'residual, px (x and y)', yLabel: 'how many', label: 'Histogram of residuals'},
  });
  const within = (limit_px) => values.filter((value) => Math.abs(value) <= limit_px).length;
  const beyond = values.length - within(limit);
  return figure(
      'residual-histogram', 'Distribution of residuals', plot.svg,
      legend(
          [['bar', 'residuals of the corners used'], ['curve', `Gaussian of ${pixels(sigma_px)}`]]),
      `${
          percent(
              within(2 * sigma_px) /
              values.length)} lie within two standard deviations, where the ` +
          `Gaussian has 95.4%; ${
              beyond === 0 ? 'none lies' : `${beyond} lie`} beyond what is drawn.`);
}
