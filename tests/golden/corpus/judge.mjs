// Makes lattices for models and judges what the program made of the models, one request a line, one answer a line:
//   {"op": "open", "kind": "gltf"|"points", "name", "file", "space", "folder"}   reads a model, once for all spaces, and
//                                              writes FOLDER/LATTICE.json for each lattice; answers their names
//   {"op": "judge", "name", "space", "lattice", "file"}      a model that is open, after that lattice
//   {"op": "close", "name"}                 the model is not needed any more
//   {"op": "across"}                        equal positions in different files, of all that went through "shared"
// Answers come in the order of the requests, however many are sent at once.
// "points" are lists that the caller has read, in doubles: a file of "count" positions, then for every place where a
// normal is used the vertex and the normal; "precision" tells how the model's file writes numbers.
import { readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { cellOf, fieldAt, normalAt, placementOf, tangentAt } from './expect.mjs';
import { latticesOf } from './lattices.mjs';
import * as matrix from './matrix.mjs';
import { readGltf } from './reader.mjs';
import { Groups, Numbers, Places, Tally } from './tally.mjs';

const STILL = placementOf(matrix.IDENTITY);
const across = new Groups();
// For all models: numbers of placements, and of positions under them as floats and as doubles.
const placements = new Numbers();
const inputs = new Places();
const FLOATS = 0, DOUBLES = 1;
// Name -> {model, NAME-OF-A-SPACE: what is known of it in that space}.
const opened = new Map();

// ---- placements -----------------------------------------------------------------------------------------------

// The matrix of each vertex of a primitive under a node.
function placementsOf(node, primitive, space) {
    if (space === 'scene' && node.joints && primitive.joints) {
        const found = [];
        return (v) => found[v] ??=
            placementOf(matrix.blend(primitive.joints[v].map((joint) => node.joints[joint]), primitive.weights[v]));
    }
    const placement = space === 'mesh' ? STILL : placementOf(node.world);
    return () => placement;
}

const numberOf = (placement) => placement.number ??= placements.of(placement.key);

// Every primitive under every node that shows it, in a space.
function partsOf({ meshes, nodes }, space) {
    return nodes.flatMap((node, n) => (node.mesh === undefined ? [] : meshes[node.mesh].map((primitive, p) => {
        const at = placementsOf(node, primitive, space);
        return { node, primitive, name: `node ${n} primitive ${p}`, n, p, at };
    })));
}

function boundsOf(points) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const point of points)
        for (let a = 0; a < 3; a++) {
            low[a] = Math.min(low[a], point[a]);
            high[a] = Math.max(high[a], point[a]);
        }
    return low[0] <= high[0] ? { low, high } : { low: [-1, -1, -1], high: [1, 1, 1] };
}

// In scene space what the default scene does not show is left alone.
const deforms = (node, space) => space === 'mesh' || node.shown;

function* placedPoints(parts, space) {
    for (const { node, primitive, at } of parts) {
        if (!deforms(node, space) || !primitive.POSITION) continue;
        for (let v = 0; v < primitive.POSITION.values.length; v++) {
            const p = primitive.POSITION.values[v];
            yield matrix.apply(at(v), p);
            for (const target of primitive.targets)
                if (target.POSITION) yield matrix.apply(at(v), matrix.add(p, target.POSITION.values[v]));
        }
    }
}

// ---- glTF -----------------------------------------------------------------------------------------------------

// Where bits have to stay: quantized values that became floats are rounded once.
const keptAs = (before, after, v) =>
    (before.step && !after.step ? before.values[v].map(Math.fround) : before.values[v]);

// found: of the vertex v of after.
function judgeValue(tally, kind, where, v, moved, found, expected, before, after, slack) {
    if (moved) tally.near(kind, where, v, found, expected, before.step, 'float', slack);
    else tally.kept(kind, where, v, found, keptAs(before, after, v));
}

function judgeBase(tally, where, v, field, before, after) {
    const { POSITION, NORMAL, TANGENT } = before;
    const { moved } = field;
    judgeValue(tally, 'position', where, v, moved, after.POSITION.values[v], matrix.add(POSITION.values[v], field.delta),
        POSITION, after.POSITION, field.slack);
    const normal = NORMAL ? normalAt(field, NORMAL.values[v]) : null;
    if (NORMAL) judgeValue(tally, 'normal', where, v, moved, after.NORMAL.values[v], normal, NORMAL, after.NORMAL, 100);
    if (!TANGENT) return;
    const found = after.TANGENT.values[v];
    const expected = tangentAt(field, TANGENT.values[v], normal);
    if (expected) judgeValue(tally, 'tangent', where, v, moved, matrix.first(found), expected.value, TANGENT, after.TANGENT,
        expected.slack);
    else tally.skip('tangents along normals');
    tally.kept('handedness', where, v, [found[3]], [TANGENT.values[v][3]]);
}

const NONE = [0, 0, 0];

// A morph target: shape and offset deformed fully, less the deformed base.
function judgeTarget(tally, where, v, volume, base, { field, placement }, before, after) {
    const offset = (name) => before[name]?.values[v] ?? NONE;
    const m = offset('POSITION');
    const p = base.POSITION.values[v];
    const there = matrix.largest(m) ? fieldAt(volume, placement, matrix.add(p, m),
        matrix.add(cellOf(base.POSITION, p), cellOf(before.POSITION, m))) : field;
    if (there.border) return tally.skip('border');
    const moved = field.moved || there.moved;
    const judge = (kind, name, expected, slack) => before[name] && judgeValue(tally, kind, where, v, moved,
        matrix.first(after[name].values[v]), expected, before[name], after[name], slack);
    judge('morph position', 'POSITION', matrix.add(m, matrix.subtract(there.delta, field.delta)),
        field.slack + there.slack);
    if (!base.NORMAL) return;
    const n = base.NORMAL.values[v];
    const [now, then] = [normalAt(field, n), normalAt(there, matrix.add(n, offset('NORMAL')))];
    judge('morph normal', 'NORMAL', matrix.subtract(then, now), 200);
    if (!base.TANGENT) return;
    const t = base.TANGENT.values[v];
    const [old, shape] = [tangentAt(field, t, now), tangentAt(there, matrix.add(t, offset('TANGENT')), then)];
    if (old && shape) judge('morph tangent', 'TANGENT', matrix.subtract(shape.value, old.value), old.slack + shape.slack);
    else tally.skip('tangents along normals');
}

function judgePrimitive({ open, volume, tally, groups, across: remember }, part, after) {
    const { primitive: before, name, at } = part;
    const { step, values } = before.POSITION;
    // Once for all lattices.
    part.numbers ??= values.map((p, v) => open.inputs.of(step, numberOf(at(v)), p));
    const vertex = `${name} vertex`, whole = `${open.name} ${vertex}`;
    const targets = before.targets.map((_, t) => `${name} target ${t} vertex`);
    for (let v = 0; v < values.length; v++) {
        const placement = at(v);
        const field = fieldAt(volume, placement, values[v], cellOf(before.POSITION, values[v]));
        const found = after.POSITION.values[v];
        groups.add(part.numbers[v], found, vertex, v);
        if (remember && !step) across.add(inputs.of(FLOATS, numberOf(placement), values[v]), found, whole, v);
        if (field.border) {
            tally.skip('border');
            continue;
        }
        judgeBase(tally, vertex, v, field, before, after);
        before.targets.forEach((target, t) => judgeTarget(tally, targets[t], v, volume, before, { field, placement },
            target, after.targets[t]));
    }
}

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

async function judgeGltf(context, file) {
    const { open } = context;
    const after = await readGltf(file);
    for (const part of open.parts) {
        const { node, primitive: before, name, n, p } = part;
        const now = after.meshes[after.nodes[n].mesh][p];
        before.rest.forEach(([what, bytes], i) => (what === now.rest[i]?.[0] && bytes.equals(now.rest[i][1])) ||
            context.tally.fail(`${name}: ${what} changed`));
        if (before.rest.length !== now.rest.length) context.tally.fail(`${name}: other attributes`);
        if (!before.POSITION) continue;
        if (deforms(node, open.space)) judgePrimitive(context, part, now);
        else if (!same([before.POSITION, before.NORMAL, before.TANGENT], [now.POSITION, now.NORMAL, now.TANGENT]))
            context.tally.fail(`${name}: not in the scene, and changed`);
    }
}

// ---- lists of points ------------------------------------------------------------------------------------------

async function readPoints({ file, count, precision }) {
    const bytes = await readFile(file);
    const numbers = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
    const vector = (at) => [numbers[at], numbers[at + 1], numbers[at + 2]];
    const positions = Array.from({ length: count }, (_, v) => vector(3 * v));
    const corners = [];
    for (let at = 3 * count; at < numbers.length; at += 4) corners.push([numbers[at], vector(at + 1)]);
    return { positions, corners, precision };
}

async function judgePoints({ open, volume, tally, groups, across: remember }, file, count) {
    const after = await readPoints({ file, count });
    const { positions, precision, corners } = open.model;
    if (after.positions.length !== positions.length || after.corners.length !== corners.length)
        return tally.fail('vertices or normals were added or lost');
    open.numbers ??= positions.map((p) => open.inputs.of(0, 0, p));
    const fields = positions.map((p) => fieldAt(volume, STILL, p, cellOf({ step: 0, precision }, p)));
    positions.forEach((p, v) => {
        const field = fields[v];
        const found = after.positions[v];
        groups.add(open.numbers[v], found, 'vertex', v);
        if (remember) rememberPoint(open.name, volume, p, field, found, precision, v);
        if (field.border) tally.skip('border');
        else if (!field.moved) tally.kept('position', 'vertex', v, found, p);
        else tally.near('position', 'vertex', v, found, matrix.add(p, field.delta), 0, precision, field.slack);
    });
    corners.forEach(([v, normal], c) => {
        const field = fields[v];
        const found = after.corners[c][1];
        if (field.border) return;
        if (!field.moved) tally.kept('normal', 'corner', c, found, normal);
        else tally.near('normal', 'corner', c, found, normalAt(field, normal), 0, precision, 100);
    });
}

const rounded = (p) => [Math.fround(p[0]), Math.fround(p[1]), Math.fround(p[2])];

// A double result, rounded once, is the float result of the same position, but where only a float's cell reaches the
// volume.
function rememberPoint(name, volume, p, field, found, precision, v) {
    const where = `${name} vertex`;
    if (precision === 'double') across.add(inputs.of(DOUBLES, numberOf(STILL), p), found, where, v);
    const isFloat = p.every((x) => Math.fround(x) === x);
    const reaches = () => precision === 'double' && !field.moved &&
        fieldAt(volume, STILL, p, cellOf({ step: 0 }, p)).moved;
    if (isFloat && !reaches()) across.add(inputs.of(FLOATS, numberOf(STILL), p), rounded(found), where, v);
}

// ---- requests -------------------------------------------------------------------------------------------------

async function openModel({ kind, name, file, count, precision, space, folder }) {
    if (!opened.has(name))
        opened.set(name, { model: kind === 'gltf' ? await readGltf(file) : await readPoints({ file, count, precision }) });
    const { model } = opened.get(name);
    const parts = kind === 'gltf' ? partsOf(model, space) : [];
    const lattices = latticesOf(boundsOf(kind === 'gltf' ? placedPoints(parts, space) : model.positions));
    for (const [lattice, { volume, moves }] of Object.entries(lattices))
        await writeFile(path.join(folder, `${lattice}.json`), JSON.stringify(volume.file(moves)));
    opened.get(name)[space] = { kind, name, space, model, parts, lattices, inputs: new Places() };
    return { lattices: Object.keys(lattices) };
}

async function judge({ name, space, lattice, file, count }) {
    const open = opened.get(name)[space];
    const context = {
        open, volume: open.lattices[lattice].volume, tally: new Tally(), groups: new Groups(), across: lattice === 'shared',
    };
    await (open.kind === 'gltf' ? judgeGltf : judgePoints)(context, file, count);
    const { tally, groups } = context;
    return {
        count: tally.count, skipped: tally.skipped, worst: tally.worst, failed: tally.failed, failures: tally.failures,
        groups: { compared: groups.compared, failed: groups.failed, failures: groups.failures },
    };
}

const REQUESTS = {
    open: openModel, judge, close: async ({ name }) => ({ closed: opened.delete(name) }),
    across: async () => ({ compared: across.compared, failed: across.failed, failures: across.failures }),
};

for await (const line of createInterface({ input: process.stdin })) {
    const request = JSON.parse(line);
    let answer;
    try {
        answer = await REQUESTS[request.op](request);
    } catch (problem) {
        answer = { problem: String(problem.stack) };
    }
    console.log(JSON.stringify(answer));
}
