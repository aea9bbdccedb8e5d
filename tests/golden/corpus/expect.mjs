// What a deformation must make of a vertex, by the formulas of the volume's mathematics: x = M p is carried to
// x + D(x), D = C_Q - C_P; only the displacement comes back, M_lin^-1 D. Normals go by the cofactor matrices of
// M_lin and of F = I + dD/dx, tangents by the matrices themselves.
import * as matrix from './matrix.mjs';

const PARALLEL = 1e-7;
const UNIT = matrix.IDENTITY.linear;

// A placement M with what is needed of it again and again. magnified: the most that M_lin^-1 makes of a length in one
// coordinate; reach: M_lin of absolute values; key: equal for equal placements.
export function placementOf({ linear, offset }) {
    const determinant = matrix.determinant(linear);
    const back = determinant === 0 ? null : matrix.inverse(linear);
    return { linear, offset, determinant, back, cofactor: matrix.cofactor(linear), transposed: matrix.transposed(linear),
        magnified: back ? Math.max(...back.map(matrix.length)) : 0, reach: linear.map((row) => row.map(Math.abs)), key: `${linear} ${offset}` };
}

// Half the distance from x to the next float away from 0.
const halfFloat = (x) => matrix.powerOf(Math.max(matrix.exponentOf(x), -126) - 24);

// How far the place that a file's number stands for may be from it: of floats that were made from steps, the more.
export function cellOf({ step, grid, precision }, p) {
    const half = (c) => Math.max(step || precision === 'double' ? step / 2 : halfFloat(p[c]), (grid?.[c] ?? 0) / 2);
    return [half(0), half(1), half(2)];
}

// The field at p, which stands for what is no farther than half along each axis, under the placement M. moved: false
// where all bits have to stay.
export function fieldAt(volume, placement, p, half) {
    const { back, magnified, reach } = placement;
    const x = matrix.apply(placement, p);
    const at = volume.at(x, matrix.times(reach, half));
    if (!back || !at.touched)
        return { moved: false, border: at.border, placement, slack: 0, delta: [0, 0, 0], gradient: UNIT };
    const size = matrix.largest(x) + matrix.largest(volume.low) + matrix.largest(volume.high);
    return {
        moved: true, border: at.border, placement, slack: size * magnified, delta: matrix.times(back, at.delta),
        gradient: [matrix.add(UNIT[0], at.gradient[0]), matrix.add(UNIT[1], at.gradient[1]),
            matrix.add(UNIT[2], at.gradient[2])],
    };
}

const normalized = (v, fallback) => (matrix.length(v) > 0 ? matrix.scale(v, 1 / matrix.length(v)) : fallback);

export function normalAt(field, normal) {
    if (!field.moved || matrix.length(normal) === 0) return normal;
    const { cofactor, transposed, determinant } = field.placement;
    const there = matrix.times(matrix.cofactor(field.gradient), matrix.times(cofactor, normal));
    return normalized(matrix.scale(matrix.times(transposed, there), Math.sign(determinant)), normal);
}

// normal: the deformed one in the mesh's own space, or null. There the tangent is made orthogonal to it. slack: what
// rounding is magnified by where the tangent lies almost along the normal; null where nothing is left of it.
export function tangentAt(field, tangent, normal) {
    const t = matrix.first(tangent);
    if (!field.moved || matrix.length(t) === 0) return { value: t, slack: 0 };
    const { linear, back } = field.placement;
    const carried = matrix.times(back, matrix.times(field.gradient, matrix.times(linear, t)));
    const left = normal ? matrix.subtract(carried, matrix.scale(normal, matrix.dot(carried, normal))) : carried;
    const share = matrix.length(left) / matrix.length(carried);
    return share > PARALLEL ? { value: normalized(left, t), slack: 100 / share } : null;
}
