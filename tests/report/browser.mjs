// SPDX-License-Identifier: MIT
// Pages in Chromium, offline. The test's second argument is the folder node_modules.
// Exit code 77 (skipped) where there is no Chromium.
import {existsSync, mkdtempSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const kChromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
if (!existsSync(kChromium)) {
  console.log(`${kChromium} is not there: the page was not tried in a browser`);
  process.exit(77);
}
const {chromium} = createRequire(join(resolve(process.argv[3]), 'any.js'))('playwright-core');

/** For the files of the test; removed when the tests have run. */
export const folder = mkdtempSync(join(tmpdir(), 'articap-page-'));

const browser = await chromium.launch({
  executablePath: kChromium,
  args: [
    '--no-sandbox',
    '--disable-quic',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
    '--use-gl=angle',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
  ],
});

/**
 * A page that is ready; `complaints` gathers errors, warnings and requests that leave the machine.
 */
export async function openInBrowser(file, viewport, colorScheme) {
  const context = await browser.newContext({viewport, colorScheme, offline: true});
  const page = await context.newPage();
  page.complaints = [];
  page.on('console', (message) => {
    // Software rendering is slow and says so; that is the machine's, not the page's.
    if (['error', 'warning'].includes(message.type()) &&
        !/GPU stall|GroupMarker/.test(message.text()))
      page.complaints.push(message.text());
  });
  page.on('pageerror', (error) => page.complaints.push(error.stack));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url()))
      page.complaints.push(`asked for ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => document.documentElement.dataset.ready === 'true');
  await page.waitForTimeout(300);
  return page;
}

/** Runs {name: test} one after another and ends the process. */
export async function runTests(tests) {
  let failures = 0;
  for (const [name, test] of Object.entries(tests)) {
    try {
      await test();
      console.log(`ok: ${name}`);
    } catch (error) {
      failures += 1;
      console.log(`FAILED: ${name}\n${error.stack}`);
    }
  }
  await browser.close();
  rmSync(folder, {recursive: true});
  process.exit(failures ? 1 : 0);
}
