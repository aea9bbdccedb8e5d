// Opens the page of a batch in a browser and uses it as people do: index.mjs NODE-FOLDER BROWSER FOLDER
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {folder, launch, runAll, watch} from './browser.mjs';

const browser = await launch();

// Beside the page its own pictures are asked for.
function open({url = 'file://' + join(folder, 'index.html'), ...options} = {}) {
  return watch(browser, url, (asked) => asked === url || asked.startsWith('file://' + folder + '/o/'),
    {viewport: {width: 1300, height: 900}, name: 'index', ...options});
}

const lines = (page) => page.locator('tbody td[data-label=Line]').allInnerTexts().then((all) => all.map((text) => text.replace(/\D/g, '')).join(''));
const button = (page, name) => page.getByRole('button', {name});
const sorted = (page) => page.evaluate(() => [...document.querySelectorAll('[aria-sort]')].map((th) => [th.innerText.trim(), th.getAttribute('aria-sort')]));

async function picturesLoad() {
  const {page, end} = await open();
  assert.equal(await page.title(), 'm.jsonl');
  assert.equal(await page.locator('h1').innerText(), 'm.jsonl');
  assert.equal(await page.locator('header #counts').innerText(), '6 jobs: 5 done, 0 up to date, 1 failed');
  const pictures = page.locator('tbody img');
  assert.equal(await pictures.count(), 5);
  for (let i = 0; i < 5; i++) {
    await pictures.nth(i).scrollIntoViewIfNeeded();
    await page.waitForFunction((n) => document.querySelectorAll('tbody img')[n].naturalWidth === 1600, i);
  }
  const [name] = await page.locator('tbody .name').filter({hasText: 'onerror'}).allInnerTexts();
  assert.equal(name, 'o/<img src=x onerror=alert(1)>"\'&#?%41 \u00fc\\u{202e}.obj');
  assert.equal(await page.locator('img[src=x], img[onerror]').count(), 0);
  assert.match(await page.locator('tbody tr').nth(4).innerText(), /no picture[^]*not known[^]*failed: gone\.json/);
  await end();
}

async function columnsSortByMouseAndKeyboard() {
  const {page, end} = await open();
  assert.deepEqual(await sorted(page), []);
  // What is not known comes last in both directions.
  for (const [name, first, second] of [['Largest displacement', /^426135/, /5$/], ['Torn edges', /^3/, /35$/], ['Folds', /^4/, /45$/],
    ['Flipped faces', /^1234/, /^1234/]]) {
    await button(page, name).click();
    assert.deepEqual(await sorted(page), [[name, 'descending']]);
    assert.match(await lines(page), first, name);
    assert.match(await lines(page), /5$/, name);
    await button(page, name).click();
    assert.deepEqual(await sorted(page), [[name, 'ascending']]);
    assert.match(await lines(page), second, name);
  }
  await button(page, 'State').focus();
  await page.keyboard.press('Enter');
  assert.match(await lines(page), /^5/);
  assert.equal(await page.locator('#said').innerText(), 'Sorted by state, descending');
  assert.equal(await page.locator('#said').getAttribute('role'), 'status');
  await page.keyboard.press('Shift+Tab');
  await page.keyboard.press('Shift+Tab');
  await page.keyboard.press('Space');
  assert.deepEqual(await sorted(page), [['Folds', 'descending']]);
  // Names by their numbers; parameters likewise; those without one last.
  await button(page, 'Output').click();
  const names = await page.locator('tbody .name').allInnerTexts();
  assert.ok(names.indexOf('o/x9.obj') < names.indexOf('o/x10.obj'), names);
  await button(page, 'Parameters').click();
  assert.equal(await lines(page), '316245');
  await button(page, 'Line').click();
  assert.equal(await lines(page), '123456');
  await end();
}

async function aPhoneShowsCards() {
  for (const colorScheme of ['light', 'dark']) {
    const {page, end} = await open({viewport: {width: 390, height: 844}, colorScheme, name: 'index-' + colorScheme});
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
    await button(page, 'Largest displacement').click();
    assert.match(await lines(page), /^4/);
    const back = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.equal(back, colorScheme === 'dark' ? 'rgb(18, 21, 27)' : 'rgb(238, 240, 244)');
    await end();
  }
}

async function itReadsWithoutScripts() {
  const {page, end} = await open({javaScriptEnabled: false});
  assert.equal(await page.locator('tbody tr').count(), 6);
  assert.match(await page.locator('#counts').innerText(), /^6 jobs/);
  await end();
}

// What others write into the page later is not run, and pictures of others are not loaded.
async function thePolicyHolds() {
  const text = readFileSync(join(folder, 'index.html'), 'utf8');
  writeFileSync(join(folder, 'changed.html'), text.replace('</main>',
    '<img src="http://127.0.0.1:9/x.png"><img src="data:image/gif;base64,R0lGODlhAQABAAAAACw="><script>document.title = "run";</script></main>'));
  const {page, said} = await open({url: 'file://' + join(folder, 'changed.html')});
  assert.equal(await page.title(), 'm.jsonl');
  assert.equal(said.filter((line) => /Content Security Policy/.test(line)).length, 3, said.join('\n'));
  await page.context().close();
}

await runAll(browser, [picturesLoad, columnsSortByMouseAndKeyboard, aPhoneShowsCards, itReadsWithoutScripts, thePolicyHolds]);
