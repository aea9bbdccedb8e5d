// Opens pages of ffd view in a browser and uses them as people do: page.mjs NODE-FOLDER BROWSER PAGES made|real|firefox
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {folder, launch, runAll, watch} from './browser.mjs';

const WIDE = {width: 860, height: 480}, PHONE = {width: 390, height: 844};

const browser = await launch(['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--webgl-antialiasing-mode=none']);

async function open(kind, options = {}) {
  const url = 'file://' + join(folder, kind + '.html');
  const watched = await watch(browser, url, (asked) => asked === url, {viewport: WIDE, reducedMotion: 'reduce', name: kind, ...options});
  await watched.page.waitForSelector('html[data-ready]');
  return watched;
}

// The canvas's pixels. They are there only in the frame in which they are drawn: a wheel that does not turn asks for it.
function pixels(page) {
  return page.evaluateHandle(() => new Promise((done) => {
    const canvas = document.getElementById('view');
    canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: 0, cancelable: true}));
    requestAnimationFrame(() => {
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext('2d', {willReadFrequently: true});
      context.drawImage(canvas, 0, 0);
      done(new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer));
    });
  }));
}

// A hash of them.
async function picture(page) {
  return (await pixels(page)).evaluate((all) => all.reduce((hash, pixel) => Math.imul(hash ^ pixel, 16777619), 2166136261));
}

// The picture once the page has its place: under load it may be laid out, and drawn, once more.
async function settled(page) {
  for (let last = await picture(page), again; ; last = again) {
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    again = await picture(page);
    if (again === last) return again;
  }
}

// Does one thing after the other, [WHAT, ACTION, CHECK], and expects the canvas to look different after each. Only what
// changes no picture may be in a check.
async function eachChanges(page, steps) {
  let before = await picture(page);
  for (const [what, action, check] of steps) {
    await action();
    const after = await picture(page);
    assert.notEqual(after, before, `${what} changes the picture`);
    if (check) await check();
    before = after;
  }
}

const changes = (page, what, action) => eachChanges(page, [[what, action]]);

const text = (page, selector) => page.locator(selector).innerText();

async function sliderGoesFromBeforeToAfter() {
  const {page, end} = await open('torn');
  assert.equal(await page.getAttribute('html', 'data-ready'), 'picture');
  const after = await picture(page);
  const slider = page.locator('#blend');
  await slider.focus();
  await changes(page, 'Home on the slider', () => page.keyboard.press('Home'));
  assert.equal(await slider.getAttribute('aria-valuetext'), 'before');
  assert.equal((await text(page, '#percent')).trim(), '0\u00a0%');
  await eachChanges(page, [['an arrow on the slider', () => page.keyboard.press('ArrowRight')],
    ['a place of the slider', () => slider.fill('60')]]);
  await page.click('#play');
  assert.equal(await slider.inputValue(), '0');
  await page.click('#play');
  assert.equal(await slider.inputValue(), '100');
  assert.equal(await picture(page), after, 'the way back ends where it began');
  await end();
}

async function coloursAndMarksAreChosen() {
  const {page, end} = await open('fold');
  const colours = [['status', /inside\s+11.533/], ['det', /relative to before[^]*at most 0: folded/], ['plain', /colours of the materials/],
    ['displacement', /units of the file[^]*0\.89/]].map(([key, words]) => [key,
    () => page.locator('#color-' + key).check({force: true}), async () => assert.match(await text(page, '#legend'), words)]);
  const marks = ['showCage', 'showRest', 'showFlipped', 'showEdges', 'isSmooth'].map((key) => [key,
    () => page.locator('#show-' + key).click()]);
  await eachChanges(page, [...colours, ...marks]);
  await end();
}

async function aWitnessIsPicked() {
  const {page, end} = await open('fold');
  const pin = await page.locator('#witness').boundingBox();
  await changes(page, 'the witness', () => page.mouse.click(pin.x + pin.width / 2, pin.y + pin.height / 2));
  assert.match(await text(page, '#said'), /folds here[^]*u, v, w\s+0\.5, 0\.5, 0\.5[^]*x, y, z[^]*det J\s+\u22122\.126/);
  assert.equal(await page.getAttribute('#said', 'aria-live'), 'polite');
  const near = await page.locator('#witness').boundingBox(), canvas = await page.locator('#view').boundingBox();
  assert.ok(Math.abs(near.x + 16 - canvas.x - canvas.width / 2) < 2, 'the camera looks at it');
  await page.click('#said .close');
  assert.equal(await text(page, '#said'), '');
  await page.click('#go-witness');
  assert.match(await text(page, '#said'), /folds here/);
  assert.match(await text(page, '#findings'), /Flipped\s+9.000\striangles/);
  await end();
}

async function tornEdgesAreListed() {
  const {page, end} = await open('torn');
  await changes(page, 'hiding torn edges', () => page.locator('#show-showTears').uncheck());
  await page.locator('#show-showTears').check();
  await page.click('#findings summary');
  assert.equal(await page.locator('#findings .row').count(), 60);
  assert.match(await text(page, '#findings'), /100\u00a0edges, step to 0\.109[^]*and 40 more[^]*160\u00a0torn edges with smaller steps not listed/);
  await changes(page, 'a torn edge', () => page.locator('#findings .row').first().click());
  assert.match(await text(page, '#said'), /Torn edge[^]*Step\s+0\.109[^]*Vertices\s+\d+ and \d+/);
  assert.match(await text(page, '#verdicts'), /260\u00a0torn edges/);
  assert.match(await text(page, '#figures'), /Torn edges\s+260\s+largest step\s+0\.109\d*\s+of\s+material:skin/);
  await end();
}

async function mouseAndKeysMoveTheCamera() {
  const {page, end} = await open('torn');
  const box = await page.locator('#view').boundingBox();
  const x = box.x + box.width / 2, y = box.y + box.height / 2;
  const drag = async () => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 80, y + 20, {steps: 3});
    await page.mouse.up();
  };
  await eachChanges(page, [['dragging', drag], ['the wheel', () => page.mouse.wheel(0, -240)]]);
  await page.locator('#view').focus();
  const keys = ['f', 'b', 'l', 'r', 't', 'i', 'ArrowLeft', 'ArrowUp', '+', 'Home', 'c', 'w'];
  await eachChanges(page, [...keys.map((key) => ['key ' + key, () => page.keyboard.press(key)]),
    ['the button Top', () => page.click('[data-view=top]')]]);
  await page.locator('#show-showCage').uncheck();
  await page.click('[data-view=front]');
  await page.mouse.click(x, y);
  assert.match(await text(page, '#said'), /^Vertex [\d\u202f]+[^]*Before[^]*After[^]*Displacement[^]*Status\s+(in|out)side[^]*det F/);
  await end();
}

async function hostileNamesAreText() {
  const {page, end} = await open('hostile');
  assert.equal(await page.title(), "</title><script>document.title='taken'</script>&amp; \\u{202e}gpj.exe");
  assert.equal(await text(page, '#name'), "</title><script>document.title='taken'</script>&amp; \\u{202e}gpj.exe \u2192 <!--<script>");
  const names = await page.locator('.parts .name').allInnerTexts();
  assert.deepEqual(names, ['</script><img src=x onerror=alert(1)>\\n<b>bold</b>', 'x'.repeat(200) + '\u2026',
    '"\'><script>alert(3)</script>', '\\u{1}\\u{7f}\ufffd\ufffd broken \ufffd\ufffd']);
  assert.equal(await page.locator('img, iframe, object, link').count(), 0);
  assert.equal(await page.locator('body script:not([type])').count(), 1);
  const report = await page.evaluate(() => JSON.parse(document.getElementById('report').textContent));
  assert.equal(report.jobs[0].input, 'a </script><b>');
  assert.match(await text(page, '#figures'), /\\u\{202e\}cage\\u\{2028\}&lt;/);
  await eachChanges(page, [['hiding a part', () => page.locator('[data-part="0"]').uncheck()],
    ['hiding all', () => page.getByRole('button', {name: 'Hide all'}).click()],
    ['showing all', () => page.getByRole('button', {name: 'Show all'}).click()]]);
  await end();
}

// What the program found in a mesh is what its page says and goes to.
async function aRealFoldIsPicked() {
  const {page, end} = await open('real_fold');
  const job = await page.evaluate(() => JSON.parse(document.getElementById('report').textContent).jobs[0]);
  assert.ok(job.folds.verdict === 'some' && job.flipped_faces > 1000, 'the report');
  assert.match(await text(page, '#verdicts'), /The volume folds[^]*faces\s+turned over/);
  const pin = await page.locator('#witness').boundingBox();
  await changes(page, 'the witness', () => page.mouse.click(pin.x + pin.width / 2, pin.y + pin.height / 2));
  const said = await text(page, '#said');
  assert.ok(said.includes('fold.json'), said);
  const shown = Number(/det J\s+\u2212([\d.]+)/.exec(said)[1]);
  assert.ok(Math.abs(shown + job.folds.witness.det) < 1e-3 * shown, `det J ${shown} of ${job.folds.witness.det}`);
  assert.match(await text(page, '#notice'), /1 vertex is not finite, and 1 triangle there is not drawn\./);
  const digits = (words) => words.replace(/\D/g, '');
  assert.equal(digits(await page.locator('#findings .more', {hasText: 'flipped in all'}).innerText()), String(job.flipped_faces));
  await page.locator('#findings summary').click();
  await changes(page, 'a flipped face', () => page.locator('#findings .row:not(#go-witness)').first().click());
  assert.match(await text(page, '#said'), /Flipped triangle\s/);
  await eachChanges(page, ['status', 'det', 'plain', 'displacement'].map((key) => [key,
    () => page.locator('#color-' + key).check({force: true})]));
  await page.locator('#blend').focus();
  await changes(page, 'the slider', () => page.keyboard.press('Home'));
  await end();
}

async function realTearsAreListed() {
  const {page, end} = await open('real_tear');
  const job = await page.evaluate(() => JSON.parse(document.getElementById('report').textContent).jobs[0]);
  assert.ok(job.tear.edges > 100 && job.outside > 1000, 'the report');
  const digits = (words) => words.replace(/\D/g, '');
  assert.equal(digits(await page.locator('#verdicts .bad', {hasText: 'torn'}).innerText()), String(job.tear.edges));
  assert.equal(digits(await page.locator('#verdicts .warn', {hasText: 'outside'}).innerText()), String(job.outside));
  await page.locator('#findings summary').first().click();
  await changes(page, 'a torn edge', () => page.locator('#findings .row').first().click());
  const step = Number(/Step\s+([\d.]+)/.exec(await text(page, '#said'))[1]);
  assert.ok(Math.abs(step - job.tear.largest) < 1e-3 * step, `a step of ${step}, the largest is ${job.tear.largest}`);
  await end();
}

async function filesAreColouredByDisplacement() {
  const {page, end} = await open('real_pair');
  assert.ok(await page.locator('#color-displacement').isChecked(), 'det F is not known');
  assert.equal(await page.locator('#color-det, #color-status').count(), 0);
  assert.equal(await text(page, '#name'), 'low.obj \u2192 high.obj');
  await changes(page, 'the slider', () => page.locator('#blend').fill('0'));
  await end();
}

// There is no way from before to after to slide along.
async function aMeshAloneHasNoSlider() {
  const {page, end} = await open('real_alone');
  assert.equal(await page.locator('input[type=range]:visible, #play:visible').count(), 0);
  assert.doesNotMatch(await text(page, '#keys'), /Space/);
  assert.doesNotMatch(await text(page, '#figures'), /Displacement/);
  await page.locator('canvas').press(' ');
  await changes(page, 'turning', () => page.locator('canvas').press('ArrowLeft'));
  await end();
}

// A body whose z points upwards looks from each side as the same one whose y does.
async function whatPointsUpwardsStandsUpright() {
  const [upright, turned, lying] = await Promise.all(['real_upright', 'real_turned', 'real_lying'].map((kind) => open(kind)));
  const drawn = async ({page}) => {
    await settled(page);
    return (await pixels(page)).evaluate((all) => Array.from(all));
  };
  const differ = (a, b) => a.filter((pixel, i) => pixel !== b[i]).length / a.length;
  for (const side of [null, 'left', 'top']) {
    for (const {page} of [upright, turned, lying]) {
      if (side) await page.locator(`[data-view=${side}]`).click();
    }
    const all = [await drawn(upright), await drawn(turned), await drawn(lying)];
    assert.ok(differ(all[0], all[1]) < 0.002, `${side}: ${differ(all[0], all[1])} of the pixels differ`);
    assert.ok(differ(all[0], all[2]) > 0.02, `${side}: without --up it lies`);
  }
  for (const {end} of [upright, turned, lying]) await end();
}

async function farControlPointsLeaveTheMeshItsSize() {
  const {page, end} = await open('real_far');
  await page.locator('[data-view=front]').click();
  await page.locator('#show-showCage').uncheck();
  const seen = await (await pixels(page)).evaluate((all) => all.filter((pixel) => pixel >>> 24).length);
  assert.ok(seen > 500, `${seen} pixels of the mesh`);
  await end();
}

// Colours at places of the picture, shares of the box of all that is drawn, in its order from the left and from the top.
async function coloursAt(page, places) {
  const width = await page.evaluate(() => document.getElementById('view').width);
  return (await pixels(page)).evaluate((all, {places, width}) => {
    let [left, top, right, bottom] = [Infinity, Infinity, -1, -1];
    all.forEach((pixel, i) => {
      if (pixel >>> 24 < 128) return;
      const x = i % width, y = Math.floor(i / width);
      [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x), Math.max(bottom, y)];
    });
    return places.map(([across, down]) => {
      const pixel = all[width * Math.round(top + down * (bottom - top)) + Math.round(left + across * (right - left))];
      return [pixel & 255, pixel >>> 8 & 255, pixel >>> 16 & 255];
    });
  }, {places, width});
}

async function materialsLookAsTheyAre() {
  const {page, end} = await open('real_looks');
  assert.ok(await page.locator('#color-plain').isChecked(), 'a page opens in the colours of the model');
  assert.match(await text(page, '#legend'), /textures/);
  await page.locator('#show-showCage').uncheck();
  // Once the textures are decoded, nothing changes any more.
  await page.waitForFunction(() => document.querySelectorAll('[id^=data-image]').length === 0);
  let seen;
  const square = (i, x, y) => [(1.2 * i + x) / 5.8, y];
  const isLike = ([r, g, b], [high, low]) => high.every((c) => [r, g, b][c] > 120) && low.every((c) => [r, g, b][c] < 110);
  const wanted = [['red', square(0, 0.25, 0.25), [[0], [1, 2]]], ['green', square(0, 0.75, 0.25), [[1], [0, 2]]],
    ['blue', square(0, 0.25, 0.75), [[2], [0, 1]]], ['yellow', square(0, 0.75, 0.75), [[0, 1], [2]]],
    ['the right half alone', square(1, 0.2, 0.5), [[1], [0, 2]]], ['the right half at its end', square(1, 0.8, 0.5), [[1], [0, 2]]],
    ['light of a texture', square(2, 0.2, 0.5), [[1], [0, 2]]], ['red behind the glass', square(4, 0.5, 0.5), [[0], [1]]]];
  for (let tries = 0; tries < 40; tries++) {
    seen = await coloursAt(page, [...wanted.map(([, place]) => place), square(3, 0.5, 0.5)]);
    if (wanted.every(([, , like], i) => isLike(seen[i], like))) break;
    await new Promise((done) => setTimeout(done, 50));
  }
  wanted.forEach(([what, , like], i) => assert.ok(isLike(seen[i], like), `${what}: ${seen[i]}`));
  assert.ok(seen[7][2] > 40, `the glass has a colour: ${seen[7]}`);
  // sRGB of 0, 0.2, 0.9: exactly, as no light falls on it.
  [0, 124, 243].forEach((c, a) => assert.ok(Math.abs(seen[8][a] - c) <= 2, `no light: ${seen[8]}`));
  await page.locator('#view').focus();
  await changes(page, 'key d', () => page.keyboard.press('d'));
  assert.ok(await page.locator('#color-displacement').isChecked());
  await changes(page, 'key d again', () => page.keyboard.press('d'));
  await end();
}

async function realHostileNamesAreText() {
  const {page, end} = await open('real_hostile', {viewport: PHONE, name: 'real_hostile'});
  const title = '<img src=x onerror=alert(2)>\\n\\u{202e}&amp;.gltf';
  assert.equal(await page.title(), title);
  assert.equal(await text(page, '#name'), title);
  assert.deepEqual(await page.locator('.parts .name').allInnerTexts(), ["</script><script>document.title='taken'</script>",
    '<img src=x onerror=alert(1)>', '\\u{202e}gpj.exe\\n"\'&amp;', '__proto__', 'x'.repeat(200) + '\u2026']);
  assert.match(await text(page, '#figures'), /<b>cage\.json/);
  assert.equal(await page.locator('img, iframe, object, link, #panel b').count(), 0);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), 'nothing is beside the screen');
  await changes(page, 'hiding a part', () => page.locator('[data-part="3"]').uncheck());
  await end();
}

async function animationsArePlayed() {
  const {page, end} = await open('real_arm');
  const list = page.locator('#animation'), time = page.locator('#time');
  assert.deepEqual(await list.locator('option').allInnerTexts(),
    ['At rest', 'turn', '</script><img src=x onerror=alert(4)>\\n\\u{202e}']);
  assert.equal(await list.inputValue(), '0', 'the one that was asked for');
  assert.ok(await page.locator('#show-showJoints').isChecked(), 'joints are shown');
  const first = await settled(page);
  await changes(page, 'the time', () => time.fill('100'));
  assert.equal(await text(page, '#clock'), '1.00\u00a0s');
  assert.equal(await time.getAttribute('aria-valuetext'), '1.00 of 2.00 seconds');
  await eachChanges(page, [['before', () => page.locator('#blend').fill('0')],
    ['joints', () => page.locator('#show-showJoints').uncheck()]]);
  await page.locator('#view').focus();
  await eachChanges(page, ['j', '.', ','].map((key) => ['key ' + key, () => page.keyboard.press(key)]));
  await page.click('#run');
  assert.equal(await text(page, '#run'), 'Pause');
  await page.waitForFunction(() => !document.getElementById('clock').textContent.startsWith('1.0'));
  await page.locator('#view').focus();
  await page.keyboard.press('p');
  assert.equal(await text(page, '#run'), 'Animate');
  await page.locator('#blend').fill('100');
  await time.fill('0');
  assert.equal(await settled(page), first, 'the way back ends where it began');
  await eachChanges(page, [['another animation', async () => { await list.selectOption('1'); await time.fill('150'); }],
    ['rest', () => list.selectOption('')]]);
  assert.ok(await page.locator('#run').isDisabled() && await time.isDisabled(), 'nothing to play at rest');
  await page.setViewportSize(PHONE);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), 'nothing is beside the screen');
  await end();
}

async function largeAndEmptyMeshesOpen() {
  const large = await open('large');
  assert.match(await text(large.page, '#notice'), /1\d{5} of 271441 vertices are drawn: the mesh is simplified/);
  await large.end();
  const empty = await open('empty');
  assert.match(await text(empty.page, '#notice'), /The mesh has no vertices/);
  await empty.end();
}

// A copy that was cut says so, in one line.
async function aCutPageSaysSo() {
  const whole = readFileSync(join(folder, 'torn.html'), 'latin1');
  const at = whole.indexOf('id="data-triangle">') + 4000, end = whole.indexOf('</script>', at);
  writeFileSync(join(folder, 'cut.html'), whole.slice(0, at) + whole.slice(end), 'latin1');
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto('file://' + join(folder, 'cut.html'));
  assert.match(await text(page, '#problem'), /^The page is not complete[^\n]*$/);
  await context.close();
}

async function withoutWebGLThereAreFigures() {
  const prepare = () => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind === 'webgl2' ? null : original.call(this, kind, ...rest);
    };
  };
  const {page, end} = await open('torn', {prepare, name: 'figures'});
  assert.equal(await page.getAttribute('html', 'data-ready'), 'figures');
  assert.match(await text(page, '#problem'), /^The picture needs WebGL2[^\n]*$/);
  assert.match(await text(page, '#figures'), /Vertices\s+11.533/);
  assert.ok(!(await page.locator('#stage').isVisible()));
  await end();
}

async function phonesAndDarkAreServed() {
  const {page, end} = await open('fold', {viewport: PHONE, colorScheme: 'dark', deviceScaleFactor: 2, hasTouch: true, name: 'phone'});
  assert.equal(await page.getAttribute('html', 'data-theme'), 'dark');
  const canvas = await page.locator('#view').boundingBox(), panel = await page.locator('#panel').boundingBox();
  assert.ok(panel.y > canvas.y + canvas.height && canvas.width >= 380, 'the panel is below the canvas');
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), 'nothing is beside the screen');
  const dark = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  await page.click('#theme');
  assert.equal(await page.getAttribute('html', 'data-theme'), 'light');
  assert.notEqual(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), dark);
  await page.click('#theme');
  await end();
}

// Ellipses of their colours, the nearest in front from each side, as the deformation stretches them.
async function splatsAreEllipsesInOrder() {
  const {page, end} = await open('real_splats', {viewport: {width: 1300, height: 900}});
  assert.ok(await page.locator('#color-plain').isChecked(), 'a page opens in the colours of the splats');
  const middle = [0.5, 0.5], aside = [0.7, 0.5], below = (height) => [0.5, 0.5 + 0.8 / height];
  const isRed = ([r, , b]) => r > 200 && b < 60, isBlue = ([r, , b]) => b > 200 && r < 60, isEmpty = (color) => color.every((c) => c === 0);
  await page.locator('#blend').fill('0');
  let seen = await coloursAt(page, [middle, aside, below(3), [0, 0]]);
  assert.ok(isRed(seen[0]) && seen[1][0] > 150 && isEmpty(seen[2]), `before: ${seen.join('; ')}`);
  await page.locator('#blend').fill('100');
  seen = await coloursAt(page, [middle, aside, below(9)]);
  assert.ok(isRed(seen[0]) && seen[2][0] > 120, `three times as high after: ${seen.join('; ')}`);
  await page.locator('#view').focus();
  await changes(page, 'key b', () => page.keyboard.press('b'));
  seen = await coloursAt(page, [middle]);
  assert.ok(isBlue(seen[0]), `from the back: ${seen[0]}`);
  await changes(page, 'status', () => page.locator('#color-status').check({force: true}));
  const [status] = await coloursAt(page, [middle]);
  [74, 144, 217].forEach((c, a) => assert.ok(Math.abs(status[a] - c) <= 3, `inside: ${status}`));
  await end();
}

// Sliders at their defaults show what the file does; each changes the picture, also while an animation plays.
async function morphTargetsHaveSliders() {
  const {page, end} = await open('real_face');
  const row = (number) => page.locator('#targets input').nth(number);
  assert.match(await text(page, '#targets'), /Morph targets \(3\)[^]*up[^]*0\.5[^]*<\/script><img src=x onerror=alert\(5\)>\\n\\u\{202e\}[^]*up/);
  assert.deepEqual(await page.locator('#targets input').evaluateAll((all) => all.map((one) => [one.min, one.max, one.value])),
    [['0', '1', '0.5'], ['0', '1', '0'], ['0', '1', '0']]);
  const first = await settled(page);
  await eachChanges(page, [['a slider', () => row(0).fill('1')], ['another', () => row(1).fill('0.8')], ['a third', () => row(2).fill('1')],
    ['the way before', () => page.locator('#blend').fill('0')], ['a slider, before', () => row(1).fill('0.1')]]);
  await page.locator('#blend').fill('100');
  await page.click('#targets button');
  assert.equal(await picture(page), first, 'the weights of the file');
  await page.locator('#animation').selectOption({label: 'turn'});
  await page.locator('#time').fill('150');
  const posed = await picture(page);
  await eachChanges(page, [['a slider, in a pose', () => row(1).fill('1')], ['the time', () => page.locator('#time').fill('60')]]);
  await page.locator('#time').fill('150');
  await page.click('#targets button');
  assert.equal(await picture(page), posed, 'the pose as before');
  await end();
}

async function newTargetsAreInFull() {
  const {page, end} = await open('real_morph');
  assert.match(await text(page, '#targets'), /<img src=x onerror=alert\(6\)>[^]*1$/);
  const row = page.locator('#targets input').last();
  assert.deepEqual(await row.evaluate((one) => [one.min, one.max, one.value]), ['0', '1', '1']);
  await changes(page, 'the new target', () => row.fill('0'));
  const without = await picture(page);
  await page.locator('#blend').fill('0');
  // The cage moves all the same.
  await page.locator('#show-showCage').uncheck();
  const before = await picture(page);
  await page.locator('#blend').fill('100');
  assert.equal(await picture(page), before, 'a target at 0 leaves the mesh as it is');
  assert.notEqual(without, before);
  await end();
}

async function thePolicyForbidsRequests() {
  const {page, said} = await open('empty');
  assert.deepEqual(said, []);
  const refused = await page.evaluate(async () => {
    const seen = [];
    document.addEventListener('securitypolicyviolation', (event) => seen.push(event.effectiveDirective));
    await fetch('http://127.0.0.1:9/').catch(() => {});
    const image = new Image();
    image.src = 'data:image/gif;base64,R0lGODlhAQABAAAAACw=';
    const script = document.createElement('script');
    script.textContent = 'document.title = "taken"';
    document.body.append(script);
    document.body.setAttribute('onclick', 'document.title = "taken"');
    document.body.click();
    await new Promise((done) => setTimeout(done, 50));
    return {seen: [...new Set(seen)].sort(), title: document.title};
  });
  assert.deepEqual(refused, {seen: ['connect-src', 'img-src', 'script-src-attr', 'script-src-elem'], title: 'by hand'});
  await page.context().close();
}

const tests = {
  made: [sliderGoesFromBeforeToAfter, coloursAndMarksAreChosen, aWitnessIsPicked, tornEdgesAreListed, mouseAndKeysMoveTheCamera,
    hostileNamesAreText, largeAndEmptyMeshesOpen, aCutPageSaysSo, withoutWebGLThereAreFigures, phonesAndDarkAreServed,
    thePolicyForbidsRequests],
  real: [aRealFoldIsPicked, realTearsAreListed, filesAreColouredByDisplacement, aMeshAloneHasNoSlider,
    farControlPointsLeaveTheMeshItsSize, materialsLookAsTheyAre, whatPointsUpwardsStandsUpright, realHostileNamesAreText, animationsArePlayed, splatsAreEllipsesInOrder, morphTargetsHaveSliders, newTargetsAreInFull],
  // In Firefox: one page of each kind of content.
  firefox: [materialsLookAsTheyAre, realHostileNamesAreText, animationsArePlayed, splatsAreEllipsesInOrder, morphTargetsHaveSliders],
};
await runAll(browser, tests[process.argv[5]]);
