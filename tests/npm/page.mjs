// The classic script and the page of examples in Chromium or Firefox, from file://: called with NODE-FOLDER BROWSER FOLDER, where FOLDER holds the
// package, and spot.obj with spot-out.obj, which the native program has made of it by lattice.json.
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {folder, launch, runAll, watch} from '../view/browser.mjs';

const browser = await launch(['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--webgl-antialiasing-mode=none']);
const url = (name) => String(pathToFileURL(join(folder, name)));
const isFile = (address) => /^(file|blob|data|about):/.test(address);
const read = (name) => readFileSync(join(folder, name), 'utf8');

writeFileSync(join(folder, 'plain.html'), '<!doctype html><link rel="icon" href="data:,"><script src="package/dist/ffd-mesh.js"></script>');

async function classicScript() {
  const {page, end} = await watch(browser, url('plain.html'), isFile, {name: 'npm-plain'});
  const [bytes, moved, verdict, code] = await page.evaluate(async ([obj, lattice]) => {
    const ffd = await globalThis.ffdMesh.init();
    const points = Float32Array.from({length: 3000}, (_, i) => Math.sin(i)), own = ffd.Lattice.around(points), e = own.embed(points);
    own.setOffsets([21], [0.2, 0, 0]);
    const count = own.deform(e, points).reduce((sum, x, i) => sum + (x !== points[i]), 0);
    const done = await ffd.deform({name: 'spot.obj', bytes: obj}, lattice);
    const problem = await ffd.check({name: 'spot.obj', bytes: 'v 1'}, lattice).catch((thrown) => thrown);
    return [new TextDecoder().decode(done.bytes), count, own.folds().verdict, problem instanceof globalThis.ffdMesh.FfdError && problem.code];
  }, [read('spot.obj'), read('lattice.json')]);
  assert.equal(bytes, read('spot-out.obj'));
  assert.ok(moved > 100);
  assert.deepEqual([verdict, code], ['none', 4]);
  await end();
}

async function examplePage() {
  const {page, end} = await watch(browser, url('package/examples/index.html'), isFile, {name: 'npm-example', reducedMotion: 'reduce'});
  await page.setInputFiles('#file', join(folder, 'lattice.json'));
  await page.setInputFiles('#model', join(folder, 'spot.obj'));
  await page.waitForFunction(() => /vertices moved/.test(document.getElementById('said').textContent));
  const result = () => page.evaluate(async () => (await fetch(document.getElementById('result').href)).text());
  assert.equal(await result(), read('spot-out.obj'));
  await page.frameLocator('#view').locator('html[data-ready]').waitFor();
  await page.fill('#twist', '90');
  await page.locator('#twist').blur();
  await page.waitForFunction((before) => document.getElementById('lattice').href && document.getElementById('said').textContent !== 'Working ..' &&
    fetch(document.getElementById('result').href).then((answer) => answer.text()).then((text) => text !== before), read('spot-out.obj'));
  await page.click('#edit');
  await page.waitForFunction(() => /Drag the control points/.test(document.getElementById('said').textContent));
  const tools = page.frameLocator('#view');
  // Firefox draws nothing without a screen, and a page without a picture has no tools.
  if (await tools.locator('html[data-ready]').getAttribute('data-ready') === 'picture') {
    const saved = page.waitForEvent('download');
    await tools.getByRole('button', {name: 'Save', exact: true}).click();
    await saved;
  }
  // A drop of what is no model.
  await page.evaluate(() => {
    const data = new DataTransfer();
    data.items.add(new File(['v 1'], 'a.obj'));
    dispatchEvent(new DragEvent('drop', {dataTransfer: data}));
  });
  await page.waitForFunction(() => /a\.obj:1:/.test(document.querySelector('output.wrong')?.textContent));
  await end();
}

await runAll(browser, [classicScript, examplePage]);
