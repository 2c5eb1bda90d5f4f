// SPDX-License-Identifier: MIT
// Opens the report page in Chromium, offline, and uses it:
//   node page_test.mjs ARTICAP_SAMPLE_RESULTS NODE_MODULES
// Exit code 77 (skipped) where there is no Chromium.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {join, resolve} from 'node:path';

import {folder, openInBrowser, runTests} from './browser.mjs';

const sampleResults = resolve(process.argv[2]);

async function openPage(numFrames, viewport, colorScheme) {
  const results = join(folder, String(numFrames));
  execFileSync(sampleResults, [results, String(numFrames)]);
  return openInBrowser(join(results, 'report.html'), viewport, colorScheme);
}

/** How many colours a canvas shows: one means blank. */
const coloursOf = (page, selector) => page.$eval(selector, (canvas) => {
  const copy = new OffscreenCanvas(64, 64);
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0, 64, 64);
  const pixels = new Uint32Array(context.getImageData(0, 0, 64, 64).data.buffer);
  return new Set(pixels).size;
});
const frameOf = async (page) => Number((await page.textContent('#readout b')).replace('frame ', ''));
const pixelsOf = (page) => page.$eval('.stage-3d canvas', (canvas) => canvas.toDataURL());

const tests = {
  async 'shows every part without complaint'() {
    const page = await openPage(1590, {width: 1400, height: 1000}, 'light');
    assert.equal(await page.textContent('h1'), 'A sample take');
    assert.match(await page.textContent('#facts'), /590 frames/);
    assert.equal(await page.locator('.warnings li').count(), 2);
    assert.equal(await page.locator('.stage-card').count(), 3);
    for (const card of await page.$$('.stage-card')) {
      const {height} = await card.boundingBox();
      assert.ok(height < 600, `a stage's card is ${height} pixels high`);
    }
    assert.equal(await page.locator('#parameters .plot canvas').count(), 11);
    assert.equal(await page.locator('#residuals tr').count(), 37);
    assert.ok(await coloursOf(page, '.stage-3d canvas') > 50, 'the head in 3D is blank');
    assert.ok(await coloursOf(page, '#residuals canvas') > 5, 'the heat strip is blank');
    for (const plot of await page.$$('.plot canvas'))
      assert.ok(await plot.evaluate((canvas) =>
          canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some((value) => value > 0)),
          'a plot is blank');
    assert.deepEqual(page.complaints, []);
  },

  async 'plays, steps and stops by keys'() {
    const page = await openPage(1590, {width: 1400, height: 1000}, 'dark');
    assert.equal(await frameOf(page), 1);
    await page.keyboard.press('ArrowRight');
    assert.equal(await frameOf(page), 2);
    await page.keyboard.press('Shift+ArrowRight');
    assert.equal(await frameOf(page), 12);
    const before = await pixelsOf(page);
    await page.keyboard.press('Space');
    await page.waitForFunction(() => Number(document.querySelector('.transport input').value) > 25);
    await page.keyboard.press('Space');
    assert.notEqual(await pixelsOf(page), before, 'the head does not move');
    const stopped = await frameOf(page);
    await page.waitForTimeout(200);
    assert.equal(await frameOf(page), stopped);
    assert.deepEqual(page.complaints, []);
  },

  async 'links the cursor of the plots with the head, and zooms all plots'() {
    const page = await openPage(1590, {width: 1400, height: 1000}, 'light');
    const over = page.locator('#parameters .u-over').first();
    await over.scrollIntoViewIfNeeded();
    const box = await over.boundingBox();
    await page.mouse.move(box.x + box.width / 4, box.y + 20);
    const frame = await frameOf(page);
    assert.ok(Math.abs(frame - 1590 / 4) < 12, `the head is at frame ${frame}`);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2, box.y + 20, {steps: 4});
    await page.mouse.up();
    await page.mouse.move(box.x + 1, box.y + 20);
    const zoomed = await frameOf(page);
    assert.ok(Math.abs(zoomed - 1590 / 4) < 12, `the left edge is at frame ${zoomed}`);
    await page.mouse.dblclick(box.x + 1, box.y + 20);
    await page.mouse.move(box.x + 2, box.y + 20);
    assert.ok(await frameOf(page) < 8);
    assert.deepEqual(page.complaints, []);
  },

  async 'fits a window of 800 pixels'() {
    const page = await openPage(1590, {width: 800, height: 900}, 'light');
    const width = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 800, `the page is ${width} pixels wide`);
    assert.deepEqual(page.complaints, []);
  },

  async 'shows a long take and an empty one'() {
    const long = await openPage(80000, {width: 1400, height: 1000}, 'light');
    assert.match(await long.textContent('#facts'), /22 min/);
    assert.deepEqual(long.complaints, []);
    for (const numFrames of [0, 1]) {
      const page = await openPage(numFrames, {width: 1400, height: 1000}, 'light');
      assert.deepEqual(page.complaints, [], `${numFrames} frames`);
    }
  },
};

await runTests(tests);
