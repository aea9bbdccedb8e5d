// Small vectors and affine matrices in doubles. A vector is an array of three; an affine map is {linear, offset}, linear
// as three rows. Written out, for each is called some hundred million times.

export const IDENTITY = { linear: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], offset: [0, 0, 0] };

// The first three of more.
export const first = (a) => [a[0], a[1], a[2]];
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.sqrt(dot(a, a));
export const largest = (a) => Math.max(Math.abs(a[0]), Math.abs(a[1]), Math.abs(a[2]));
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

export const times = (rows, v) => [dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)];
export const transposed = ([a, b, c]) => [[a[0], b[0], c[0]], [a[1], b[1], c[1]], [a[2], b[2], c[2]]];
export function product(a, b) {
    const columns = transposed(b);
    return [times(columns, a[0]), times(columns, a[1]), times(columns, a[2])];
}
export const determinant = (rows) => dot(rows[0], cross(rows[1], rows[2]));
// Rows of the cofactor matrix are the cross products of the matrix's rows.
export const cofactor = (r) => [cross(r[1], r[2]), cross(r[2], r[0]), cross(r[0], r[1])];
export function inverse(rows) {
    const [a, b, c] = transposed(cofactor(rows));
    const factor = 1 / determinant(rows);
    return [scale(a, factor), scale(b, factor), scale(c, factor)];
}

export const apply = (map, p) => add(times(map.linear, p), map.offset);
export const after = (outer, inner) => ({
    linear: product(outer.linear, inner.linear),
    offset: apply(outer, inner.offset),
});

// sum w_i M_i / sum w_i: the weights of a file add up to 1 but for rounding, and the last row of a matrix is 0 0 0 1.
export function blend(maps, weights) {
    const sums = new Array(12).fill(0);
    let whole = 0;
    maps.forEach(({ linear, offset }, i) => {
        const weight = weights[i];
        whole += weight;
        if (weight === 0) return;
        for (let a = 0; a < 3; a++) {
            for (let row = 0; row < 3; row++) sums[3 * row + a] += linear[row][a] * weight;
            sums[9 + a] += offset[a] * weight;
        }
    });
    const vector = (first) => scale(sums.slice(first, first + 3), 1 / (whole || 1));
    return { linear: [vector(0), vector(3), vector(6)], offset: vector(9) };
}

const double = new Float64Array(1), halves = new Uint32Array(double.buffer);

// The exponent of a double that is normal, floor(log2 |x|); that of all others is the least.
export function exponentOf(x) {
    double[0] = x;
    return ((halves[1] >>> 20) & 0x7ff) - 1023;
}

// 2^exponent, which is normal.
export function powerOf(exponent) {
    halves[0] = 0;
    halves[1] = (exponent + 1023) << 20;
    return double[0];
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
