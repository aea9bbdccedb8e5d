// The lattices that a model is deformed by, made from its bounds, each with its file.
//   twist   all of the model, every control point moved, the moved points given
//   bend    all of the model, degrees and knots mixed, as a move
//   part    some of the model, only inner control points moved, so that some vertices must keep their bits
//   shared  one box for all models, so that positions can be compared across files
//   still   all of the model, nothing moved
//   beside  none of the model, everything moved
import { add, length, scale, subtract } from './matrix.mjs';
import { Volume } from './volume.mjs';

const CLAMPED = ['clamped', 'clamped', 'clamped'];

function turn(p, axis, radians, about) {
    const [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
    const [c, s] = [Math.cos(radians), Math.sin(radians)];
    const q = [...p];
    q[a] = about[a] + c * (p[a] - about[a]) - s * (p[b] - about[b]);
    q[b] = about[b] + s * (p[a] - about[a]) + c * (p[b] - about[b]);
    return q;
}

const centre = (low, high) => scale(add(low, high), 0.5);
const longest = (low, high) => subtract(high, low).reduce((best, x, a, sides) => (x > sides[best] ? a : best), 0);

function twisted(axis, degrees) {
    return (points, { low, high }) => points.map((p) => {
        const f = (p[axis] - low[axis]) / (high[axis] - low[axis]);
        const middle = centre(low, high);
        const q = turn(p, axis, (degrees * f * Math.PI) / 180, middle);
        return q.map((x, a) => (a === axis ? x : middle[a] + (x - middle[a]) * (1 - 0.3 * f)));
    });
}

// The arc of "bend" (data/schema/lattice.md 8.3): lengths on the axis kept, the low end fixed.
function bent(axis, toward, degrees, about) {
    return (points) => {
        const along = points.map((p) => p[axis]);
        const low = Math.min(...along);
        const radius = (Math.max(...along) - low) / ((degrees * Math.PI) / 180);
        return points.map((p) => {
            const angle = (p[axis] - low) / radius;
            const t = p[toward] - about[toward];
            const q = [...p];
            q[axis] = low + (radius - t) * Math.sin(angle);
            q[toward] = about[toward] + radius - (radius - t) * Math.cos(angle);
            return q;
        });
    };
}

function pushed(by) {
    return (points, { size }) => points.map((p, n) => {
        const [i, j, k] = [n % size[0], Math.floor(n / size[0]) % size[1], Math.floor(n / (size[0] * size[1]))];
        return (i === 1 || i === 2) && j === 2 && (k === 1 || k === 2) ? add(p, by) : p;
    });
}

const unit = (axis) => [0, 1, 2].map((a) => (a === axis ? 1 : 0));

function bend(low, high) {
    const axis = longest(low, high);
    const toward = (axis + 1) % 3;
    const about = centre(low, high);
    const size = [3, 6, 4];
    const volume = new Volume({ size, degree: [2, 3, 3], knots: ['clamped', 'open', 'clamped'], low, high },
        bent(axis, toward, 40, about));
    return { volume, moves: [{ bend: { axis: unit(axis), toward: unit(toward), degrees: 40, about } }] };
}

function part(low, high) {
    const side = subtract(high, low);
    const from = low.map((x, a) => x + side[a] * [0.3117, -0.0231, 0.1373][a]);
    const to = low.map((x, a) => x + side[a] * [1.0471, 0.8391, 1.0193][a]);
    const by = scale(side, 0.05);
    const volume = new Volume({ size: [7, 5, 4], degree: [3, 3, 2], knots: CLAMPED, low: from, high: to }, pushed(by));
    return { volume, moves: [{ at: [[1, 2], 2, [1, 2]], by }] };
}

function beside({ low, high }) {
    const far = subtract(high, low).map((x) => 1000 * x);
    const volume = new Volume({ size: [2, 2, 2], degree: [1, 1, 1], knots: CLAMPED, low: add(low, far), high: add(high, far) },
        (points) => points);
    return { volume, moves: [{ by: [1, 1, 1] }] };
}

export function latticesOf({ low, high }) {
    // Room for flat models too.
    const room = 0.07 * (length(subtract(high, low)) || 1);
    const box = { low: low.map((x) => x - room), high: high.map((x) => x + room) };
    const cubic = { size: [4, 5, 4], degree: [3, 3, 3], knots: CLAMPED };
    return {
        twist: { volume: new Volume({ ...cubic, ...box }, twisted(longest(low, high), 70)) },
        bend: bend(box.low, box.high),
        part: part(box.low, box.high),
        shared: {
            volume: new Volume({ ...cubic, low: [-0.713, -0.617, -0.811], high: [0.931, 1.173, 0.877] }, twisted(1, 50)),
        },
        still: { volume: new Volume({ ...cubic, ...box }, (points) => points), moves: [] },
        beside: beside(box),
    };
}
