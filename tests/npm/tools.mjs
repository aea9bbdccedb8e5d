// What the tests of the package for npm share, which are called with PACKAGE FFD ROOT [WORD]: the package's folder, the native
// program, the folder of the sources; only tests whose names hold WORD.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

export const [packageFolder, native, root, wanted = ''] = process.argv.slice(2);

const tests = [];
export const test = (name, act) => name.includes(wanted) && tests.push({name, act});

// Runs all tests, each in a folder of its own, and ends the process.
export async function runAll() {
  let failed = 0;
  for (const {name, act} of tests) {
    const began = Date.now(), folder = mkdtempSync(join(tmpdir(), 'ffd-npm-'));
    try {
      await act(folder);
      console.log(`passed  ${name} (${Date.now() - began} ms)`);
    } catch (problem) {
      failed++;
      console.log(`FAILED  ${name}: ${problem.stack}`);
    }
    rmSync(folder, {recursive: true, force: true});
  }
  process.exit(failed || tests.length === 0 ? 1 : 0);
}

// The native program. Returns its end; fails where it fails without leave.
export function ffd(folder, words, {code = 0, input} = {}) {
  const done = spawnSync(native, words, {cwd: folder, input, maxBuffer: 1 << 30});
  assert.equal(done.status, code, `${words.join(' ')}: ${done.stderr}`);
  return done;
}

export const source = (name) => readFileSync(join(root, name));

// Numbers without a pattern, always the same (Park and Miller 1988).
export function randoms(count, seed = 1) {
  return Float64Array.from({length: count}, () => (seed = seed * 48271 % 2147483647) / 2147483647);
}

export function sameBytes(a, b, what) {
  const bytes = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);
  assert.ok(bytes(a).equals(bytes(b)), `${what}: other bytes`);
}
