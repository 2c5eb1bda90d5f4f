// SPDX-License-Identifier: MIT
// The verdicts of the stages, what they mean, and the warnings.
import {countOf, percent} from '../calibration/statistics.js';
import {element, formatFixed, formatNumber, withUnit} from '../src/text.js';
import {showVerdict} from '../src/verdict.js';

import {medianOf} from './parts.js';

const meanOf = (markers, key) =>
    markers.reduce((sum, marker) => sum + marker[key], 0) / Math.max(1, markers.length) / 100;

/** Sentences that need no knowledge of tracking. */
function meaningOf({markers, views, doubts}) {
  const sentences = [
    `Of all samples ${percent(meanOf(markers, 'measured_percent'))} are measured${
        views.length > 0 ?
            ` by two views or more, ${percent(meanOf(markers, 'one_view_percent'))} seen by one ` +
                'view, their depth estimated' :
            ''}, ${percent(meanOf(markers, 'filled_percent'))} filled, ${
        percent(meanOf(markers, 'gap_percent'))} missing.`
  ];
  const residual_px = medianOf(markers.map(({residual_rms_px: rms}) => rms));
  if (residual_px !== null)
    sentences.push(`The views of a marker disagree by ${
        withUnit(formatNumber(residual_px, 3), 'px')} (RMS, the middle marker).`);
  const jitter_mm = medianOf(markers.map(({jitter_at_rest_mm: jitter}) => jitter));
  if (jitter_mm !== null)
    sentences.push(`At rest a coordinate jitters by ${
        withUnit(formatFixed(jitter_mm, 4), 'mm')} (standard deviation, the middle marker).`);
  sentences.push(
      doubts.length === 0 ?
          'No frame is doubtful.' :
          `${countOf(doubts.length, 'place')} of the take should be looked at; see below.`);
  return sentences;
}

export function showSummary(title, stages, review) {
  const {rate_hz: rate, frames, views, markers} = review;
  showVerdict({
    title,
    facts: [
      countOf(markers.length, 'marker'), countOf(frames, 'frame'),
      `${formatNumber(rate)}\u202fHz, ${formatFixed(frames / rate, 1)}\u202fs`,
      views.length > 0 ? `views: ${views.join(', ')}` : 'from a file of markers'
    ],
    usable: stages.every(({usable}) => usable),
    says: stages.map(({stage, verdict}) => `${stage}: ${verdict}`),
    meaning: meaningOf(review),
    warnings: stages.flatMap(
        ({stage, warnings}) => warnings.map(
            (warning) => [element('span', {class: 'stage'}, `${stage}: `), warning])),
  });
}
