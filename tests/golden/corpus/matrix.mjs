// Small vectors and affine matrices in doubles. A vector is an array; an affine map is {linear, offset}, linear
// as three rows.

export const IDENTITY = { linear: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], offset: [0, 0, 0] };

export const add = (a, b) => a.map((x, i) => x + b[i]);
export const subtract = (a, b) => a.map((x, i) => x - b[i]);
export const scale = (a, s) => a.map((x) => x * s);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const length = (a) => Math.sqrt(dot(a, a));
export const largest = (a) => Math.max(...a.map(Math.abs));
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const same = (a, b) => a.every((x, i) => x === b[i]);

export const times = (rows, v) => rows.map((row) => dot(row, v));
export const transposed = (rows) => rows[0].map((_, i) => rows.map((row) => row[i]));
export const product = (a, b) => a.map((row) => transposed(b).map((column) => dot(row, column)));
export const determinant = (rows) => dot(rows[0], cross(rows[1], rows[2]));
// Rows of the cofactor matrix are the cross products of the matrix's rows.
export const cofactor = (r) => [cross(r[1], r[2]), cross(r[2], r[0]), cross(r[0], r[1])];
export const inverse = (rows) => transposed(cofactor(rows)).map((row) => scale(row, 1 / determinant(rows)));

export const apply = (map, p) => add(times(map.linear, p), map.offset);
export const after = (outer, inner) => ({
    linear: product(outer.linear, inner.linear),
    offset: apply(outer, inner.offset),
});

// sum w_i M_i / sum w_i: the weights of a file add up to 1 but for rounding, and the last row of a matrix is 0 0 0 1.
export function blend(maps, weights) {
    const whole = weights.reduce((total, weight) => total + weight, 0) || 1;
    const sum = (pick) =>
        scale(maps.reduce((total, map, i) => add(total, scale(pick(map), weights[i])), [0, 0, 0]), 1 / whole);
    return { linear: [0, 1, 2].map((row) => sum((map) => map.linear[row])), offset: sum((map) => map.offset) };
}

// glTF stores 4x4 matrices by columns.
export const fromColumns = (m) => ({
    linear: [0, 1, 2].map((row) => [m[row], m[4 + row], m[8 + row]]),
    offset: [m[12], m[13], m[14]],
});

export function fromParts(translation = [0, 0, 0], [x, y, z, w] = [0, 0, 0, 1], factors = [1, 1, 1]) {
    const rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ];
    return { linear: rotation.map((row) => row.map((value, i) => value * factors[i])), offset: translation };
}
