// SPDX-License-Identifier: MIT
// The head of the page: what was calibrated, the verdict, what it means, the warnings.
import {showVerdict} from '../src/verdict.js';

import {countOf, isKnown, isUsed, percent, pixels} from './statistics.js';

function titleOf({calibration}) {
  const {cameras, mirrors, wand} = calibration;
  if (wand) return `${countOf(cameras.length, 'camera')} calibrated by a wand`;
  if (mirrors.length > 0)
    return `Calibration of ${cameras[0].name} with ${countOf(mirrors.length, 'mirror')}`;
  return cameras.length > 1 ? `Calibration of ${cameras.length} cameras` :
                              `Calibration of the lens of ${cameras[0].name}`;
}

function factsOf({figures, calibration}) {
  const {wand, board, sightings, cameras} = calibration;
  if (wand) return [countOf(wand.instants, 'instant'), cameras.map(({name}) => name).join(', ')];
  const used = sightings.filter(isUsed).length;
  return [
    `board ${board.name} (${board.corner_columns} × ${board.corner_rows} corners, ${
        board.square_mm} mm apart)`,
    `${countOf(used, 'sighting')} used`, `${figures.set_aside} set aside`
  ];
}

/** "0.1 px", or "0.1 px (left) to 0.5 px (right)" where some view is noisier by half. */
function noiseOf({cameras, mirrors, sigma_px}) {
  const views = [...cameras, ...mirrors].filter(({noise_px}) => isKnown(noise_px));
  if (views.length === 0) return pixels(sigma_px);
  views.sort((a, b) => a.noise_px - b.noise_px);
  const [least, most] = [views[0], views[views.length - 1]];
  const kAlike = 1.5;
  if (most.noise_px <= kAlike * least.noise_px) return pixels(sigma_px);
  return `${pixels(least.noise_px)} (${least.name}) to ${pixels(most.noise_px)} (${most.name})`;
}

/** Sentences that need no knowledge of calibration. */
function meaningOf({calibration}) {
  const {wand, cameras, held_out: heldOut} = calibration;
  const what = wand ? 'the markers of the wand' : 'the corners of the board';
  const meaning =
      [`On average (RMS) ${what} were seen ${
           pixels(calibration.rms_px)} from where the calibration expects them; ` +
       `the noise of one coordinate is ${noiseOf(calibration)} (standard deviation).`];
  if (heldOut && isKnown(heldOut.rms_px))
    meaning.push(
        `Pictures that were left out in turn are predicted to ${pixels(heldOut.rms_px)}: ` +
        (heldOut.rms_px <= 1.25 * calibration.rms_px ?
             'as well as those that were used, so the lens model is not too rich.' :
             'worse than those that were used. Record more pictures, or use a simpler lens ' +
                  'model.'));
  if (!wand)
    meaning.push(
        `Corners were seen in ${
            cameras
                .map(
                    ({name, coverage}) => `${percent(coverage.part)} of the picture${
                        cameras.length > 1 ? ` of ${name}` : ''}`)
                .join(', ')}; ` +
        'elsewhere the distortion is extrapolated.');
  return meaning;
}

/** Those of pictures set aside are said once; the reasons stand with the pictures. */
function warningsOf({warnings, calibration}) {
  const aside = (calibration.sightings ?? []).filter(({used}) => !used);
  const others = warnings.filter(
      (warning) => !aside.some(
          ({source, reason}) => warning.endsWith(`${source} is set aside: ${reason}`)));
  if (aside.length > 0)
    others.push(
        `${countOf(aside.length, 'sighting')} of ${
            calibration.sightings.length} set aside, with the reasons below. ` +
        'Look at these pictures: was the board moving, bent or partly hidden? If enough others ' +
        'remain, nothing needs to be done.');
  return others;
}

export function showSummary(data) {
  showVerdict({
    title: titleOf(data),
    facts: factsOf(data),
    usable: data.usable,
    says: [data.verdict.replace(/^usable: /, '').replace(' +- ', ' ± ')],
    meaning: meaningOf(data),
    warnings: warningsOf(data).map((warning) => [warning]),
  });
}
