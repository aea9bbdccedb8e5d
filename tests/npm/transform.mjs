// The function for documents of gltf-transform: the attributes that the native program gives, in the objects of the document.
import assert from 'node:assert/strict';
import {writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {ffd as run, packageFolder, runAll, sameBytes, source, test} from './tools.mjs';

// As the package finds it.
const found = createRequire(join(packageFolder, 'x')).resolve('@gltf-transform/core');
const {Document, NodeIO} = await import(pathToFileURL(found.replace(/index\.cjs$/, 'index.js')));
const {ffd} = await import(pathToFileURL(join(packageFolder, 'dist', 'gltf-transform.mjs')));
const LATTICE = {format: 'ffd-lattice', version: 1, size: [4, 4, 4], rest: {box: 'mesh'}, moves: [{twist: {axis: 'y', degrees: 70}}]};

const attributes = (document) => document.getRoot().listNodes().flatMap((node) => (node.getMesh()?.listPrimitives() ?? []).flatMap((primitive) =>
  [primitive, ...primitive.listTargets()].flatMap((owner) => owner.listSemantics().map((semantic) => [`${node.getName()} ${semantic}`, owner.getAttribute(semantic).getArray()]))));

test('a document gets the attributes of the file that the program writes', async (folder) => {
  const io = new NodeIO(), document = await io.readBinary(new Uint8Array(source('data/models/knight.glb')));
  const before = attributes(document), mesh = document.getRoot().listMeshes()[0];
  await io.write(join(folder, 'in.glb'), document);
  writeFileSync(join(folder, 'lattice.json'), JSON.stringify(LATTICE));
  run(folder, ['deform', 'in.glb', 'out.glb', '-l', 'lattice.json', '-q']);
  await document.transform(ffd({lattice: LATTICE}));
  const wanted = attributes(await io.read(join(folder, 'out.glb'))), got = attributes(document);
  assert.equal(got.length, wanted.length);
  got.forEach(([name, array], i) => sameBytes(array, wanted[i][1], name));
  assert.ok(got.some(([, array], i) => array.some((n, k) => n !== before[i][1][k])), 'it moved');
  assert.equal(document.getRoot().listMeshes()[0], mesh);
});

// Two nodes at different places with one mesh, and a third mesh with its positions.
function twins() {
  const document = new Document(), buffer = document.createBuffer();
  const position = document.createAccessor().setType('VEC3').setArray(Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0)).setBuffer(buffer);
  const mesh = document.createMesh().addPrimitive(document.createPrimitive().setAttribute('POSITION', position));
  const other = document.createMesh().addPrimitive(document.createPrimitive().setAttribute('POSITION', position));
  const nodes = [document.createNode('a').setMesh(mesh), document.createNode('b').setMesh(mesh).setTranslation([0, 3, 0]), document.createNode('c').setMesh(other)];
  document.createScene().addChild(nodes[0]).addChild(nodes[1]).addChild(nodes[2]);
  return document;
}

test('nodes that shared a mesh get their own where they differ', async (folder) => {
  const io = new NodeIO(), document = twins();
  await io.write(join(folder, 'in.glb'), document);
  writeFileSync(join(folder, 'lattice.json'), JSON.stringify(LATTICE));
  run(folder, ['deform', 'in.glb', 'out.glb', '-l', 'lattice.json', '-q', '--only', 'node:b']);
  await document.transform(ffd({lattice: LATTICE, only: ['node:b']}));
  const wanted = attributes(await io.read(join(folder, 'out.glb'))), got = attributes(document);
  got.forEach(([name, array], i) => sameBytes(array, wanted[i][1], name));
  const [a, b, c] = got.map(([, array]) => array.join());
  assert.ok(a !== b && a === c);
});

test('options for more than attributes are refused, and errors are those of the package', async () => {
  assert.throws(() => ffd({lattice: LATTICE, rig: 'follow'}), {name: 'FfdError', code: 2});
  await assert.rejects(twins().transform(ffd({lattice: LATTICE, only: ['node:none']})), {name: 'FfdError', code: 2, message: /no node is called "none"/});
});

await runAll();
