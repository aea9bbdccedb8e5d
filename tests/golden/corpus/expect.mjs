// What a deformation must make of a vertex, by the formulas of the volume's mathematics: x = M p is carried to
// x + D(x), D = C_Q - C_P; only the displacement comes back, M_lin^-1 D. Normals go by the cofactor matrices of
// M_lin and of F = I + dD/dx, tangents by the matrices themselves.
import * as matrix from './matrix.mjs';

const PARALLEL = 1e-7;
const UNIT = matrix.IDENTITY.linear;

// A placement M with what is needed of it again and again. key: equal for equal placements.
export function placementOf({ linear, offset }) {
    const determinant = matrix.determinant(linear);
    return { linear, offset, determinant, cofactor: matrix.cofactor(linear), transposed: matrix.transposed(linear),
        back: determinant === 0 ? null : matrix.inverse(linear), key: `${linear} ${offset}` };
}

// The field at p under the placement M. moved: false where all bits have to stay.
export function fieldAt(volume, placement, p) {
    const { back } = placement;
    const x = matrix.apply(placement, p);
    const at = volume.at(x);
    if (!back || !at.touched) return { moved: false, border: at.border, delta: [0, 0, 0], gradient: UNIT, slack: 0 };
    const size = matrix.largest(x) + matrix.largest(volume.low) + matrix.largest(volume.high);
    return {
        moved: true, border: at.border, placement, slack: size * Math.max(...back.map(matrix.length)),
        delta: matrix.times(back, at.delta),
        gradient: UNIT.map((row, i) => matrix.add(row, at.gradient[i])),
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
    const t = tangent.slice(0, 3);
    if (!field.moved || matrix.length(t) === 0) return { value: t, slack: 0 };
    const { linear, back } = field.placement;
    const carried = matrix.times(back, matrix.times(field.gradient, matrix.times(linear, t)));
    const left = normal ? matrix.subtract(carried, matrix.scale(normal, matrix.dot(carried, normal))) : carried;
    const share = matrix.length(left) / matrix.length(carried);
    return share > PARALLEL ? { value: normalized(left, t), slack: 100 / share } : null;
}
