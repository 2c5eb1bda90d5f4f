// SPDX-License-Identifier: MIT
// A picture of a report page, for the documentation and for looking at changes:
//   node screenshot.mjs NODE_MODULES report.html picture.png [WIDTH [HEIGHT|full [light|dark [FRAME]]]]
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [modules, file, picture, width = '1400', height = '1000', colorScheme = 'light', frame = '0'] =
    process.argv.slice(2);
const {chromium} = createRequire(join(resolve(modules), 'any.js'))('playwright-core');
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: [
    '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
  ],
});
const isWhole = height === 'full';
const page = await browser.newPage(
    {viewport: {width: Number(width), height: isWhole ? 1000 : Number(height)}, colorScheme});
await page.goto(pathToFileURL(resolve(file)).href);
await page.waitForFunction(() => document.documentElement.dataset.ready === 'true');
for (let i = 0; i < Number(frame); ++i) await page.keyboard.press('ArrowRight');
await page.waitForTimeout(1000);
await page.screenshot({path: picture, fullPage: isWhole});
await browser.close();
