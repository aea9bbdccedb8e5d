// Reads the geometry of a glTF file by glTF-Transform, any compression, and says how the default pose places it.
//     FFD_NODE names the folder whose node_modules holds the packages.
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import * as matrix from './matrix.mjs';

const packages = path.resolve(process.env.FFD_NODE ?? '.', 'node_modules');
const packaged = (file) => import(pathToFileURL(path.join(packages, file)));
// By their files: Node 18 cannot require() what are ES modules, and import() by name looks beside this script only.
const { NodeIO, Logger } = await packaged('@gltf-transform/core/dist/index.js');
const { ALL_EXTENSIONS } = await packaged('@gltf-transform/extensions/dist/index.js');
const { MeshoptDecoder } = await packaged('meshoptimizer/meshopt_decoder.mjs');
const draco = await createRequire(path.join(packages, 'x'))('draco3dgltf').createDecoderModule();

const io = new NodeIO().setLogger(new Logger(Logger.Verbosity.SILENT)).registerExtensions(ALL_EXTENSIONS)
    .registerDependencies({ 'draco3d.decoder': draco, 'meshopt.decoder': MeshoptDecoder });

const GEOMETRY = ['KHR_draco_mesh_compression', 'EXT_meshopt_compression', 'KHR_meshopt_compression',
    'KHR_mesh_quantization'];

// Of animations there are many.
function leaveOutAccessors(json) {
    const used = new Map();
    const renumber = (owner, key) => {
        const index = owner[key];
        if (index === undefined) return;
        if (!used.has(index)) used.set(index, used.size);
        owner[key] = used.get(index);
    };
    for (const mesh of json.meshes ?? [])
        for (const primitive of mesh.primitives) {
            renumber(primitive, 'indices');
            for (const attributes of [primitive.attributes, ...primitive.targets ?? []])
                for (const name of Object.keys(attributes)) renumber(attributes, name);
        }
    for (const skin of json.skins ?? []) renumber(skin, 'inverseBindMatrices');
    if (json.accessors) json.accessors = [...used.keys()].map((index) => json.accessors[index]);
}

// Everything that is not geometry leaves the JSON: pictures may be missing, extensions unknown.
function onlyGeometry(json) {
    const { images, textures, samplers, materials, animations, cameras, extensions, ...rest } = json;
    const kept = structuredClone(rest);
    kept.asset = { version: '2.0' };
    for (const key of ['extensionsUsed', 'extensionsRequired'])
        if (kept[key]) kept[key] = kept[key].filter((name) => GEOMETRY.includes(name));
    for (const node of kept.nodes ?? []) {
        delete node.extensions;
        delete node.camera;
    }
    for (const mesh of kept.meshes ?? [])
        for (const primitive of mesh.primitives) {
            delete primitive.material;
            for (const name of Object.keys(primitive.extensions ?? {}))
                if (!GEOMETRY.includes(name)) delete primitive.extensions[name];
        }
    leaveOutAccessors(kept);
    return kept;
}

const parsed = (bytes) => JSON.parse(new TextDecoder().decode(bytes));

// The chunks of a GLB: JSON, and BIN where there is one.
function chunksOf(bytes) {
    const size = bytes.readUInt32LE(12);
    const next = 20 + size;
    const json = parsed(bytes.subarray(20, next));
    if (next + 8 > bytes.length || bytes.readUInt32LE(next + 4) !== 0x004e4942) return { json, resources: {} };
    const bin = new Uint8Array(bytes.subarray(next + 8, next + 8 + bytes.readUInt32LE(next)));
    return { json, resources: { '@glb.bin': bin } };
}

async function load(file) {
    const bytes = await readFile(file);
    const binary = bytes[0] === 0x67; // "glTF"; JSON begins with a brace, a space or a byte order mark
    const { json, resources } = binary ? chunksOf(bytes) : { json: parsed(bytes), resources: {} };
    for (const { uri } of json.buffers ?? []) {
        if (!uri) continue;
        resources[uri] = uri.startsWith('data:')
            ? new Uint8Array(Buffer.from(uri.slice(uri.indexOf(',') + 1), 'base64'))
            : new Uint8Array(await readFile(path.join(path.dirname(file), decodeURIComponent(uri))));
    }
    return { json, resources };
}

const STEPS = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };

// Values as doubles, one array an element; step: the distance of two values where they are quantized, else 0.
function decoded(accessor) {
    if (!accessor) return null;
    const size = accessor.getElementSize();
    const values = [];
    for (let i = 0; i < accessor.getCount(); i++) values.push(accessor.getElement(i, new Array(size).fill(0)));
    const type = accessor.getComponentType();
    return { values, step: type === 5126 ? 0 : accessor.getNormalized() ? 1 / STEPS[type] : 1 };
}

const DEFORMED = ['POSITION', 'NORMAL', 'TANGENT'];

function streams(owner) {
    const found = {};
    for (const name of DEFORMED) found[name] = decoded(owner.getAttribute(name));
    return found;
}

// ---- what floats were made from -------------------------------------------------------------------------------

const bytesOf = (json, resources, { buffer, byteOffset = 0, byteLength }) =>
    resources[json.buffers[buffer].uri ?? '@glb.bin'].subarray(byteOffset, byteOffset + byteLength);

// The step of an attribute that Draco has quantized, with what floats lose on the way back; 0: it has not.
function dracoStep(bytes, id) {
    const decoder = new draco.Decoder(), mesh = new draco.Mesh(), transform = new draco.AttributeQuantizationTransform();
    decoder.SkipAttributeTransform(draco.POSITION);
    decoder.DecodeArrayToMesh(new Int8Array(bytes), bytes.length, mesh);
    let step = 0;
    if (transform.InitFromAttribute(decoder.GetAttributeByUniqueId(mesh, id))) {
        const range = transform.range(), ends = [0, 1, 2].map((c) => transform.min_value(c)).flatMap((x) => [x, x + range]);
        step = range / (2 ** transform.quantization_bits() - 1) + Math.max(...ends.map(Math.abs)) * 2 ** -21;
    }
    for (const used of [decoder, mesh, transform]) draco.destroy(used);
    return step;
}

// The filter EXPONENTIAL: the exponent is the highest byte of a number, the other three are a factor.
function exponentialSteps(json, resources, accessor) {
    const { extensions } = json.bufferViews[accessor.bufferView] ?? {};
    const packed = extensions?.EXT_meshopt_compression ?? extensions?.KHR_meshopt_compression;
    if (packed?.filter !== 'EXPONENTIAL' || accessor.sparse) return null;
    const { count, byteStride } = packed;
    const raw = new Uint8Array(count * byteStride);
    MeshoptDecoder.decodeVertexBuffer(raw, count, byteStride, bytesOf(json, resources, packed));
    const view = new DataView(raw.buffer), first = (accessor.byteOffset ?? 0) % byteStride;
    return [0, 4, 8].map((c) => {
        let least = 127;
        for (let at = first + c; at < raw.length; at += byteStride)
            if (view.getUint32(at, true) << 8) least = Math.min(least, view.getInt8(at + 3));
        return least === 127 ? 0 : 2 ** least;
    });
}

// Of the positions of a primitive, or of one of its targets: the steps along x, y, z.
function gridOf(json, resources, attributes, compressed) {
    const accessor = json.accessors?.[attributes?.POSITION];
    if (accessor?.componentType !== 5126) return null;
    const packed = compressed?.KHR_draco_mesh_compression;
    if (packed?.attributes.POSITION === undefined) return exponentialSteps(json, resources, accessor);
    const bytes = bytesOf(json, resources, json.bufferViews[packed.bufferView]);
    return new Array(3).fill(dracoStep(bytes, packed.attributes.POSITION));
}

function addGrids(meshes, json, resources) {
    meshes.forEach((primitives, m) => primitives.forEach((primitive, p) => {
        const { attributes, extensions, targets } = json.meshes[m].primitives[p];
        if (primitive.POSITION) primitive.POSITION.grid = gridOf(json, resources, attributes, extensions);
        primitive.targets.forEach((target, t) => {
            if (target.POSITION) target.POSITION.grid = gridOf(json, resources, targets[t]);
        });
    }));
}

// What must come through unchanged: mode, other attributes and indices, as names with bytes.
function rest(primitive) {
    const bytes = (accessor) => {
        const array = accessor?.getArray();
        return array ? Buffer.from(array.buffer, array.byteOffset, array.byteLength) : Buffer.alloc(0);
    };
    const names = primitive.listSemantics().filter((name) => !DEFORMED.includes(name)).sort();
    return [['mode', Buffer.from([primitive.getMode()])], ['indices', bytes(primitive.getIndices())],
        ...names.map((name) => [name, bytes(primitive.getAttribute(name))])];
}

// Elements of JOINTS_0, JOINTS_1 ... one after the other.
function influences(primitive, name) {
    const sets = [];
    for (let i = 0; primitive.getAttribute(`${name}_${i}`); i++)
        sets.push(decoded(primitive.getAttribute(`${name}_${i}`)).values);
    return sets.length ? sets[0].map((_, v) => sets.flatMap((set) => set[v])) : null;
}

const primitiveOf = (primitive) => ({
    ...streams(primitive),
    targets: primitive.listTargets().map(streams),
    joints: influences(primitive, 'JOINTS'),
    weights: influences(primitive, 'WEIGHTS'),
    rest: rest(primitive),
});

const localOf = (node) => (node.matrix ? matrix.fromColumns(node.matrix)
    : matrix.fromParts(node.translation, node.rotation, node.scale));

// World matrix of every node, and which nodes the default scene shows: the scene that is named, else the first;
// without scenes all root nodes.
function placed(json) {
    const nodes = json.nodes ?? [];
    const parent = new Map(nodes.flatMap((node, i) => (node.children ?? []).map((child) => [child, i])));
    const world = new Map();
    const worldOf = (i) => {
        if (!world.has(i))
            world.set(i, parent.has(i) ? matrix.after(worldOf(parent.get(i)), localOf(nodes[i])) : localOf(nodes[i]));
        return world.get(i);
    };
    const shown = new Set();
    const show = (i) => {
        shown.add(i);
        for (const child of nodes[i].children ?? []) show(child);
    };
    const roots = nodes.map((_, i) => i).filter((i) => !parent.has(i));
    for (const i of json.scenes ? json.scenes[json.scene ?? 0].nodes ?? [] : roots) show(i);
    return { world: nodes.map((_, i) => worldOf(i)), shown };
}

// {meshes: [[primitive]], nodes: [{mesh, world, shown, joints}]}; joints: matrices W_j B_j of the node's skin.
export async function readGltf(file) {
    const { json, resources } = await load(file);
    const document = await io.readJSON({ json: onlyGeometry(json), resources });
    const meshes = document.getRoot().listMeshes().map((mesh) => mesh.listPrimitives().map(primitiveOf));
    addGrids(meshes, json, resources);
    const skins = document.getRoot().listSkins().map((skin) => decoded(skin.getInverseBindMatrices())?.values);
    const { world, shown } = placed(json);
    const jointsOf = (skin) => json.skins[skin].joints.map((joint, i) =>
        (skins[skin] ? matrix.after(world[joint], matrix.fromColumns(skins[skin][i])) : world[joint]));
    const nodes = (json.nodes ?? []).map((node, i) => ({
        mesh: node.mesh, world: world[i], shown: shown.has(i),
        joints: node.skin === undefined ? null : jointsOf(node.skin),
    }));
    return { meshes, nodes };
}
