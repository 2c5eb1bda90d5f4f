// SPDX-License-Identifier: MIT
// The rig as the page evaluates it is the rig as articap does, to the rounding of the page's int16:
//   node page_rig_test.mjs ARTICAP_SAMPLE_RESULTS
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';

import {numbersOf} from '../../report/page/src/data.js';
import {Rig} from '../../report/page/src/rig.js';

const kTolerance_mm = 0.03;

const folder = mkdtempSync(join(tmpdir(), 'articap-rig-'));
execFileSync(resolve(process.argv[2]), [folder, '60']);
const page = readFileSync(join(folder, 'report.html'), 'utf8');
const [, json] = page.match(/<script type="application\/json" id="data">(.*?)<\/script>/s);
const {scene} = JSON.parse(json);
const rig = new Rig(scene.rig);
const values = scene.rig_values.map(numbersOf);

for (const frame of [5, 40]) {
  const expected = readFileSync(join(folder, `vertices_${frame}.csv`), 'utf8').trim().split(/[\n,]/).map(Number);
  assert.equal(rig.positions.length, expected.length);
  rig.pose(values.map((ofParameter) => ofParameter[frame]));
  let moved = 0;
  let largest = 0;
  expected.forEach((value, i) => {
    largest = Math.max(largest, Math.abs(rig.positions[i] - value));
    moved = Math.max(moved, Math.abs(rig.neutral[i] - value));
  });
  assert.ok(moved > 1, `frame ${frame}: the sample's rig hardly moves (${moved} mm)`);
  assert.ok(largest < kTolerance_mm, `frame ${frame}: the page is ${largest} mm off`);
  for (let i = 0; i < rig.normals.length; i += 3) {
    const length = Math.hypot(...rig.normals.subarray(i, i + 3));
    assert.ok(length === 0 || Math.abs(length - 1) < 1e-4, `normal ${i / 3} has the length ${length}`);
  }
  console.log(`frame ${frame}: at most ${largest.toFixed(4)} mm off, where vertices move ${moved.toFixed(1)} mm`);
}
rmSync(folder, {recursive: true});
