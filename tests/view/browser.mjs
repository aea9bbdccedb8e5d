// What the tests of pages share, which are called with NODE-FOLDER BROWSER FOLDER: Chromium or Firefox, and pages that are watched.
import assert from 'node:assert/strict';
import {createRequire} from 'node:module';
import {basename, join} from 'node:path';

const [nodeFolder, executablePath] = process.argv.slice(2);
const {chromium, firefox} = createRequire(join(nodeFolder, 'node_modules', 'x'))('playwright-core');

export const folder = process.argv[4];

// args: of Chromium. Firefox has no WebGL without a screen: where there is one (browser.py), it is used. It takes no option for
// less motion.
export function launch(args = []) {
  if (basename(executablePath).startsWith('firefox')) {
    return firefox.launch({executablePath, channel: 'moz-firefox', headless: !process.env.DISPLAY, firefoxUserPrefs: {'webgl.force-enabled': true, 'ui.prefersReducedMotion': 1}});
  }
  return chromium.launch({executablePath, args: ['--no-sandbox', ...args]});
}

// A page that is open, in a window of its own. At its end nothing was asked for but what is allowed, or said to the console.
// options.profile: a context to open it in, which stays: pages of one profile find what the ones before have stored.
export async function watch(browser, url, isAllowed, options) {
  const context = options.profile || await browser.newContext(options);
  const page = await context.newPage();
  const said = [];
  page.on('console', (message) => said.push('console: ' + message.text()));
  page.on('pageerror', (problem) => said.push('error: ' + problem.message));
  page.on('dialog', (dialog) => { said.push('dialog: ' + dialog.message()); dialog.dismiss(); });
  page.on('request', (request) => { if (!isAllowed(request.url())) said.push('request: ' + request.url()); });
  if (options.prepare) await page.addInitScript(options.prepare);
  await page.goto(url);
  const end = async () => {
    assert.deepEqual(said, []);
    if (process.env.FFD_SCREENSHOTS) await page.screenshot({path: join(process.env.FFD_SCREENSHOTS, `${options.name}.png`)});
    await (options.profile ? page : context).close();
  };
  return {page, end, said};
}

// Ends the process.
export async function runAll(browser, tests) {
  let failed = 0;
  for (const test of tests) {
    const began = Date.now();
    try {
      await test();
      console.log(`passed  ${test.name} (${Date.now() - began} ms)`);
    } catch (problem) {
      failed++;
      console.log(`FAILED  ${test.name}: ${problem.message}`);
    }
  }
  await browser.close();
  process.exit(failed ? 1 : 0);
}
