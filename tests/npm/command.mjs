// npx ffd-mesh on real files, beside the native program: the same exit codes, bytes of standard output and error, and files. Jobs are
// vectors of arguments, for a folder in which the files of `prepare` lie; FFD_JOBS names a JSON file of further vectors.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {cpSync, lstatSync, mkdirSync, readdirSync, readFileSync, readlinkSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {native, packageFolder, root, runAll, test} from './tools.mjs';

const program = [join(packageFolder, 'bin', 'ffd-mesh.mjs')];

// {words, input: a file for standard input, folder: where it begins}
const JOBS = [
  ['--version'], [], ['help'], ['deform', '--help'], ['lattice', '--help'], ['defrom'], ['deform', '--lattise'], ['-x'],
  ['info', 'spot.obj'], ['info', 'knight.glb', '--json'], ['info', 'twist.json'], ['info', 'keg_decorated.obj', '--parts'],
  ['info', 'none.obj'], ['info', 'broken.json'], ['info', 'cut.glb'], ['info', 'a.xyz'], ['info', '.'], ['info', 'knight.glb/a.obj'],
  ['deform', 'spot.obj', 'out.obj', '-l', 'twist.json'], ['deform', 'knight.glb', 'out.glb', '-l', 'big-head.json', '--rig', 'follow'],
  ['deform', 'keg_decorated.obj', 'out/keg.obj', '-l', 'taper.json', '--report', 'report.json', '--report-stable'],
  ['deform', 'spot.obj', 'out.gltf', '-l', 'twist.json', '--normals', 'recompute'], ['deform', 'out.gltf', 'out/again.gltf', '-l', 'bend.json'],
  ['deform', 'out.gltf', 'out/packed.glb', '-l', 'bend.json', '--as-morph', 'bent'], ['deform', 'out/again.gltf', 'out/packed.vrm', '-l', 'twist.json'],
  ['deform', 'spot.obj', 'out.ply', '-l', 'wave.json'], ['deform', 'out.ply', 'out.off', '-l', 'bulge.json'], ['deform', 'out.off', 'out.stl', '-l', 'lean.json'],
  ['deform', 'out.stl', 'out/flat.stl', '-l', 'bend-cylinder.json', '--outside', 'extend'],
  ['deform', 'spot.obj', 'out.obj', '-l', 'twist.json'], ['deform', 'out.obj', '--in-place', '-l', 'twist.json'],
  ['deform', 'spot.obj', 'knight.glb', 'keg_decorated.obj', '--out-dir', 'many', '-l', 'taper.json'], ['deform', 'none.obj', 'out.obj', '-l', 'twist.json'],
  ['deform', 'spot.obj', 'none/out.obj', '-l', 'twist.json'], ['deform', 'spot.obj', 'fail.obj', '-l', 'fold.json', '--fail-on', 'folds'],
  ['deform', 'spot.obj', 'fail.obj', '-l', 'corner.json', '--outside', 'error'], ['deform', 'link.obj', 'linked.obj', '-l', 'twist.json'],
  ['deform', 'spot.obj', 'out.obj', '-l', 'twist.json', '--depfile', 'out.d', '--force'], ['deform', 'spot.obj', 'out.obj', '-l', 'twist.json', '--memory', '1M'],
  ['deform', 'spot.obj', 'smile.glb', '--morph', 'a=twist.json', '--morph', 'b=bend.json', '--clip', 'nod: 0 a=0, 1 a=1'],
  {words: ['deform', '-', '-', '--input-format', 'obj', '--output-format', 'glb', '-l', 'twist.json'], input: 'spot.obj'},
  {words: ['deform', '-', 'piped.glb', '--input-format', 'glb', '-l', 'taper.json', '--only', 'node:none'], input: 'knight.glb'},
  {words: ['deform', 'spot.obj', '-', '--output-format', 'obj', '-l', '-'], input: 'twist.json'},
  {words: ['deform', '../spot.obj', '../beside.obj', '-l', '../twist.json'], folder: 'out'},
  {words: ['deform', 'FOLDER/spot.obj', 'FOLDER/absolute.obj', '-l', 'FOLDER/twist.json'], folder: '/'},
  ['check', 'spot.obj', '-l', 'twist.json'], ['check', 'spot.obj', '-l', 'fold.json', '--report', '-', '--report-stable'],
  ['check', 'knight.glb', '-l', 'corner.json', '--picture', 'check.png'],
  ['embed', 'spot.obj', '-l', 'twist.json', '-o', 'uvw.npy', '--status', 'status.npy'], ['deform', 'spot.obj', 'embedded.obj', '-l', 'twist.json', '--embedding', 'uvw.npy'],
  ['deform', 'knight.glb', 'no.glb', '-l', 'twist.json', '--embedding', 'uvw.npy'], ['embed', 'spot.obj', '-l', 'bend.json', '-o', '-'],
  ['compare', 'spot.obj', 'out.obj'], ['compare', 'spot.obj', 'spot.obj'], ['compare', 'spot.obj', 'beside.obj', '--json'],
  ['lattice', 'new', 'spot.obj', 'knight.glb', '-o', 'new.json', '--size', '5,4,3', '--shape', 'cylinder'], ['lattice', 'new', 'spot.obj', '-o', '-', '--axes', 'principal'],
  ['jacobian', 'spot.obj', '-l', 'twist.json', '-o', 'j.npz'], ['jacobian', 'spot.obj', '-l', 'bend.json', '-o', 'j.mtx', '--check'],
  ['view', 'knight.glb', '-l', 'twist.json', '-o', 'page.html'], ['view', 'spot.obj', 'out.obj', '-o', 'two.png', '--size', '160x120'],
  ['view', 'keg_decorated.obj', '-l', 'taper.json', '-o', 'keg.png', '--color', 'plain', '--frames', '3', '--size', '100x80'],
  ['report', 'merge', 'report.json', 'report.json', '-o', 'merged.json'], ['view', 'spot.obj', '-o', 'page.html'],
  ['deform', '/dev/null', 'null.obj', '-l', 'twist.json'], ['deform', 'spot.obj', '/dev/null', '-l', 'twist.json', '--output-format', 'obj'],
];

const FOLD = {format: 'ffd-lattice', version: 1, size: [4, 4, 4], rest: {box: 'mesh'}, moves: [{at: [1, 1, 1], by: [5, 0, 0]}]};

function prepare(folder) {
  mkdirSync(join(folder, 'out'), {recursive: true});
  mkdirSync(join(folder, 'many'));
  cpSync(join(root, 'data/models'), folder, {recursive: true});
  cpSync(join(root, 'data/lattices'), folder, {recursive: true});
  writeFileSync(join(folder, 'fold.json'), JSON.stringify(FOLD));
  writeFileSync(join(folder, 'broken.json'), '{"format": "ffd-lattice",\n "version": 1, "size": [4, 4, "4"]}');
  writeFileSync(join(folder, 'cut.glb'), readFileSync(join(folder, 'knight.glb')).subarray(0, 5000));
  symlinkSync('out/../spot.obj', join(folder, 'link.obj'));
}

// All that is in a folder.
function content(folder) {
  const names = readdirSync(folder, {recursive: true}).sort();
  return new Map(names.map((name) => {
    const path = join(folder, name), info = lstatSync(path);
    return [name, info.isDirectory() ? 'folder' : info.isSymbolicLink() ? readlinkSync(path) : readFileSync(path).toString('latin1')];
  }));
}

// Runs a job in a folder. Returns its code and streams, with a word in place of the folder's name.
function run(command, job, folder) {
  const {words, input, folder: start = ''} = Array.isArray(job) ? {words: job} : job;
  const done = spawnSync(command[0], [...command.slice(1), ...words.map((word) => word.replace('FOLDER', folder))],
    {cwd: start === '/' ? '/' : join(folder, start), input: input ? readFileSync(join(folder, input)) : '', maxBuffer: 1 << 30});
  const text = (bytes) => bytes.toString('latin1').replaceAll(folder, 'FOLDER');
  return {code: done.status, out: text(done.stdout), said: text(done.stderr)};
}

test('every job gives what the native program gives', (folder) => {
  const jobs = [...JOBS, ...(process.env.FFD_JOBS ? JSON.parse(readFileSync(process.env.FFD_JOBS)) : [])];
  const [ours, theirs] = ['a', 'b'].map((name) => join(folder, name));
  [ours, theirs].forEach(prepare);
  const wrong = [];
  for (const job of jobs) {
    const [got, wanted] = [run([process.execPath, ...program], job, ours), run([native], job, theirs)];
    const [have, want] = [content(ours), content(theirs)];
    const files = [...new Set([...have.keys(), ...want.keys()])].filter((name) => have.get(name) !== want.get(name));
    if (files.length > 0 || got.code !== wanted.code || got.out !== wanted.out || got.said !== wanted.said) {
      wrong.push(`${JSON.stringify(job)}: code ${got.code} (${wanted.code}), ${got.out === wanted.out ? 'same' : 'other'} output, ` +
        `files: ${files.join(' ')}\n  ${got.said}  (native) ${wanted.said}`);
      // The next jobs begin with the same files again.
      rmSync(ours, {recursive: true});
      cpSync(theirs, ours, {recursive: true, verbatimSymlinks: true});
    }
  }
  assert.equal(wrong.length, 0, '\n' + wrong.join('\n'));
});

test('batch is an exit 6 with one line', (folder) => {
  writeFileSync(join(folder, 'jobs.jsonl'), '{"in": "a.obj", "lattice": "a.json", "out": "b.obj"}\n');
  const {code, out, said} = run([process.execPath, ...program], ['batch', 'jobs.jsonl'], folder);
  assert.deepEqual([code, out], [6, '']);
  assert.match(said, /^ffd: batch: .*\n$/);
});

test('the version takes at most four times the start of node', () => {
  const seconds = (words) => {
    const times = Array.from({length: 7}, () => {
      const began = performance.now();
      assert.equal(spawnSync(process.execPath, words).status, 0);
      return performance.now() - began;
    });
    return Math.min(...times);
  };
  const [own, plain] = [seconds([...program, '--version']), seconds(['-e', '0'])];
  console.log(`start: ${own.toFixed(0)} ms, node ${plain.toFixed(0)} ms`);
  assert.ok(own <= 4 * plain, `${own} ms, node ${plain} ms`);
});

await runAll();
