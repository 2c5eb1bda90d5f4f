// SPDX-License-Identifier: MIT
// Opens the pages of labelled markers in Chromium, offline:
//   node tracking_page_test.mjs ARTICAP_SAMPLE_TRACKING NODE_MODULES
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
const open = (name, viewport = kWide, colorScheme = 'light') =>
    openInBrowser(join(folder, `${name}.html`), viewport, colorScheme);
const countOf = (page, selector) => page.locator(selector).count();

/** The colour of a chart at a frame of a row, as [r, g, b]. */
const colorAt = (page, part, row, frame) => page.$eval(`#${part} canvas`, (canvas, {row, frame}) => {
  const scale = canvas.width / canvas.clientWidth;
  const x = (frame + 0.5) / 300 * canvas.width;
  return [...canvas.getContext('2d').getImageData(x, (row * 17 + 8) * scale, 1, 1).data.slice(0, 3)];
}, {row, frame});

/** What says of a frame that the mouse points at. */
async function readout(page, part, row, frame) {
  const box = await page.locator(`#${part} canvas`).boundingBox();
  await page.mouse.move(box.x + (frame + 0.5) / 300 * box.width, box.y + row * 17 + 8);
  return page.textContent(`#${part} .readout`);
}

const tests = {
  async 'every part is there, names from files as text'() {
    const page = await open('tracked');
    for (const part of ['seen', 'residuals', 'margins', 'numbers', 'doubts', 'sub-pixel'])
      assert.equal(await countOf(page, `#${part}.part`), 1, part);
    assert.match(await page.textContent('.verdict .grade'), /Usable, with a warning/);
    assert.equal(await page.textContent('#seen .names li:nth-child(2)'), 'chin <b>');
    assert.equal(await countOf(page, '#seen b'), 0, 'a name became an element');
    assert.equal(await countOf(page, '#numbers tr'), 4);
    assert.deepEqual(page.complaints, []);
  },

  async 'samples have the colours of what they rest on'() {
    const page = await open('tracked');
    const colors = {};
    for (const [name, row, frame] of
             [['measured', 0, 20], ['one', 1, 40], ['filled', 2, 105], ['missing', 2, 120]])
      colors[name] = await colorAt(page, 'seen', row, frame);
    assert.equal(new Set(Object.values(colors).map(String)).size, 4, JSON.stringify(colors));
    assert.deepEqual(await colorAt(page, 'seen', 1, 10), colors.measured);
    assert.match(await readout(page, 'seen', 1, 40), /chin <b>, frame 41, 0\.67\u202fs: one view/);
    assert.match(await readout(page, 'residuals', 0, 250), /frame 251.*: 1\u202fpx/);
  },

  async 'doubts are listed in the order of time, the first with pictures'() {
    const page = await open('tracked');
    const {review: {doubts}} = JSON.parse(readFileSync(join(folder, 'tracked.json'), 'utf8'));
    assert.equal(await countOf(page, '#doubts figure img'), 2);
    const frames = await page.$$eval(
        '#doubts table tr td:first-child', (cells) => cells.map((cell) => parseInt(cell.textContent, 10)));
    assert.equal(frames.length, doubts.length);
    assert.deepEqual(frames, [...frames].sort((a, b) => a - b));
  },

  async 'of a file of markers nothing is said of views'() {
    const page = await open('labelled');
    assert.match(await page.textContent('#facts'), /from a file of markers/);
    assert.equal(await countOf(page, '#sub-pixel, #residuals'), 0);
    assert.match(await page.textContent('#doubts'), /There are none/);
    assert.doesNotMatch(await page.textContent('#numbers'), /views?/);
    assert.deepEqual(page.complaints, []);
  },

  async 'nothing is wider than a narrow window, light or dark'() {
    for (const scheme of ['light', 'dark']) {
      const page = await open('tracked', {width: 420, height: 900}, scheme);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(wide <= 420, `${wide} px`);
      assert.deepEqual(page.complaints, []);
    }
  },
};

await runTests(tests);
