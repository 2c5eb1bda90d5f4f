// SPDX-License-Identifier: MIT
// Opens the pages of calibrations in Chromium, offline:
//   node calibration_page_test.mjs ARTICAP_SAMPLE_CALIBRATIONS NODE_MODULES
// Exit code 77 (skipped) where there is no Chromium.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {join, resolve} from 'node:path';

import {folder, openInBrowser, runTests} from './browser.mjs';

execFileSync(resolve(process.argv[2]), [folder]);

const kWide = {
  width: 1400,
  height: 1000
};
const jsonOf = (name) => JSON.parse(readFileSync(join(folder, `${name}.json`), 'utf8'));
const open = (name, viewport = kWide, colorScheme = 'light') =>
    openInBrowser(join(folder, `${name}.html`), viewport, colorScheme);
const countOf = (page, selector) => page.locator(selector).count();
const gradeOf = (page) => page.textContent('.verdict .grade');

/** Labels of a drawing that lie over one another. */
const overlaps = (page, selector) =>
    page.$$eval(selector, (drawings) => drawings.flatMap((drawing) => {
      const texts = [...drawing.querySelectorAll('text')].map(
          (text) => [text.textContent, text.getBoundingClientRect()]);
      return texts.flatMap(
          ([a, box], i) =>
              texts.slice(i + 1)
                  .filter(
                      ([, other]) =>
                          Math.min(box.right, other.right) - Math.max(box.left, other.left) > 1 &&
                          Math.min(box.bottom, other.bottom) - Math.max(box.top, other.top) > 3)
                  .map(([b]) => `${a} | ${b}`));
    }));

const tests = {
  async 'a lens with every part, names from files as text'() {
    const page = await open('lens');
    const {calibration, warnings} = jsonOf('lens');
    assert.equal(await page.textContent('h1'), 'Calibration of the lens of left & <b>lower</b>');
    assert.match(await gradeOf(page), /Usable, with 2 warnings/);
    assert.equal(warnings.length, 3, 'the page says the two set aside at once');
    for (const part
             of ['coverage', 'residual-arrows', 'residual-histogram', 'distortion-curve',
                 'distortion-grid', 'lens-table'])
      assert.equal(await countOf(page, `figure.${part}`), 1, part);
    const fields = calibration.cameras[0].coverage.corners_in_field;
    assert.equal(
        await countOf(page, '.coverage rect.seen'), fields.filter((count) => count > 0).length);
    assert.equal(
        await countOf(page, '.coverage rect[fill^=url]'),
        fields.filter((count) => count === 0).length);
    assert.match(
        await page.textContent('.residual-arrows'),
        /used \(1\u202f350 corners\).*50 times enlarged/s);
    assert.equal(
        await countOf(page, '.views .used'), calibration.sightings.filter(({used}) => used).length);
    assert.equal(await countOf(page, '.views .aside'), 2);
    assert.match(
        await page.textContent('.views .aside >> nth=1'), /004\.png.*corner 12 by 3\.\d px/);
    assert.equal(
        await countOf(page, 'main img, main b, main script'), 0, 'a name became an element');
    assert.deepEqual(page.complaints, []);
  },

  async 'arrows point from where corners should be to where they were seen'() {
    const page = await open('lens');
    const {calibration} = jsonOf('lens');
    const {points_px: points, residuals_px: residuals} =
        calibration.sightings.find(({used}) => used);
    const kUnits = 440 / 640;
    const path = await page.getAttribute('.arrows.direct', 'd');
    const [x0, y0, x1, y1] = path.match(/[\d.]+/g).map(Number);
    const start = points[0].map((value, i) => (value - residuals[0][i] + 0.5) * kUnits);
    assert.ok(Math.hypot(x0 - start[0], y0 - start[1]) < 0.02, 'the arrow starts elsewhere');
    const shown = [x1 - x0, y1 - y0].map((length) => length / kUnits / 50);
    assert.ok(
        Math.hypot(shown[0] - residuals[0][0], shown[1] - residuals[0][1]) < 1e-3,
        `${shown} for ${residuals[0]}`);
  },

  async 'views are sorted, the largest first'() {
    const page = await open('rig');
    const {calibration: {cameras, sightings}} = jsonOf('rig');
    for (const camera of cameras.keys()) {
      const shown = await page.$$eval(
          `#camera-${camera} .used .value`,
          (cells) => cells.map((cell) => Number(cell.textContent)));
      const expected = sightings.filter((sighting) => sighting.camera === camera)
                           .map(({rms_px: rms}) => rms)
                           .sort((a, b) => b - a);
      assert.ok(expected.length > 10);
      assert.equal(shown.length, expected.length);
      shown.forEach(
          (rms, i) =>
              assert.ok(Math.abs(rms - expected[i]) <= 0.00051, `${rms} for ${expected[i]}`));
    }
  },

  async 'a rig with all its cameras, and how rigid it is'() {
    const page = await open('rig');
    const {calibration: {held_out: heldOut}} = jsonOf('rig');
    assert.equal(await countOf(page, 'figure.coverage'), 4);
    assert.equal(await countOf(page, '.space-view'), 2);
    for (const view of ['nth=0', 'nth=1']) {
      assert.equal(await countOf(page, `.space-view >> ${view} >> path.camera`), 4);
      assert.equal(await countOf(page, `.space-view >> ${view} >> path.board`), 40);
    }
    const said = parseFloat(await page.textContent('#space .words b'));
    assert.ok(Math.abs(said / heldOut.rigidity_mm - 1) < 0.01, `${said} for ${heldOut.rigidity_mm}`);
    assert.equal(await countOf(page, '#space .numbers tr'), 5);
    assert.match(await page.textContent('.space-view >> nth=0'), /The origin is [^:]+: x points/);
    assert.deepEqual(page.complaints, []);
  },

  async 'a mirror, and where its picture is taken from'() {
    const page = await open('mirror', kWide, 'dark');
    assert.equal(await countOf(page, '.space-view path.mirror'), 2);
    assert.equal(await countOf(page, '.space-view path.ghost'), 2);
    assert.equal(await countOf(page, '.arrows.mirrored-0'), 1);
    assert.deepEqual(page.complaints, []);
  },

  async 'a wand with its lengths, green without a warning'() {
    const page = await open('wand');
    assert.match(await gradeOf(page), /Usable$/);
    assert.ok(await page.isHidden('#warnings'));
    assert.equal(await countOf(page, '.length-histogram .bar'), 36 + 1);
    assert.match(
        await page.textContent('#wand .words'), /Wand score 0\.0\d+: .* at each of \d+ instants/);
    assert.deepEqual(page.complaints, []);
  },

  async 'what is not usable says so in words'() {
    const page = await open('blurred');
    assert.match(await gradeOf(page), /Not usable/);
    assert.match(await page.textContent('.verdict .says'), /residuals of 2\.\d+ px, more than 1/);
    assert.deepEqual(page.complaints, []);
  },

  async 'labels do not lie over one another, and pages fit their windows'() {
    for (const name of ['lens', 'rig', 'mirror', 'wand', 'blurred'])
      for (const width of [1400, 800, 420]) {
        const page = await open(name, {width, height: 900});
        assert.deepEqual(await overlaps(page, 'figure svg'), [], name);
        const needed = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(needed <= width, `${name} is ${needed} pixels wide in a window of ${width}`);
      }
  },
};

await runTests(tests);
