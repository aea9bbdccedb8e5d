// Opens pages of ffd edit in a browser for edit_page.py, which says what to do: edit.mjs NODE-FOLDER BROWSER FOLDER. Reads one
// command a line, {"do": NAME, ..}, and answers each with one line, {"value": ..} or {"problem": MESSAGE}.
import {createInterface} from 'node:readline';
import {readFileSync} from 'node:fs';
import {launch, watch} from './browser.mjs';

const SECONDS = 20;
const isLocal = (url) => /^(file|data|blob):/.test(url);
const browser = await launch(['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']);
const profiles = new Map(), pages = new Map();

// Runs in the page: a call of ffdPage. Arrays of numbers come back as their bytes, so that no bit is lost.
async function callPage([name, args]) {
  const encoded = (value) => {
    if (!ArrayBuffer.isView(value)) return {value: value === undefined ? null : value};
    const bytes = new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
    let text = '';
    for (let at = 0; at < bytes.length; at += 4096) text += String.fromCharCode(...bytes.subarray(at, at + 4096));
    return {type: value.constructor.name, bytes: btoa(text)};
  };
  if (typeof globalThis.ffdPage[name] !== 'function') return {missing: name};
  try {
    return encoded(await globalThis.ffdPage[name](...args));
  } catch (problem) {
    return {thrown: String(problem && problem.message || problem)};
  }
}

// A control by the name that people and screen readers know it by.
async function control(page, pattern) {
  for (const role of ['button', 'link', 'menuitem', 'radio', 'checkbox']) {
    const found = page.getByRole(role, {name: new RegExp(pattern, 'i')}).filter({visible: true});
    if (await found.count()) return found.first();
  }
  return null;
}

const commands = {
  async open({url, profile, width, height, name}) {
    const options = {viewport: {width, height}, reducedMotion: 'reduce', name};
    if (profile && !profiles.has(profile)) profiles.set(profile, await browser.newContext(options));
    const watched = await watch(browser, url, isLocal, {...options, profile: profiles.get(profile)});
    watched.page.setDefaultTimeout(1000 * SECONDS);
    const number = pages.size;
    pages.set(number, watched);
    await watched.page.waitForFunction(() => globalThis.ffdPage && globalThis.ffdPage.ready).catch(() => {
      throw new Error(`no ffdPage.ready in ${url}: ${watched.said.join('; ')}`);
    });
    await watched.page.evaluate(async () => { await globalThis.ffdPage.ready; });
    return number;
  },
  call: ({page, name, args}) => page.evaluate(callPage, [name, args]),
  text: ({page}) => page.evaluate(() => document.body.innerText),
  has: async ({page, pattern}) => Boolean(await control(page, pattern)),
  async click({page, pattern}) {
    const found = await control(page, pattern);
    if (!found) throw new Error(`no control named ${pattern}`);
    await found.click();
  },
  async download({page, pattern}) {
    const found = await control(page, pattern);
    if (!found) throw new Error(`no control named ${pattern}`);
    const [file] = await Promise.all([page.waitForEvent('download'), found.click()]);
    return {name: file.suggestedFilename(), text: readFileSync(await file.path(), 'utf8')};
  },
  press: ({page, keys}) => page.keyboard.press(keys),
  // Presses the pointer at the first place and releases it at the last; keys are held down meanwhile.
  async drag({page, places, keys}) {
    for (const key of keys) await page.keyboard.down(key);
    await page.mouse.move(...places[0]);
    await page.mouse.down();
    for (const place of places.slice(1)) await page.mouse.move(...place, {steps: 4});
    await page.mouse.up();
    for (const key of keys) await page.keyboard.up(key);
  },
  // The same with fingers, as a touch screen tells of them: each goes along a list of places.
  async fingers({page, paths}) {
    const screen = await page.context().newCDPSession(page);
    const send = (type, step) => screen.send('Input.dispatchTouchEvent',
      {type, touchPoints: step === null ? [] : paths.map((path, id) => ({x: path[step][0], y: path[step][1], id}))});
    await send('touchStart', 0);
    for (let step = 1; step < paths[0].length; step++) await send('touchMove', step);
    await send('touchEnd', null);
    await screen.detach();
  },
  // The largest canvas: [x, y, width, height].
  canvas: ({page}) => page.evaluate(() => {
    const boxes = Array.from(document.querySelectorAll('canvas'), (one) => one.getBoundingClientRect());
    const {x, y, width, height} = boxes.sort((a, b) => b.width * b.height - a.width * a.height)[0];
    return [x, y, width, height];
  }),
  async close({watched}) { await watched.end(); },
};

for await (const line of createInterface({input: process.stdin})) {
  const {do: name, page: number, ...rest} = JSON.parse(line);
  let answer;
  try {
    const watched = pages.get(number);
    answer = {value: await commands[name]({...rest, watched, page: watched && watched.page}) ?? null};
  } catch (problem) {
    answer = {problem: problem.message};
  }
  process.stdout.write(JSON.stringify(answer) + '\n');
}
await browser.close();
