// Measures a page of `ffd edit` in headless Chromium: edit_page.mjs NODE-FOLDER BROWSER PAGE STEPS. Prints JSON: milliseconds of redraws without a
// change, and of steps of a drag in turns with them; resident bytes of the page's process, less those of an empty page.
import {readFileSync, readdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

const [nodeFolder, executablePath, path, steps] = process.argv.slice(2);
const {chromium} = createRequire(join(nodeFolder, 'node_modules', 'x'))('playwright-core');

// Of the largest process that draws a page.
function resident() {
  let most = 0;
  for (const pid of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      if (!readFileSync(`/proc/${pid}/cmdline`, 'utf8').includes('--type=renderer')) continue;
      most = Math.max(most, 1024 * Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'))[1]));
    } catch (gone) {
      continue;
    }
  }
  return most;
}

// A picture is drawn in full when the colour of a pixel is known.
async function measure(count) {
  const canvas = document.getElementById('view'), gl = canvas.getContext('webgl2'), pixel = new Uint8Array(4);
  const drawn = () => new Promise((done) => requestAnimationFrame(() => setTimeout(() => {
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    done();
  })));
  const timed = async (act) => {
    await drawn();
    const began = performance.now();
    act();
    await drawn();
    return performance.now() - began;
  };
  const redraw = () => canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}));
  const {ffdPage} = globalThis;
  ffdPage.select([Math.floor(ffdPage.offsets().length / 6)]);
  const result = {redraw: [], step: []};
  for (let i = 0; i < count; i++) {
    result.redraw.push(await timed(redraw));
    result.step.push(await timed(() => ffdPage.move([0, 1e-3, 0])));
  }
  return result;
}

const browser = await chromium.launch({executablePath, args: ['--no-sandbox', '--enable-unsafe-swiftshader']});
const open = async (url) => {
  const page = await (await browser.newContext({viewport: {width: 1280, height: 800}})).newPage();
  await page.goto(url);
  return page;
};
const empty = await open('about:blank');
await empty.waitForTimeout(500);
const before = resident();
await empty.close();
const page = await open(pathToFileURL(path).href);
await page.waitForFunction(() => globalThis.ffdPage);
const measured = await page.evaluate(measure, Number(steps));
await page.waitForTimeout(3000);
console.log(JSON.stringify({...measured, memory: resident() - before}));
await browser.close();
