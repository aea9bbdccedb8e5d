// The core beside the native program, a million points on one thread with scalar kernels: bench.mjs PACKAGE FFD ROOT. The bar is 2.5 times
// the native seconds of embedding, and of deforming. To be run by hand, where nothing else runs.
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {ffd as run, packageFolder, randoms, runAll, source, test} from './tools.mjs';

const {init} = await import(pathToFileURL(join(packageFolder, 'dist', 'ffd-mesh.mjs')));
const {Lattice} = await init();
const BAR = 2.5, POINTS = 1e6, RUNS = 5;

// The least seconds of several runs.
const least = (runs, act) => Math.min(...Array.from({length: runs}, act));

function seconds(act) {
  const began = performance.now();
  act();
  return (performance.now() - began) / 1e3;
}

for (const name of ['twist', 'bend-cylinder'])
  test(`${name}: the core takes at most ${BAR} times the native seconds`, (folder) => {
    const points = Float32Array.from(randoms(3 * POINTS)), text = String(source(`data/lattices/${name}.json`)), lattice = Lattice.parse(text);
    writeFileSync(join(folder, 'lattice.json'), text);
    const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${POINTS}\nproperty float x\nproperty float y\nproperty float z\nend_header\n`;
    writeFileSync(join(folder, 'in.ply'), Buffer.concat([Buffer.from(head), Buffer.from(points.buffer)]));
    const native = Array.from({length: RUNS}, () => {
      run(folder, ['deform', 'in.ply', 'out.ply', '-l', 'lattice.json', '--isa', 'scalar', '--threads', '1', '--report', 'report.json', '--force', '-q']);
      return JSON.parse(readFileSync(join(folder, 'report.json'))).jobs[0].seconds;
    });
    let e;
    const embed = least(RUNS, () => seconds(() => { e?.free(); e = lattice.embed(points); })), deform = least(RUNS, () => seconds(() => lattice.deform(e, points)));
    const [ofEmbed, ofDeform] = ['embed', 'deform'].map((part) => Math.min(...native.map((times) => times[part])));
    console.log(`${name}: embed ${embed.toFixed(3)} s, native ${ofEmbed.toFixed(3)}; deform ${deform.toFixed(3)} s, native ${ofDeform.toFixed(3)}`);
    if (embed > BAR * ofEmbed || deform > BAR * ofDeform) throw new Error('it takes longer');
  });

await runAll();
