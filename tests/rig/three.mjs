// The vertices of glTF files as three.js shows them, in node without a browser.
//     node three.mjs FOLDER-WITH-NODE_MODULES < JOBS
// A job is a line of JSON: {"path": a .glb or .gltf, "poses": [[animation or null, time], ...], "step": N}. The answer is a
// line too: for each pose, for each node in the file's order that shows a mesh, for each primitive, every N-th vertex's
// place in the world.
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';

const from = (name) => import(pathToFileURL(path.resolve(process.argv[2], 'node_modules/three', name)));
globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const THREE = await from('build/three.module.js');
const { GLTFLoader } = await from('examples/jsm/loaders/GLTFLoader.js');
const { MeshoptDecoder } = await from('examples/jsm/libs/meshopt_decoder.module.js');

async function bytesOf(uri, base) {
    const data = uri.startsWith('data:')
        ? Buffer.from(uri.slice(uri.indexOf(',') + 1), 'base64')
        : await readFile(path.join(base, decodeURIComponent(uri)));
    return data;
}

function chunksOf(file) {
    if (file.toString('latin1', 0, 4) !== 'glTF') return [file, null];
    const size = file.readUInt32LE(12);
    const rest = file.subarray(20 + size);
    return [file.subarray(20, 20 + size), rest.length > 8 ? rest.subarray(8) : null];
}

// One text with its buffers inside, and without materials: images need a browser.
async function plain(name) {
    const [text, chunk] = chunksOf(await readFile(name));
    const asset = JSON.parse(text.toString('utf8').replace(/^\uFEFF/, ''));
    for (const [i, buffer] of (asset.buffers ?? []).entries()) {
        if (buffer.uri === undefined && (i > 0 || !chunk)) continue; // what a compression replaces
        const data = buffer.uri === undefined ? chunk : await bytesOf(buffer.uri, path.dirname(name));
        buffer.uri = `data:application/octet-stream;base64,${data.toString('base64')}`;
    }
    for (const key of ['materials', 'textures', 'images', 'samplers']) delete asset[key];
    for (const mesh of asset.meshes ?? []) for (const primitive of mesh.primitives) delete primitive.material;
    return JSON.stringify(asset);
}

function parse(text) {
    return new Promise((resolve, reject) => new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).parse(text, '', resolve, reject));
}

// Meshes by the node and the primitive of the file that they come from.
function meshesOf(gltf) {
    const found = [];
    gltf.scene.traverse((object) => {
        if (!object.isMesh && !object.isPoints && !object.isLine) return;
        const { primitives } = gltf.parser.associations.get(object);
        let holder = object;
        while (gltf.parser.associations.get(holder)?.nodes === undefined) holder = holder.parent;
        found.push([gltf.parser.associations.get(holder).nodes, primitives, object]);
    });
    return found.sort((a, b) => a[0] - b[0] || a[1] - b[1]).map((one) => one[2]);
}

function placesOf(mesh, step) {
    const { count } = mesh.geometry.attributes.position;
    const at = new THREE.Vector3();
    const places = [];
    for (let i = 0; i < count; i += step) {
        if (mesh.isMesh) mesh.getVertexPosition(i, at);
        else at.fromBufferAttribute(mesh.geometry.attributes.position, i);
        places.push(at.applyMatrix4(mesh.matrixWorld).toArray());
    }
    return places;
}

function pose(gltf, mixer, animation, time, meshes, step) {
    mixer.stopAllAction(); // what it has set is as it was again
    if (animation !== null) {
        const action = mixer.clipAction(gltf.animations[animation]);
        action.setLoop(THREE.LoopOnce);
        action.clampWhenFinished = true;
        action.play();
        action.time = time;
        mixer.update(0);
    }
    gltf.scene.updateMatrixWorld(true);
    return meshes.map((mesh) => placesOf(mesh, step));
}

for await (const line of createInterface({ input: process.stdin })) {
    const job = JSON.parse(line);
    const gltf = await parse(await plain(job.path));
    const mixer = new THREE.AnimationMixer(gltf.scene);
    const meshes = meshesOf(gltf);
    console.log(JSON.stringify(job.poses.map(([animation, time]) => pose(gltf, mixer, animation, time, meshes, job.step ?? 1))));
}
