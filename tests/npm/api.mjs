// The package's functions in node: the bytes, figures and errors of the native program.
import assert from 'node:assert/strict';
import {readdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {ffd as run, native, packageFolder, randoms, root, runAll, sameBytes, source, test} from './tools.mjs';

const {init, FfdError} = await import(pathToFileURL(join(packageFolder, 'dist', 'ffd-mesh.mjs')));
const ffd = await init();

const CURVED = {
  format: 'ffd-lattice', version: 1, size: [3, 3, 3], degree: [2, 2, 2],
  rest: {points: Array.from({length: 27}, (_, i) => {
    const [u, v, w] = [i % 3, Math.floor(i / 3) % 3, Math.floor(i / 9)];
    return [u + 0.2 * v * w, v + 0.1 * u * u, w - 0.15 * u * v].map((x) => x / 2);
  })},
  weights: Array.from({length: 27}, (_, i) => 1 + i % 4 / 4),
  moves: [{at: [1, 1, 1], by: [0.1, 0.2, -0.1]}, {at: [2, 2, 'all'], by: [0, 0.3, 0]}],
};
const FOLDED = {format: 'ffd-lattice', version: 1, size: [4, 4, 4], rest: {box: {min: [0, 0, 0], max: [1, 1, 1]}},
  moves: [{at: [1, 1, 1], by: [8, 0, 0]}]};
const BOX = {format: 'ffd-lattice', version: 1, rest: {box: 'mesh', margin: [0, 0.1, 0.2]}, size: [4, 5, 6],
  moves: [{twist: {axis: 'z', degrees: 50}}, {taper: {axis: 'x', factor: 0.6}}]};
const LATTICES = {curved: CURVED, folded: FOLDED, box: BOX, cylinder: JSON.parse(source('data/lattices/bend-cylinder.json'))};

// A PLY of points, and its array.
function writePoints(folder, points) {
  const type = points instanceof Float32Array ? 'float' : 'double';
  const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${points.length / 3}\n` +
    ['x', 'y', 'z'].map((axis) => `property ${type} ${axis}\n`).join('') + 'end_header\n';
  writeFileSync(join(folder, 'in.ply'), Buffer.concat([Buffer.from(head), Buffer.from(points.buffer)]));
  return head.length;
}

function readArray(Type, path, offset) {
  return new Type(Uint8Array.from(readFileSync(path).subarray(offset)).buffer);
}

// The array of a .npy; what follows it is left out.
function readNumpy(Type, path, length) {
  const bytes = readFileSync(path), start = 10 + bytes.readUInt16LE(8);
  return new Type(Uint8Array.from(bytes.subarray(start, start + length * Type.BYTES_PER_ELEMENT)).buffer);
}

for (const [name, object] of Object.entries(LATTICES))
  for (const Type of [Float32Array, Float64Array])
    test(`points in the lattice ${name} have the program's u,v,w, places and folds (${Type.name})`, (folder) => {
      const points = Type.from(randoms(3 * 5000), (x) => 1.3 * x - 0.1);
      points[6] = NaN;
      const start = writePoints(folder, points);
      writeFileSync(join(folder, 'lattice'), JSON.stringify(object));
      for (const [option, options] of [[[], {}], [['--outside', 'extend', '--falloff', '0.7'], {outside: 'extend', falloff: 0.7}],
        [['--snap', '0.05'], {snap: 0.05}]]) {
        const lattice = ffd.Lattice.parse(object), e = lattice.embed(points, options);
        if (!options.outside) {
          run(folder, ['embed', 'in.ply', '-l', 'lattice', '-o', 'uvw.npy', '--status', 'status.npy', '--force', '-q', ...option]);
          sameBytes(e.uvw, readNumpy(Float64Array, join(folder, 'uvw.npy'), points.length), 'u,v,w');
          sameBytes(e.status, readNumpy(Uint8Array, join(folder, 'status.npy'), points.length / 3), 'statuses');
          assert.equal(e.status[2], 4);
        }
        run(folder, ['deform', 'in.ply', 'out.ply', '-l', 'lattice', '--force', '-q', ...option]);
        const out = lattice.deform(e, points);
        assert.ok(out instanceof Type);
        sameBytes(out, readArray(Type, join(folder, 'out.ply'), start), 'places');
        const other = Type === Float32Array ? new Float64Array(points.length) : new Float32Array(points.length);
        assert.equal(lattice.deform(e, points, other), other);
        if (Type === Float32Array) sameBytes(Float32Array.from(other), out, 'places as float64, rounded');
        else sameBytes(other, Float32Array.from(out), 'places as float32');
        e.free();
        lattice.free();
      }
      run(folder, ['check', 'in.ply', '-l', 'lattice', '--report', 'report.json', '-q']);
      const [{folds}] = JSON.parse(readFileSync(join(folder, 'report.json'))).jobs;
      const lattice = ffd.Lattice.parse(JSON.stringify(object));
      lattice.embed(points);
      assert.deepEqual(lattice.folds(), {verdict: folds.verdict, cells: folds.cells, minDet: folds.min_det});
    });

test('a lattice round points is that of lattice new', (folder) => {
  const points = Float32Array.from(randoms(300), (x) => 3 * x - 1);
  writePoints(folder, points);
  run(folder, ['lattice', 'new', 'in.ply', '-o', 'made.json', '--size', '3,4,5', '--degree', '2,3,1', '--knots', 'open,clamped,uniform',
    '--margin', '0.1,0,0.3']);
  const made = ffd.Lattice.around(points, {size: [3, 4, 5], degree: [2, 3, 1], knots: ['open', 'clamped', 'uniform'], margin: [0.1, 0, 0.3]});
  const read = ffd.Lattice.parse(readFileSync(join(folder, 'made.json'), 'utf8'));
  sameBytes(made.points('rest'), read.points('rest'), 'control points');
  assert.deepEqual([made.size, made.degree], [[3, 4, 5], [2, 3, 1]]);
});

test('control points that are set move the points that affected names, and no other', () => {
  const points = Float64Array.from(randoms(3000));
  const lattice = ffd.Lattice.box({min: [0, 0, 0], max: [1, 1, 1], size: 8}), e = lattice.embed(points);
  sameBytes(lattice.deform(e, points), points, 'places without moves');
  lattice.setOffsets([9], [0.1, 0, 0]);
  const out = lattice.deform(e, points), affected = new Set(e.affected([9]));
  for (let i = 0; i < 1000; i++)
    if (out[3 * i] !== points[3 * i]) assert.ok(affected.has(i), `point ${i} moves`);
  assert.ok(affected.size > 0 && affected.size < 1000);
  const [x, y, z] = lattice.points('rest').subarray(27, 30);
  lattice.setPoints([9], [x, y, z + 0.5]);
  assert.deepEqual(Array.from(lattice.points('deformed').subarray(27, 30)), [x, y, z + 0.5]);
  const again = ffd.Lattice.parse(lattice.text());
  sameBytes(again.deform(e, points), lattice.deform(e, points), 'places by the written lattice');
});

test('large arrays, for which the memory grows, and freed ones', () => {
  const points = Float32Array.from(randoms(3 * 400000)), lattice = ffd.Lattice.around(points), first = lattice.embed(points.slice(0, 300));
  const before = first.uvw.slice(), e = lattice.embed(points);
  lattice.setOffsets([21], [0.2, 0.1, 0]);
  const all = lattice.deform(e, points), some = lattice.deform(first, points.slice(0, 300));
  sameBytes(first.uvw, before, 'u,v,w of before');
  sameBytes(all.slice(0, 300), some, 'the first of them');
  e.free();
  e.free();
  assert.throws(() => lattice.deform(e, points), {name: 'FfdError', code: 2});
  assert.equal(ffd.Lattice.box({min: [0, 0, 0], max: [1, 1, 1]}).embed(new Float32Array(0)).uvw.length, 0);
});

test('what a caller does wrong is an FfdError with the code 2', () => {
  const lattice = ffd.Lattice.box({min: [0, 0, 0], max: [1, 1, 1]}), points = new Float32Array(6), e = lattice.embed(points);
  for (const [what, act] of Object.entries({
    'an array of other numbers': () => lattice.embed([0, 0, 0]),
    'no triples': () => lattice.embed(new Float32Array(4)),
    'a word': () => lattice.embed(points, {outside: 'stay'}),
    'falloff alone': () => lattice.embed(points, {falloff: 1}),
    'a text for a number': () => lattice.embed(points, {snap: '1'}),
    'another count': () => lattice.deform(e, new Float32Array(9)),
    'a short out': () => lattice.deform(e, points, new Float32Array(3)),
    'an index': () => lattice.setOffsets([64], [0, 0, 0]),
    'a negative index': () => lattice.setOffsets([-1], [0, 0, 0]),
    'half an index': () => e.affected([0.5]),
    'too few numbers': () => lattice.setPoints([0, 1], [0, 0, 0]),
    'a constructor': () => new ffd.Lattice(),
    'no points yet': () => ffd.Lattice.parse(BOX).points('rest'),
    'folds of no points yet': () => ffd.Lattice.parse(BOX).folds(),
    'a volume': () => lattice.points('both'),
  })) assert.throws(act, (problem) => problem instanceof FfdError && problem.code === 2 && problem.message.startsWith('ffd: ') &&
    !problem.message.includes('\n'), what);
});

test('errors of lattices have the exit code, line, file and pointer of the program', (folder) => {
  writePoints(folder, new Float32Array(3));
  for (const [text, pointer] of [['{"format": "ffd-lattice",\n  "version": }', undefined], [JSON.stringify({...BOX, size: [4, 4, 0]}), '/size/2'],
    [JSON.stringify({...BOX, version: 99}), '/version'], [JSON.stringify({...CURVED, moves: [{by: [0, 0, 1e999]}]}), '/moves/0/by/2'],
    [JSON.stringify({...CURVED, moves: [{twist: {axis: 'q', degrees: 1}}]}), '/moves/0/twist/axis']]) {
    writeFileSync(join(folder, 'lattice'), text);
    let thrown;
    try {
      ffd.Lattice.parse(text);
    } catch (problem) {
      thrown = problem;
    }
    assert.ok(thrown instanceof FfdError, text);
    const {stderr} = run(folder, ['check', 'in.ply', '-l', 'lattice'], {code: thrown.code});
    assert.deepEqual([thrown.message, thrown.file, thrown.pointer], [String(stderr).trimEnd(), 'lattice', pointer]);
  }
  const e = ffd.Lattice.parse(CURVED).embed(new Float32Array(3));
  assert.throws(() => ffd.Lattice.parse(FOLDED).deform(e, new Float32Array(3)), {code: 4});
  assert.throws(() => ffd.Lattice.box({min: [0, 0, 0], max: [1, 1, 1]}).embed(Float32Array.of(5, 5, 5), {outside: 'error'}), {code: 5});
});

// What of the folder a mesh needs, in the package's form.
const MODELS = {
  'knight.glb': [], 'spot.obj': [], 'keg_decorated.obj': ['keg_decorated.mtl', ...readdirSync(join(root, 'data/models/Textures')).map((name) => 'Textures/' + name)],
};

for (const [name, beside] of Object.entries(MODELS))
  test(`the bytes of ${name} are deformed, checked and shown as its file is`, async (folder) => {
    const files = Object.fromEntries(beside.map((file) => [file, source('data/models/' + file)])), text = JSON.stringify(BOX);
    const mesh = {name, bytes: source('data/models/' + name), files};
    writeFileSync(join(folder, 'lattice'), text);
    run(root, ['deform', 'data/models/' + name, join(folder, name), '-l', join(folder, 'lattice'), '-q', '--report', join(folder, 'report.json'), '--report-stable']);
    const {bytes, files: others, report} = await ffd.deform(mesh, text, {reportStable: true});
    sameBytes(bytes, readFileSync(join(folder, name)), name);
    const expected = readdirSync(folder, {recursive: true, withFileTypes: true}).filter((entry) => entry.isFile());
    for (const file of Object.keys(others)) sameBytes(others[file], readFileSync(join(folder, file)), file);
    assert.equal(expected.length, Object.keys(others).length + 3, Object.keys(others).join(' '));
    const job = ({jobs: [{input, output, outputs, ...figures}]}) => figures;
    const native = JSON.parse(readFileSync(join(folder, 'report.json')));
    assert.deepEqual(job(report), job(native));
    assert.deepEqual([report.jobs[0].input, report.jobs[0].output], [name, name]);
    assert.deepEqual(report.jobs[0].outputs, native.jobs[0].outputs.map((path) => path.replace(folder + '/', '')));
    // The lattice as an object of the core, which goes round this mesh too.
    sameBytes((await ffd.deform(mesh, [ffd.Lattice.parse(text)])).bytes, bytes, 'by a Lattice');
    sameBytes((await ffd.deform(mesh, BOX)).bytes, bytes, 'by an object');

    const checked = await ffd.check(mesh, text, {reportStable: true});
    run(folder, ['check', join(root, 'data/models', name), '-l', 'lattice', '-q', '--report', 'check.json', '--report-stable']);
    assert.deepEqual(job(checked.report), job(JSON.parse(readFileSync(join(folder, 'check.json')))));
    assert.deepEqual(await ffd.info(mesh), JSON.parse(run(join(root, 'data/models'), ['info', name, '--json']).stdout));
    assert.deepEqual((await ffd.info({name: 'a.json', bytes: text})).size, [4, 5, 6]);
    const {bytes: picture} = await ffd.view(mesh, text, {output: 'a.png', size: '80x60', camera: 'front'});
    run(folder, ['view', join(root, 'data/models', name), '-l', 'lattice', '-o', 'a.png', '--size', '80x60', '--camera', 'front', '-q']);
    sameBytes(picture, readFileSync(join(folder, 'a.png')), 'the picture');
    assert.match(new TextDecoder().decode((await ffd.view(mesh)).bytes), /^<!doctype html>/i);
    run(folder, ['edit', join(root, 'data/models', name), '--size', '3,4,5', '-o', 'edit.html', '-q']);
    sameBytes((await ffd.edit(mesh, null, {size: [3, 4, 5]})).bytes, readFileSync(join(folder, 'edit.html')), 'the page of tools');
  });

test('a .gltf comes with its buffers, whose names follow the result', async (folder) => {
  run(root, ['deform', 'data/models/spot.obj', join(folder, 'spot.gltf'), '-l', 'data/lattices/twist.json', '-q']);
  const read = (name) => readFileSync(join(folder, name)), mesh = {name: 'spot.gltf', bytes: read('spot.gltf'), files: {'spot.bin': read('spot.bin')}};
  writeFileSync(join(folder, 'lattice'), JSON.stringify(BOX));
  run(folder, ['deform', 'spot.gltf', 'new.gltf', '-l', 'lattice', '-q']);
  const {bytes, files} = await ffd.deform(mesh, BOX, {output: 'new.gltf'});
  sameBytes(bytes, read('new.gltf'), 'new.gltf');
  assert.deepEqual(Object.keys(files), ['new.bin']);
  sameBytes(files['new.bin'], read('new.bin'), 'new.bin');
  await assert.rejects(ffd.deform({...mesh, files: {}}, BOX), {code: 3, file: 'spot.gltf'});
});

// The C library of WebAssembly reads and writes the numbers for which ours falls back to it.
test('numbers are read and written as by the native program: all powers of two, and random ones', async (folder) => {
  const bits = BigUint64Array.from(randoms(6 * 20000), (x) => BigInt(Math.floor(x * 2 ** 32)));
  const random = new Float64Array(BigUint64Array.from({length: 60000}, (_, i) => bits[2 * i] << 32n | bits[2 * i + 1]).buffer);
  const powers = Array.from({length: 2098}, (_, i) => 2 ** (i - 1074));
  const numbers = Float64Array.from([...powers, ...random].filter((x) => Number.isFinite(x) && Math.abs(x) < 1e150));
  const points = numbers.slice(0, numbers.length - numbers.length % 3);
  writePoints(folder, points);
  const still = {...FOLDED, moves: []};
  writeFileSync(join(folder, 'lattice'), JSON.stringify(still));
  run(folder, ['deform', 'in.ply', 'out.obj', '-l', 'lattice', '-q']);
  const text = readFileSync(join(folder, 'out.obj'));
  sameBytes((await ffd.deform({name: 'in.ply', bytes: readFileSync(join(folder, 'in.ply'))}, still, {output: 'out.obj'})).bytes, text, 'written');
  // With digits that no shortest text has.
  const extend = (number) => number.replace(/^-?[\d.]+/, (digits) => digits + (digits.includes('.') ? '' : '.') + '0123456789'.repeat(3));
  const long = String(text).replace(/^v .*/gm, (line) => line.replace(/ (\S+)/g, (_, number) => ' ' + extend(number)));
  for (const [name, content] of [['short.obj', String(text)], ['long.obj', long]]) {
    writeFileSync(join(folder, name), content);
    run(folder, ['deform', name, 'back.ply', '-l', 'lattice', '-q', '--force']);
    sameBytes((await ffd.deform({name, bytes: content}, still, {output: 'back.ply'})).bytes, readFileSync(join(folder, 'back.ply')), name);
  }
});

test('options are those of the program, in camelCase', async (folder) => {
  const bytes = source('data/models/knight.glb'), mesh = {name: 'knight.glb', bytes};
  writeFileSync(join(folder, 'knight.glb'), bytes);
  writeFileSync(join(folder, 'lattice'), JSON.stringify(BOX));
  const {named_parts: parts} = await ffd.info(mesh, {parts: true});
  const only = parts.filter(({kind, vertices}) => kind === 'node' && vertices > 0).slice(0, 2).map(({selector}) => selector);
  assert.equal(only.length, 2);
  run(folder, ['deform', 'knight.glb', 'out.glb', '-l', 'lattice', '-q', '--as-morph', 'a b', '--normals', 'keep', ...only.flatMap((name) => ['--only', name])]);
  sameBytes((await ffd.deform(mesh, BOX, {asMorph: 'a b', normals: 'keep', only, strict: false, timeout: undefined})).bytes,
    readFileSync(join(folder, 'out.glb')), 'with options');
  const placed = {...BOX, moves: [{twist: {axis: 'z', degrees: {$: 'angle'}}}]};
  sameBytes((await ffd.deform(mesh, placed, {set: {angle: 12.5}})).bytes, (await ffd.deform(mesh, placed, {set: ['angle=12.5']})).bytes, 'set');
  await assert.rejects(ffd.deform(mesh, BOX, {asMorf: 'a'}), {code: 2, message: /--as-morf.*nearest: --as-morph/});
  await assert.rejects(ffd.deform(mesh, BOX, {outDir: 'a'}), {code: 2});
  await assert.rejects(ffd.deform(mesh, FOLDED, {failOn: ['folds']}), (problem) => problem.code === 1 && problem.report.jobs[0].folds.verdict === 'some');
  const {warnings} = await ffd.deform({name: 'a.obj', bytes: 'v 9 9 9\nv 0.5 0.5 0.5\n'}, FOLDED);
  assert.match(warnings.join('\n'), /1 of 2 vertices/);
});

test('errors of jobs have the exit code, line, file and pointer of the program', async (folder) => {
  const broken = JSON.stringify({...BOX, size: [4, 4, 0]});
  writeFileSync(join(folder, 'lattice'), broken);
  writeFileSync(join(folder, 'a.obj'), 'v 1 2\n');
  for (const [mesh, lattice, file, pointer] of [[{name: 'a.obj', bytes: 'v 1 2\n'}, BOX, 'a.obj', undefined],
    [{name: 'a.obj', bytes: 'v 1 2 3\n'}, broken, 'lattice', '/size/2']]) {
    writeFileSync(join(folder, 'lattice'), typeof lattice === 'string' ? lattice : JSON.stringify(lattice));
    writeFileSync(join(folder, 'a.obj'), mesh.bytes);
    const problem = await ffd.deform(mesh, lattice).then(() => null, (thrown) => thrown);
    const {stderr} = run(folder, ['deform', 'a.obj', 'out.obj', '-l', 'lattice'], {code: problem.code});
    assert.deepEqual([problem.message, problem.file, problem.pointer], [String(stderr).trimEnd(), file, pointer]);
  }
  for (const name of ['', '..', 'a/../b.obj', '/a.obj', 'a.xyz'])
    await assert.rejects(ffd.deform({name, bytes: ''}, BOX), {name: 'FfdError', code: 2}, name);
  await assert.rejects(ffd.info({name: 'a.obj'}), {code: 2});
});

test('lattices in other formats, with the bytes of the program', async (folder) => {
  const text = JSON.stringify({format: 'ffd-lattice', version: 1, size: [3, 4, 2], degree: [2, 3, 1],
    rest: {box: {min: [0, 0, 0], max: [1, 2, 3]}}, moves: [{at: [1, 'all', 'all'], by: [0, 0.25, 0.1]}]});
  const packed = readFileSync(join(root, 'tests/fuzz/corpus/table/zlib.vts'));
  writeFileSync(join(folder, 'a.json'), text);
  writeFileSync(join(folder, 'z.vts'), packed);
  for (const [name, output, options] of [['a.json', 'b.vts'], ['a.json', 'b.vtk'], ['a.json', 'b.csv'], ['a.json', 'b.obj'], ['a.json', 'b.glb'],
    ['a.json', 'b.xyz', {part: 'deformed'}], ['z.vts', 'b.json']]) {
    const done = await ffd.convertLattice({name, bytes: name === 'a.json' ? text : packed}, {output, ...options});
    run(folder, ['lattice', 'convert', name, '-o', output, '-q', ...options ? ['--part', options.part] : []]);
    sameBytes(done.bytes, readFileSync(join(folder, output)), output);
    assert.deepEqual([done.name, done.files], [output, {}]);
  }
  const {warnings} = await ffd.convertLattice({name: 'a.json', bytes: text.replace('[2,3,1]', '[1,3,1]')}, {output: 'b.xyz', part: 'rest'});
  assert.deepEqual([warnings.length, /b\.xyz: Plot3D holds positions alone/.test(warnings[0])], [1, true]);
  await assert.rejects(ffd.convertLattice({name: 'a.json', bytes: text}, {output: 'b.xyz'}), {code: 2, message: /holds one state/});
  await assert.rejects(ffd.convertLattice({name: 'a.json', bytes: text}, {}), {name: 'FfdError', code: 2});
  await assert.rejects(ffd.convertLattice({name: 'a.vts', bytes: packed.subarray(0, 900)}, {output: 'b.json'}), {code: 4, file: 'a.vts'});
});

// A .npy of N x 3 numbers, or of N.
function numpyOf(numbers, shape) {
  const head = `{'descr': '<f8', 'fortran_order': False, 'shape': (${shape.join()},), }`.padEnd(117) + '\n';
  const start = Buffer.from('\x93NUMPY\x01\x00v\x00', 'latin1');
  return Buffer.concat([start, Buffer.from(head), Buffer.from(Float64Array.from(numbers).buffer)]);
}

// The vertices of an OBJ.
const verticesOf = (bytes) => new TextDecoder().decode(bytes).match(/^v .*/gm).map((line) => line.split(/ +/).slice(1, 4).map(Number));

// What the program warns of at a fit, without its result.
const warningsOf = ({stderr}) => String(stderr).split('\n').filter((line) => line && !/^ffd: fit: /.test(line));

// What a fit is, without the names of its files.
const jobOf = ({jobs: [{input, output, outputs, ...figures}]}) => figures;

test('fits of meshes and arrays have the bytes and the report of the program', async (folder) => {
  const bytes = source('data/models/spot.obj');
  writeFileSync(join(folder, 'spot.obj'), bytes);
  run(folder, ['deform', 'spot.obj', 'after.obj', '-l', join(root, 'data/lattices/twist.json'), '-q']);
  const posed = readFileSync(join(folder, 'after.obj')), vertices = verticesOf(bytes), targets = verticesOf(posed);
  const files = {'w.npy': numpyOf(randoms(vertices.length), [vertices.length]), 'a.npy': numpyOf(vertices.flat(), [vertices.length, 3]),
    'b.npy': numpyOf(targets.flat(), [vertices.length, 3]), 'wide.obj': 'v -2 -2 -2\nv 2 2 2\n'};
  for (const [name, content] of Object.entries(files)) writeFileSync(join(folder, name), content);
  writeFileSync(join(folder, 'base.json'), JSON.stringify({...BOX, size: [5, 5, 5], moves: [{twist: {axis: 'z', degrees: {$: 'turn'}}}]}));
  const base = readFileSync(join(folder, 'base.json')), weights = {name: 'w.npy', bytes: files['w.npy']};
  const fitted = async (before, after, words, options, wasm = [before, after]) => {
    const warned = warningsOf(run(folder, ['fit', before, after, '-o', 'a.json', '--report', 'report.json', '--report-stable', '--force', ...words]));
    const done = await ffd.fit(...wasm, {reportStable: true, ...options}), report = JSON.parse(readFileSync(join(folder, 'report.json')));
    sameBytes(done.bytes, readFileSync(join(folder, 'a.json')), words.join(' '));
    assert.deepEqual(jobOf(done.report), jobOf(report));
    assert.deepEqual(done.fit, report.jobs[0].fit);
    assert.deepEqual([done.name, done.files, done.warnings], [options?.output ?? 'fit.json', {}, warned]);
    return done;
  };
  // Exporters give both one name.
  const before = {name: 'spot.obj', bytes, files: {...files, 'spot.mtl': ''}}, after = {name: 'spot.obj', bytes: posed, files: {'spot.mtl': 'a'}};
  const {bytes: found, fit, report} = await fitted('spot.obj', 'after.obj', [], undefined, [before, after]);
  assert.deepEqual([report.jobs[0].input, report.jobs[0].outputs, fit.smooth_chosen_by], ['spot.obj', ['fit.json'], 'gcv']);
  const moved = verticesOf((await ffd.deform({name: 'spot.obj', bytes}, found)).bytes);
  const far = Math.max(...moved.map((place, i) => Math.hypot(...place.map((x, axis) => x - targets[i][axis]))));
  assert.ok(Math.abs(far - fit.residual.max) < 1e-6, `${far} from AFTER, but the report says ${fit.residual.max}`);
  sameBytes(ffd.Lattice.parse(found).points('deformed'), ffd.Lattice.parse(new TextDecoder().decode(found)).points('deformed'), 'the lattice');
  for (const [words, options] of [
    [['--size', '8,4,5', '--degree', '2,3,1', '--knots', 'clamped,open,uniform', '--margin', '0.1,0,0.2', '--smooth', '0'],
      {size: [8, 4, 5], degree: [2, 3, 1], knots: ['clamped', 'open', 'uniform'], margin: [0.1, 0, 0.2], smooth: 0}],
    [['--size', '7', '--within', '0.02r', '--robust'], {size: 7, within: '0.02r', robust: true, output: 'near.json'}],
    [['--symmetric', 'u', '--smooth', '0.5', '--weights', 'w.npy', '--axes', 'principal'],
      {symmetric: 'u', smooth: 0.5, weights: 'w.npy', axes: 'principal'}],
    [['--cover', 'wide.obj', '--weights', 'uniform', '--smooth', 'auto'],
      {cover: ['wide.obj', {name: 'spot.obj', bytes}], weights: 'uniform', smooth: 'auto'}],
    [['-l', 'base.json', '--set', 'turn=20', '--weights', 'w.npy'], {lattice: base, set: {turn: 20}, weights}],
  ]) await fitted('spot.obj', 'after.obj', words, options, [before, after]);
  await fitted('a.npy', 'b.npy', ['--fail-on', 'folds'], {failOn: ['folds']}, ['a.npy', 'b.npy'].map((name) => ({name, bytes: files[name]})));
});

test('fits of pairs, with and without a mesh, and as handles', async (folder) => {
  const mesh = {name: 'spot.obj', bytes: source('data/models/spot.obj')};
  const dragged = 'vertex,x,y,z,weight\n100,0.5,0.4,0.3,exact\n2000,0,0,0,\n', numbers = randoms(3 * 60);
  const placed = 'px,py,pz,x,y,z\r\n' + Array.from({length: 60}, (_, i) => {
    const [x, y, z] = numbers.subarray(3 * i, 3 * i + 3);
    return [x, y, z, 1.2 * x, y - x * x / 5, z].join() + '\r\n';
  }).join('');
  writeFileSync(join(folder, 'dragged.csv'), dragged);
  writeFileSync(join(folder, 'placed.csv'), placed);
  writeFileSync(join(folder, 'spot.obj'), mesh.bytes);
  for (const [before, name, table, options, words] of [[mesh, 'dragged.csv', dragged, {handles: true}, ['spot.obj', '--handles']],
    [null, 'placed.csv', placed, {size: '4,5,4', handles: false}, ['--size', '4,5,4']],
    [mesh, 'placed.csv', placed, {snap: 5}, ['spot.obj', '--snap', '5']]]) {
    run(folder, ['fit', ...words, '--pairs', name, '-o', 'a.json', '--report', 'report.json', '--report-stable', '-q', '--force']);
    const expected = readFileSync(join(folder, 'a.json')), {jobs: [{fit, input}]} = JSON.parse(readFileSync(join(folder, 'report.json')));
    for (const pairs of [table, {name, bytes: table}, ...before ? [name] : []]) {
      const done = await ffd.fit(before && {...before, files: {[name]: table}}, null, {pairs, ...options});
      sameBytes(done.bytes, expected, name);
      assert.deepEqual(done.fit, fit);
      if (before) assert.equal(done.report.jobs[0].input, input);
    }
  }
  const {fit} = await ffd.fit(mesh, null, {pairs: dragged, handles: true});
  assert.deepEqual([fit.pairs, fit.exact, fit.affine.flat().every((x) => x === 0)], [2, 1, true]);
  assert.ok(fit.residual_exact < 1e-12);
});

test('fits of points in memory have the bits and the figures of the program', async (folder) => {
  const vertices = verticesOf(source('data/models/spot.obj')), before = Float64Array.from(vertices.flat());
  const after = before.map((x, i) => x + 0.1 * Math.sin(3 * before[i - i % 3 + (i + 1) % 3])), count = vertices.length, weights = randoms(count);
  const csv = 'px,py,pz,x,y,z,weight\n' + Array.from({length: count}, (_, i) => [...before.subarray(3 * i, 3 * i + 3), ...after.subarray(3 * i, 3 * i + 3),
    [3, 50].includes(i) ? 'exact' : 1].join() + '\n').join('');
  const written = {'a.npy': numpyOf(before, [count, 3]), 'b.npy': numpyOf(after, [count, 3]), 'w.npy': numpyOf(weights, [count]), 'p.csv': csv,
    'base.json': JSON.stringify({...BOX, size: [5, 4, 6], rest: {box: {min: [-2, -2, -2], max: [2, 2, 2]}}})};
  for (const [name, content] of Object.entries(written)) writeFileSync(join(folder, name), content);
  for (const [words, options] of [[['a.npy', 'b.npy'], {}], [['a.npy', 'b.npy', '--size', '4,6,5', '--knots', 'clamped', '--smooth', '0.1'],
    {size: [4, 6, 5], knots: 'clamped', smooth: 0.1}], [['a.npy', 'b.npy', '--weights', 'w.npy', '--within', '0.01r', '--robust'], {weights, within: '0.01r', robust: true}],
  [['a.npy', 'b.npy', '-l', 'base.json', '--symmetric', 'u', '--smooth', '1'], {lattice: written['base.json'], symmetric: 'u', smooth: 1}],
  [['--pairs', 'p.csv', '--smooth', '0.01', '--snap', '0.1r'], {exact: [3, 50], smooth: 0.01, snap: '0.1r'}],
  [['--pairs', 'p.csv', '--handles'], {exact: [3, 50], handles: true}]]) {
    run(folder, ['fit', ...words, '-o', 'found.json', '--report', 'report.json', '-q', '--force']);
    const {lattice, report} = ffd.fit(before, after, options), {jobs: [{fit}]} = JSON.parse(readFileSync(join(folder, 'report.json')));
    assert.deepEqual(report, fit, words.join(' '));
    const expected = ffd.Lattice.parse(readFileSync(join(folder, 'found.json')));
    sameBytes(lattice.points(), expected.points(), words.join(' '));
  }
  const whole = new Float32Array(before), {lattice, report} = await ffd.fit(whole, new Float32Array(after), {size: 4, lattice: undefined});
  assert.deepEqual([report.pairs, report.used, lattice.size], [count, count, [4, 4, 4]]);
  const few = before.subarray(0, 6);
  for (const [what, call, expected] of [['other numbers', () => ffd.fit(before, few), {code: 2, message: /after: 2 points/}],
    ['no array', () => ffd.fit(before, [0, 0, 0]), {code: 2}], ['a list', () => ffd.fit(few, few, {weights: [1]}), {code: 2, message: /1 numbers, but 2 pairs/}],
    ['an option of files', () => ffd.fit(few, few, {failOn: 'folds'}), {code: 2, message: /failOn is no option of points/}],
    ['two ways to be smooth', () => ffd.fit(few, few, {smooth: 1, within: 1}), {code: 2}], ['a word', () => ffd.fit(few, few, {smooth: 'much'}), {code: 2}],
    ['a base and a box', () => ffd.fit(few, few, {lattice: BOX, size: 4}), {code: 2}], ['a direction', () => ffd.fit(few, few, {symmetric: 'x'}), {code: 2}],
    ['robust handles', () => ffd.fit(few, few, {handles: true, robust: true}), {code: 2}], ['a pair', () => ffd.fit(few, few, {exact: [2]}), {code: 2}],
    ['a part', () => ffd.fit(few, few, {within: 'r'}), {code: 2}], ['not finite', () => ffd.fit(few, few.map(() => NaN)), {code: 4}],
    ['too large', () => ffd.fit(few, few, {size: 39}), {code: 7}],
    ['two places', () => ffd.fit(Float64Array.of(0, 0, 0, 0, 0, 0, 1, 1, 1), Float64Array.of(0, 0, 0, 1, 0, 0, 1, 1, 1), {exact: [0, 1]}), {code: 1, message: /contradict/}],
  ]) assert.throws(call, {name: 'FfdError', ...expected}, what);
});

test('refused fits, and what they warn of', async (folder) => {
  const mesh = {name: 'spot.obj', bytes: source('data/models/spot.obj')}, other = {name: 'spot.obj', bytes: 'v 1 2 3\n'};
  const folding = 'x,y,z,px,py,pz\n0,0,1,0,0,0\n1,0,1,1,0,0\n0,1,1,0,1,0\n0,0,3,0,0,1\n', dragging = {pairs: folding, handles: true};
  writeFileSync(join(folder, 'pairs.csv'), folding);
  const {warnings, fit} = await ffd.fit(null, null, dragging);
  assert.deepEqual(warnings, warningsOf(run(folder, ['fit', '--pairs', 'pairs.csv', '--handles', '-o', 'a.json'])));
  assert.deepEqual([warnings.length, fit.folds.verdict], [1, 'some']);
  await assert.rejects(ffd.fit(null, null, {...dragging, failOn: 'folds'}), ({code, report, warnings: before}) =>
    code === 1 && report.jobs[0].fit.folds.verdict === 'some' && before.length === 0);
  const broken = 'x,y,z,px,py,pz\n0,0,1,0,0\n';
  for (const [what, call, expected] of [
    ['one file', () => ffd.fit(mesh), {code: 2, message: /needs BEFORE and AFTER/}],
    ['nothing', () => ffd.fit(null, null), {code: 2, message: /needs BEFORE and AFTER/}],
    ['AFTER alone', () => ffd.fit(null, mesh), {code: 2}],
    ['AFTER and pairs', () => ffd.fit(mesh, mesh, {pairs: folding}), {code: 2, message: /--pairs has the targets/}],
    ['handles of meshes', () => ffd.fit(mesh, mesh, {handles: true}), {code: 2, message: /--handles needs --pairs/}],
    ['two ways to be smooth', () => ffd.fit(mesh, mesh, {smooth: 1, within: 1}), {code: 2, message: /cannot be used together/}],
    ['a word', () => ffd.fit(mesh, mesh, {smooth: 'much'}), {code: 2, message: /--smooth: "much"/}],
    ['two values', () => ffd.fit(mesh, mesh, {size: [4, 4]}), {code: 2, message: /--size/}],
    ['a base and a box', () => ffd.fit(mesh, mesh, {lattice: BOX, size: 4}), {code: 2}],
    ['two bases', () => ffd.fit(mesh, mesh, {lattice: [BOX, BOX]}), {code: 2, message: /starts from one lattice/}],
    ['another format', () => ffd.fit(mesh, mesh, {output: 'a.vts'}), {code: 2}],
    ['a report', () => ffd.fit(mesh, mesh, {report: 'a.json'}), {code: 2}],
    ['no vertices', () => ffd.fit(mesh, {name: 'a.obj'}), {code: 2, message: /a\.obj: no bytes/}],
    ['a file that is not there', () => ffd.fit(mesh, null, {pairs: 'a.csv'}), {code: 3, message: /a\.csv/}],
    ['a short row', () => ffd.fit(null, null, {pairs: broken}), {code: 4, file: 'pairs.csv', message: /^ffd: pairs\.csv:2: /}],
    ['a short row of a file', () => ffd.fit(null, null, {pairs: {name: 'b/a.csv', bytes: broken}}), {code: 4, file: 'b/a.csv'}],
    ['no mesh', () => ffd.fit({...mesh, bytes: 'v 1 2\n'}, mesh), {code: 4, file: 'spot.obj'}],
    ['no mesh after it', () => ffd.fit(mesh, {...mesh, bytes: 'v 1 2\n'}), {code: 4, file: 'after/spot.obj'}],
    ['a broken base', () => ffd.fit(mesh, mesh, {lattice: {...BOX, version: 99}}), {code: 6, file: 'lattice', pointer: '/version'}],
    ['other vertices', () => ffd.fit(mesh, other), {code: 4, file: 'after/spot.obj'}],
    ['nothing inside', () => ffd.fit(other, null, {pairs: folding, lattice: {...FOLDED, rest: {box: {min: [5, 5, 5], max: [6, 6, 6]}}, moves: []}}), {code: 5}],
  ]) await assert.rejects(call(), {name: 'FfdError', ...expected}, what);
});

test('init takes modules of the caller', async () => {
  const bytes = readFileSync(join(packageFolder, 'dist/core.wasm'));
  for (const wasm of [bytes, pathToFileURL(join(packageFolder, 'dist/core.wasm')), await WebAssembly.compile(bytes)])
    assert.deepEqual((await init({wasm})).Lattice.box({min: [0, 0, 0], max: [1, 1, 1]}).size, [4, 4, 4]);
  const {info} = await init({programWasm: await WebAssembly.compile(readFileSync(join(packageFolder, 'dist/program.wasm')))});
  assert.equal((await info({name: 'a.obj', bytes: 'v 0 0 0\n'})).mesh_format, 'OBJ');
});

void native;
await runAll();
