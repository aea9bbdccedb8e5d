// The types of the package: compiled, never run. A line behind "expect-error" must be wrong.
import {FfdError, init, type Fit, type FitResult, type Lattice} from 'ffd-mesh';
import {ffd as transform} from 'ffd-mesh/gltf-transform';
import {Document} from '@gltf-transform/core';

const ffd = await init({wasm: new URL('core.wasm', 'file:///'), programWasm: new Uint8Array(8)});
const lattice: Lattice = ffd.Lattice.parse({format: 'ffd-lattice'});
const box: Lattice = ffd.Lattice.box({min: [0, 0, 0], max: new Float32Array(3), size: [4, 4, 5], knots: ['open', 'clamped', {closed: [0, 1]}]});
const e = box.embed(new Float32Array(9), {outside: 'extend', falloff: 1});
const single: Float32Array = box.deform(e, new Float32Array(9));
const double: Float64Array = box.deform(e, new Float32Array(9), new Float64Array(9));
const affected: Uint32Array = e.affected(new Set([1, 2]));
const verdict: 'none' | 'some' | 'unknown' = box.folds().verdict;
const {bytes, files, report} = await ffd.deform({name: 'a.glb', bytes: new ArrayBuffer(1)}, [lattice, '{}', {}], {asMorph: 'a', failOn: ['folds'], only: 'node:a'});
const text: string = lattice.text() + report.jobs[0].status + bytes.length + Object.keys(files).join();
await new Document().transform(transform({lattice, normals: 'keep', only: ['node:a']}));
try {
  await ffd.check({name: 'a.obj', bytes: ''}, lattice);
} catch (problem) {
  if (problem instanceof FfdError) console.log(problem.code + 1, problem.file?.length, problem.pointer, single, double, affected, verdict, text);
}
const grid: Uint8Array = (await ffd.convertLattice({name: 'a.xyz', bytes: ''}, {output: 'a.vts', block: 1, order: 'auto'})).bytes;
// @ts-expect-error
await ffd.convertLattice({name: 'a.xyz', bytes: grid});
const fitted: FitResult = await ffd.fit({name: 'a.npy', bytes: single}, {name: 'b.npy', bytes: double}, {size: [6, 4, 4], knots: 'open',
  smooth: 'auto', within: '1e-3r', weights: {name: 'w.npy', bytes: single}, symmetric: 'u', robust: true, failOn: ['folds'], lattice: grid});
const found: Fit = (await ffd.fit(null, null, {pairs: 'x,y,z,px,py,pz\n', handles: true, cover: ['a.obj', {name: 'b.obj', bytes: ''}]})).fit;
const chosen: 'gcv' | 'default' | 'within' | 'given' | 'folds' = found.smooth_chosen_by;
const far: number = fitted.report.jobs[0].fit!.residual.max + found.affine[3][2] + (found.gcv ?? 0) + chosen.length;
await ffd.check({name: 'a.obj', bytes: ''}, [fitted.bytes, fitted.lattice], {set: {far}});

const carried: {lattice: Lattice; report: Fit} = ffd.fit(single, double, {size: [4, 5, 6], knots: 'closed', within: '1e-3r', exact: [1], weights: double});
// @ts-expect-error
ffd.fit(single, {name: 'b.obj', bytes: ''});
// @ts-expect-error
ffd.fit(single, double, {failOn: 'folds'});
// @ts-expect-error
ffd.fit([0, 0, 0], [0, 0, 0]);
// @ts-expect-error
ffd.fit({name: 'a.obj', bytes: ''}, null, {handles: true});
// @ts-expect-error
ffd.fit({name: 'a.obj', bytes: ''}, {name: 'b.obj', bytes: ''}, {pairs: 'x'});
// @ts-expect-error
ffd.fit({name: 'a.obj', bytes: ''}, {name: 'b.obj', bytes: ''}, {smooth: 'much'});
// @ts-expect-error
ffd.fit({name: 'a.obj', bytes: ''}, {name: 'b.obj', bytes: ''}, {symmetric: 'x'});
// @ts-expect-error
ffd.fit({name: 'a.obj', bytes: ''}, {name: 'b.obj', bytes: ''}, {weights: 'volume'});
// @ts-expect-error
box.embed([0, 0, 0]);
// @ts-expect-error
await ffd.deform({bytes: 'a'}, lattice);
// @ts-expect-error
box.embed(single, {outside: 'stay'});
