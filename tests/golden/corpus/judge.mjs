// Makes lattices for models and judges what the program made of the models, one request a line, one answer a line:
//   {"op": "open", "kind": "gltf"|"points", "file", "space", "folder"}   reads a model, writes FOLDER/NAME.json for
//                                                                         each lattice, answers their names
//   {"op": "judge", "lattice", "file"}      the model that is open, after that lattice
//   {"op": "across"}                        equal positions in different files, of all that went through "shared"
// "points" are files of lists that the caller has read: {"positions", "precision", "corners": [[vertex, normal]]}.
import { readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { fieldAt, normalAt, placementOf, tangentAt } from './expect.mjs';
import { latticesOf } from './lattices.mjs';
import * as matrix from './matrix.mjs';
import { readGltf } from './reader.mjs';
import { Groups, Tally } from './tally.mjs';

const STILL = placementOf(matrix.IDENTITY);
const across = new Groups();
let open = null;

// ---- placements -----------------------------------------------------------------------------------------------

// The matrix of each vertex of a primitive under a node.
function placementsOf(node, primitive, space) {
    if (space === 'scene' && node.joints && primitive.joints)
        return (v) => placementOf(matrix.blend(primitive.joints[v].map((joint) => node.joints[joint]), primitive.weights[v]));
    const placement = space === 'mesh' ? STILL : placementOf(node.world);
    return () => placement;
}

const partsOf = ({ meshes, nodes }) => nodes.flatMap((node, n) => (node.mesh === undefined ? []
    : meshes[node.mesh].map((primitive, p) => ({ node, primitive, name: `node ${n} primitive ${p}`, n, p }))));

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

function* placedPoints(model, space) {
    for (const { node, primitive } of partsOf(model)) {
        if (!deforms(node, space) || !primitive.POSITION) continue;
        const at = placementsOf(node, primitive, space);
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

const exact = (before, after, v) => ({ step: before.step, precision: 'float', kept: keptAs(before, after, v) });

function judgeValue(tally, kind, where, field, found, expected, { step, kept }, slack) {
    if (!field.moved) tally.kept(kind, where, found, kept);
    else tally.near(kind, where, found, expected, { step, slack });
}

function judgeBase(tally, where, v, field, before, after) {
    const { POSITION, NORMAL, TANGENT } = before;
    const p = POSITION.values[v];
    judgeValue(tally, 'position', where, field, after.POSITION.values[v], matrix.add(p, field.delta),
        exact(POSITION, after.POSITION, v), field.slack);
    const normal = NORMAL ? normalAt(field, NORMAL.values[v]) : null;
    if (NORMAL) judgeValue(tally, 'normal', where, field, after.NORMAL.values[v], normal, exact(NORMAL, after.NORMAL, v), 100);
    if (!TANGENT) return normal;
    const found = after.TANGENT.values[v];
    const expected = tangentAt(field, TANGENT.values[v], normal);
    if (expected) judgeValue(tally, 'tangent', where, field, found.slice(0, 3), expected.value,
        { step: TANGENT.step, kept: keptAs(TANGENT, after.TANGENT, v).slice(0, 3) }, expected.slack);
    else tally.skip('tangents along normals');
    tally.kept('handedness', where, found.slice(3), TANGENT.values[v].slice(3));
    return normal;
}

// A morph target: shape and offset deformed fully, less the deformed base.
function judgeTarget(tally, where, v, volume, base, { field, placement }, before, after) {
    const offset = (name) => before[name]?.values[v].slice(0, 3) ?? [0, 0, 0];
    const m = offset('POSITION');
    const there = matrix.largest(m) ? fieldAt(volume, placement, matrix.add(base.POSITION.values[v], m)) : field;
    if (there.border) return tally.skip('border');
    const either = { moved: field.moved || there.moved };
    const judge = (kind, name, expected, slack) => before[name] && judgeValue(tally, kind, where, either,
        after[name].values[v].slice(0, 3), expected, exact(before[name], after[name], v), slack);
    judge('morph position', 'POSITION', matrix.add(m, matrix.subtract(there.delta, field.delta)),
        field.slack + there.slack);
    if (!base.NORMAL) return;
    const n = base.NORMAL.values[v];
    const [now, then] = [normalAt(field, n), normalAt(there, matrix.add(n, offset('NORMAL')))];
    judge('morph normal', 'NORMAL', matrix.subtract(then, now), 200);
    if (!base.TANGENT) return;
    const t = base.TANGENT.values[v].slice(0, 3);
    const [old, shape] = [tangentAt(field, t, now), tangentAt(there, matrix.add(t, offset('TANGENT')), then)];
    if (old && shape) judge('morph tangent', 'TANGENT', matrix.subtract(shape.value, old.value), old.slack + shape.slack);
    else tally.skip('tangents along normals');
}

function judgePrimitive(context, part, after) {
    const { volume, tally, groups } = context;
    const { primitive: before, name } = part;
    const at = placementsOf(part.node, before, open.space);
    const keys = open.keys[name] ??= []; // as text, once for all lattices
    for (let v = 0; v < before.POSITION.values.length; v++) {
        const p = before.POSITION.values[v];
        const placement = at(v);
        const field = fieldAt(volume, placement, p);
        const found = after.POSITION.values[v];
        const key = keys[v] ??= `${placement.key} at ${p}`;
        groups.add(`${before.POSITION.step} ${key}`, found, `${name} vertex ${v}`);
        if (context.across && !before.POSITION.step)
            across.add(`float ${key}`, found, `${open.file} ${name} vertex ${v}`);
        if (field.border) {
            tally.skip('border');
            continue;
        }
        judgeBase(tally, `${name} vertex ${v}`, v, field, before, after);
        before.targets.forEach((target, t) => judgeTarget(tally, `${name} target ${t} vertex ${v}`, v, volume,
            before, { field, placement }, target, after.targets[t]));
    }
}

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

async function judgeGltf(context, file) {
    const after = await readGltf(file);
    for (const part of partsOf(open.model)) {
        const { node, primitive: before, name, n, p } = part;
        const now = after.meshes[after.nodes[n].mesh][p];
        before.rest.forEach((text, i) => text === now.rest[i] ||
            context.tally.fail(`${name}: ${text.split(' ')[0]} changed`));
        if (before.rest.length !== now.rest.length) context.tally.fail(`${name}: other attributes`);
        if (!before.POSITION) continue;
        if (deforms(node, open.space)) judgePrimitive(context, part, now);
        else if (!same([before.POSITION, before.NORMAL, before.TANGENT], [now.POSITION, now.NORMAL, now.TANGENT]))
            context.tally.fail(`${name}: not in the scene, and changed`);
    }
}

// ---- lists of points ------------------------------------------------------------------------------------------

async function judgePoints({ volume, tally, groups, across: remember }, file) {
    const after = JSON.parse(await readFile(file));
    const { positions, precision, corners } = open.model;
    const fields = positions.map((p) => fieldAt(volume, STILL, p));
    positions.forEach((p, v) => {
        const field = fields[v];
        const found = after.positions[v];
        groups.add(p.join(' '), found, `vertex ${v}`);
        if (remember) rememberPoint(p, found, precision, `${open.file} vertex ${v}`);
        if (field.border) tally.skip('border');
        else if (!field.moved) tally.kept('position', `vertex ${v}`, found, p);
        else tally.near('position', `vertex ${v}`, found, matrix.add(p, field.delta), { precision, slack: field.slack });
    });
    corners.forEach(([v, normal], c) => {
        const field = fields[v];
        const found = after.corners[c][1];
        if (field.border) return;
        if (!field.moved) tally.kept('normal', `corner ${c}`, found, normal);
        else tally.near('normal', `corner ${c}`, found, normalAt(field, normal), { precision, slack: 100 });
    });
}

// A double result, rounded once, is the float result of the same position.
function rememberPoint(p, found, precision, where) {
    const key = `${STILL.key} at ${p}`;
    if (precision === 'double') across.add(`double ${key}`, found, where);
    if (p.every((x) => Math.fround(x) === x)) across.add(`float ${key}`, found.map(Math.fround), where);
}

// ---- requests -------------------------------------------------------------------------------------------------

async function openModel({ kind, file, space, folder, name }) {
    const model = kind === 'gltf' ? await readGltf(file) : JSON.parse(await readFile(file));
    const lattices = latticesOf(boundsOf(kind === 'gltf' ? placedPoints(model, space) : model.positions));
    for (const [lattice, { volume, moves }] of Object.entries(lattices))
        await writeFile(path.join(folder, `${lattice}.json`), JSON.stringify(volume.file(moves)));
    open = { kind, file: name, space, model, lattices, keys: {} };
    return { lattices: Object.keys(lattices) };
}

async function judge({ lattice, file }) {
    const context = {
        volume: open.lattices[lattice].volume, tally: new Tally(), groups: new Groups(), across: lattice === 'shared',
    };
    await (open.kind === 'gltf' ? judgeGltf : judgePoints)(context, file);
    const { tally, groups } = context;
    return {
        count: tally.count, skipped: tally.skipped, worst: tally.worst, failed: tally.failed, failures: tally.failures,
        groups: { compared: groups.compared, failed: groups.failed, failures: groups.failures },
    };
}

const REQUESTS = {
    open: openModel, judge,
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
