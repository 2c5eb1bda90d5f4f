// SPDX-License-Identifier: MIT
// How well the wand keeps its length.
import {element, formatFixed, formatNumber} from '../src/text.js';

import {countOf, millimetres, percent} from './statistics.js';
import {figure, histogramPlot, legend} from './svg.js';

const deviationOf = ({score, mean_length_mm: mean}) => score * mean / 100;

export function wandWords({calibration: {wand}, options}) {
  const limit = Number(options.max_wand_score);
  const judgement = wand.score <= limit ?
      `The limit for a usable calibration is ${formatNumber(limit)}; smaller is better.` :
      `That is more than the limit of ${formatNumber(limit)}.`;
  return element(
      'p', {class: 'words'}, 'Wand score ', element('b', {}, formatNumber(wand.score, 3)),
      `: the length of the wand, measured anew at each of ${
          countOf(wand.instants, 'instant')} from the pictures alone, scatters by ` +
          `${millimetres(deviationOf(wand))} (standard deviation) about ${
              formatFixed(wand.mean_length_mm, 2)} mm, which is ` +
          `${formatNumber(wand.score, 3)}% of it. ${judgement}`);
}

export function lengthHistogram({calibration: {wand}, options}) {
  const sigma = deviationOf(wand);
  if (!(sigma > 0)) return null;
  const limit = 4.5 * sigma;
  const plot = histogramPlot(wand.lengths_mm, {
    mean: wand.mean_length_mm,
    sigma,
    limit,
    axes: {
      xLabel: 'measured length of the wand, mm',
      yLabel: 'how many instants',
      label: 'Histogram of lengths'
    },
  });
  const true_mm = Number(options.length_mm);
  if (Math.abs(true_mm - wand.mean_length_mm) < limit)
    plot.mark(true_mm, `true: ${formatNumber(true_mm)} mm`, 'limit');
  const isWithin = (length_mm) => Math.abs(length_mm - wand.mean_length_mm) <= 2 * sigma;
  const within = wand.lengths_mm.filter(isWithin).length / wand.lengths_mm.length;
  return figure(
      'length-histogram', 'Lengths of the wand', plot.svg,
      legend([['bar', 'instants'], ['curve', `Gaussian of ${millimetres(sigma)}`]]),
      `${percent(within)} lie within two standard deviations of the mean, where the Gaussian has ` +
          '95.4%.');
}
