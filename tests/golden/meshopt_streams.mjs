// Writes streams of KHR_meshopt_compression, made by the newest meshoptimizer, with what its decoder makes of them.
//
//     node meshopt_streams.mjs NODE_FOLDER FILE SEED ROUNDS BYTES
//
// BYTES: of attributes in a stream, at most. tests/unit/meshopt_streams.bin is of 25 3 9000.
// FILE: for each stream the 32-bit numbers mode, filter, count, stride and size, the stream, and the decoded elements.

import { writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [folder, file, seed, rounds, most] = process.argv.slice(2);
const packaged = name => import(pathToFileURL(`${folder}/node_modules/meshoptimizer/${name}`));
const { MeshoptEncoder: encoder } = await packaged('meshopt_encoder.js');
const { MeshoptDecoder: decoder } = await packaged('meshopt_decoder.mjs');
await encoder.ready;
await decoder.ready;

const MODES = ['ATTRIBUTES', 'TRIANGLES', 'INDICES'];
const FILTERS = ['NONE', 'OCTAHEDRAL', 'QUATERNION', 'EXPONENTIAL', 'COLOR'];
const parts = [];
let state = Number(seed) >>> 0 || 1;

// xorshift
function draw(below) {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    state >>>= 0;
    return state % below;
}

function add(mode, filter, count, stride, stream) {
    const decoded = new Uint8Array(count * stride);
    decoder.decodeGltfBuffer(decoded, count, stride, stream, MODES[mode], FILTERS[filter]);
    parts.push(new Uint8Array(new Uint32Array([mode, filter, count, stride, stream.length]).buffer), stream, decoded);
}

function addElements(filter, elements, count, stride, version = 1) {
    const bytes = new Uint8Array(elements.buffer, elements.byteOffset, elements.byteLength);
    add(0, filter, count, stride, encoder.encodeVertexBufferLevel(bytes, count, stride, [0, 1, 2, 3, 3, 3][draw(6)], version));
}

// Columns that each channel's mode and each width of differences is for.
function column(view, offset, count, stride, kind) {
    let value = draw(1 << 16);
    const step = 1 + draw(400), base = draw(1000) / 7, shift = draw(24);
    for (let i = 0; i < count; i++) {
        const at = i * stride + offset;
        if (kind === 0)
            view.setUint32(at, draw(0x10000) << 16 | draw(0x10000), true);
        else if (kind === 1) {
            value += draw(step) - (step >> 1);
            view.setUint16(at, value & 0xffff, true);
            view.setUint16(at + 2, value * 3 & 0xffff, true);
        } else if (kind === 2)
            view.setFloat32(at, base + Math.sin(i / 40) * step, true);
        else if (kind === 3)
            view.setUint32(at, draw(3) ? 0 : draw(4) << 8 * draw(4), true);
        else if (kind === 4)
            view.setUint32(at, step * 12345, true);
        else if (kind === 5)
            view.setUint32(at, draw(200) << shift, true);
        else
            for (let b = 0; b < 4; b++)
                view.setUint8(at + b, (value += draw(2 + b * 8)) & 255);
    }
}

function attributes(version) {
    const stride = 4 * (draw(3) ? 1 + draw(8) : 1 + draw(64));
    const count = Math.min(draw(3) ? 1 + draw(80) : 1 + draw(700), Math.max(1, Math.floor(most / stride)));
    const elements = new Uint8Array(count * stride), view = new DataView(elements.buffer);
    for (let offset = 0; offset < stride; offset += 4)
        column(view, offset, count, stride, draw(7));
    addElements(0, elements, count, stride, version);
}

function units(count, dimensions) {
    const found = new Float32Array(4 * count);
    for (let i = 0; i < count; i++) {
        const v = [0, 1, 2, 3].map(c => c < dimensions ? draw(2001) / 1000 - 1 : 0);
        const length = Math.hypot(...v) || 1;
        for (let c = 0; c < 4; c++)
            found[4 * i + c] = v[c] / length;
    }
    return found;
}

function filtered() {
    const count = 1 + draw(100), stride = 4 + 4 * draw(2), most = 2 * stride;
    addElements(1, encoder.encodeFilterOct(units(count, 3), count, stride, 2 + draw(most - 1)), count, stride);
    addElements(2, encoder.encodeFilterQuat(units(count, 4), count, 8, 4 + draw(13)), count, 8);
    const width = 1 + draw(5), floats = Float32Array.from({ length: count * width }, () => (draw(20001) - 10000) / 77 * 2 ** (draw(9) - 4));
    const way = ['Separate', 'SharedVector', 'SharedComponent', 'Clamped'][draw(4)];
    addElements(3, encoder.encodeFilterExp(floats, count, 4 * width, 1 + draw(24), way), count, 4 * width);
    const colors = Float32Array.from({ length: 4 * count }, () => draw(1001) / 1000);
    addElements(4, encoder.encodeFilterColor(colors, count, stride, 2 + draw(most - 1)), count, stride);
}

function indices() {
    const count = 3 * (1 + draw(120)), stride = 2 + 2 * draw(2), far = stride === 2 ? 60000 : 3000000000;
    const list = stride === 2 ? new Uint16Array(count) : new Uint32Array(count);
    for (let i = 0; i < count; i++)
        list[i] = draw(30) ? Math.floor(i / 3) + i % 3 * (1 + draw(4)) : draw(far);
    const bytes = new Uint8Array(list.buffer);
    add(1, 0, count, stride, encoder.encodeGltfBuffer(bytes, count, stride, 'TRIANGLES'));
    add(2, 0, count, stride, encoder.encodeGltfBuffer(bytes, count, stride, 'INDICES'));
}

for (let round = 0; round < Number(rounds); round++) {
    attributes(1);
    attributes(1);
    attributes(0);
    filtered();
    indices();
}
writeFileSync(file, Buffer.concat(parts));
