// SPDX-License-Identifier: MIT
// Where cameras, mirrors and boards stood, in the stage frame: mostly that of a camera, x to the
// right, y down, z ahead.
import {element, formatFixed, formatNumber} from '../src/text.js';

import {applied, appliedInverse, meetingPoint, rectangleAround, reflected} from './geometry.js';
import {withSigma} from './lens.js';
import {SpaceDrawing} from './space_drawing.js';
import {countOf, isKnown, isUsed, millimetres} from './statistics.js';
import {decimalsOf, figure, legend} from './svg.js';

const centreOf = ({cam_from_stage: pose}) => appliedInverse(pose, [0, 0, 0]);

/** The corners of the picture at a depth before the camera. */
function frustumOf({cam_from_stage: pose, lens, width, height}, depth_mm) {
  return [[0, 0], [width, 0], [width, height], [0, height]].map(
      ([u, v]) => appliedInverse(pose, [
        depth_mm * (u - lens.cx_px) / lens.fx_px, depth_mm * (v - lens.cy_px) / lens.fy_px, depth_mm
      ]));
}

function boardOutline(
    {corner_columns: columns, corner_rows: rows, square_mm: square}, {stage_from_board: pose}) {
  return [[-1, -1], [columns, -1], [columns, rows], [-1, rows]].map(
      ([x, y]) => applied(pose, [x * square, y * square, 0]));
}

/** The part of a mirror in which boards were seen. */
function mirrorOutline(calibration, index) {
  const mirror = calibration.mirrors[index];
  const camera = centreOf(calibration.cameras[mirror.camera]);
  const points =
      calibration.sightings.filter((sighting) => sighting.used && sighting.mirror === index)
          .flatMap(
              ({placement}) => boardOutline(calibration.board, calibration.placements[placement]))
          .map((corner) => meetingPoint(mirror, camera, reflected(mirror, corner)));
  return points.length ? rectangleAround(mirror.normal_in_stage, points) : null;
}

/** Everything that is drawn, as polygons of the stage. */
function shapesOf(calibration) {
  const kMostBoards = 200;
  const placements =
      [...new Set((calibration.sightings ?? []).filter(isUsed).map(({placement}) => placement))];
  const every = Math.ceil(placements.length / kMostBoards);
  const boards =
      placements.filter((_, i) => i % every === 0)
          .map((placement) => boardOutline(calibration.board, calibration.placements[placement]));
  const centres = calibration.cameras.map(centreOf);
  const ghosts = calibration.mirrors.map((mirror) => reflected(mirror, centres[mirror.camera]));
  const around = [...centres, ...ghosts, ...boards.flat()];
  const span_mm = Math.max(100, ...[0, 1, 2].map((axis) => {
    const values = around.map((point) => point[axis]);
    return Math.max(...values) - Math.min(...values);
  }));
  const depth_mm = 0.13 * span_mm;
  const cameras = calibration.cameras.map((camera, i) => ({
                                            kind: 'camera',
                                            name: camera.name,
                                            centre: centres[i],
                                            frustum: frustumOf(camera, depth_mm)
                                          }));
  calibration.mirrors.forEach((mirror, i) => {
    const {name, frustum} = cameras[mirror.camera];
    cameras.push({
      kind: 'ghost',
      name: `${name} as mirrored`,
      centre: ghosts[i],
      frustum: frustum.map((point) => reflected(mirror, point))
    });
  });
  const mirrors =
      calibration.mirrors.map(({name}, i) => ({name, outline: mirrorOutline(calibration, i)}))
          .filter(({outline}) => outline);
  return {boards, cameras, mirrors, numBoards: placements.length};
}

/** The camera whose frame the stage is; undefined where that is a board's or an L-frame's. */
function originOf({cameras}) {
  const kNothing = 1e-9;
  const isZero = (value) => Math.abs(value) < kNothing;
  return cameras.find(({cam_from_stage: {rotation_wxyz: [, ...axis], translation_mm: to}}) =>
                          [...axis, ...to].every(isZero))
      ?.name;
}

export function spaceViews(calibration) {
  const shapes = shapesOf(calibration);
  const origin = originOf(calibration);
  const views = [
    {
      heading: origin ? 'Seen from above' : 'Seen along the y axis',
      label: 'Top view',
      across: ([x]) => x,
      down: ([, , z]) => -z,
      axes: {right: 'x', up: 'z'}
    },
    {
      heading: origin ? `Seen from the right of “${origin}”` : 'Seen against the x axis',
      label: 'Side view',
      across: ([, , z]) => z,
      down: ([, y]) => y,
      axes: {right: 'z', down: 'y'}
    },
  ];
  const entries = [['camera', 'cameras']];
  if (shapes.boards.length > 0)
    entries.push(['board', `board, ${countOf(shapes.boards.length, 'place')}`]);
  if (shapes.boards.length < shapes.numBoards) entries.at(-1)[1] += ` of ${shapes.numBoards}`;
  if (shapes.mirrors.length > 0)
    entries.push(
        ['mirror', 'mirror, where it was looked at'],
        ['ghost', 'where its picture seems to be taken from']);
  return SpaceDrawing.alike(shapes, views)
      .map(
          (drawing, i) => figure(
              'space-view', views[i].heading, drawing, legend(entries),
              i === 0 &&
                  'Both views have the same scale. ' +
                      (origin ? `The origin is ${origin}: x points to its right, y down, z ahead.` :
                                'The axes are those of the stage frame that was chosen.')));
}

export function rigidityWords({held_out: heldOut}) {
  if (!isKnown(heldOut.rigidity_mm))
    return element(
        'p', {class: 'words'},
        'No board was seen by two views among those held out: how rigid the geometry is was not ' +
            'checked.');
  const kMuch = 1.3;  // with few placements the ratio scatters about 1
  const ratio = heldOut.rigidity_mm / heldOut.expected_rigidity_mm;
  const judgement = ratio < kMuch ?
      'the geometry adds little error of its own.' :
      'something moved, bent, or was not recorded at the same instants.';
  const distances = countOf(heldOut.distances, 'distance');
  const placements = countOf(heldOut.views, 'placement');
  return element(
      'p', {class: 'words'},
      `${distances} between corners on ${placements} of the board that took no part in the ` +
          'calibration came out right to ',
      element('b', {}, millimetres(heldOut.rigidity_mm)),
      ` (RMS). The noise of the corners alone would give ` +
          `${millimetres(heldOut.expected_rigidity_mm)}; this is ${formatFixed(ratio, 2)} times ` +
          `as much: ${judgement}`);
}

function numbersTable(columns, rows) {
  return element(
      'div', {class: 'card table-card'},
      element(
          'table', {class: 'numbers'},
          element('tr', {}, ...columns.map((text) => element('th', {}, text))),
          ...rows.map(
              (cells) => element('tr', {}, ...cells.map((text) => element('td', {}, text))))));
}

const degreesOf = (radians) => radians * 180 / Math.PI;
const normOf = (vector) => vector.some((value) => value === null) ? null : Math.hypot(...vector);

function sigmaText(value) {
  if (value === null) return 'not known';
  return value === 0 ? 'held' : formatFixed(value, decimalsOf(value) + 1);
}

export function cameraTable({cameras}) {
  const hasOffsets = cameras.some(({time_offset_s: offset}) => offset !== 0);
  const columns = [
    'camera', 'x (mm)', 'y (mm)', 'z (mm)', 'sigma (mm)', 'sigma of direction (°)',
    ...(hasOffsets ? ['added to its times (ms)', 'sigma (ms)'] : []), 'noise (px)'
  ];
  return numbersTable(columns, cameras.map((camera) => {
    const {translation_sigmas_mm: translation, rotation_sigmas_rad: rotation} =
        camera.cam_from_stage;
    const turn = normOf(rotation);
    const sigma_ms = isKnown(camera.time_offset_sigma_s) ? 1e3 * camera.time_offset_sigma_s : null;
    const [offset, offsetSigma] = withSigma(1e3 * camera.time_offset_s, sigma_ms);
    return [
      camera.name, ...centreOf(camera).map((value) => formatFixed(value, 2)),
      sigmaText(normOf(translation)), sigmaText(turn === null ? null : degreesOf(turn)),
      ...(hasOffsets ? [offset, offsetSigma] : []), sigmaText(camera.noise_px)
    ];
  }));
}

export function mirrorTable({mirrors, cameras}) {
  const columns = [
    'mirror', 'seen by', 'normal x', 'y', 'z', 'sigma of direction (°)',
    'distance from origin (mm)', 'sigma (mm)', 'glass (mm)', 'noise (px)'
  ];
  return numbersTable(
      columns,
      mirrors.map(
          (mirror) =>
              [mirror.name,
               cameras[mirror.camera].name,
               ...mirror.normal_in_stage.map((value) => formatFixed(value, 5)),
               sigmaText(
                   mirror.normal_sigma_rad === null ? null : degreesOf(mirror.normal_sigma_rad)),
               ...withSigma(mirror.distance_mm, mirror.distance_sigma_mm),
               mirror.glass_mm > 0 ? formatNumber(mirror.glass_mm) : 'none',
               sigmaText(mirror.noise_px),
  ]));
}
