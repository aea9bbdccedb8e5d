// The B-spline volume of a box lattice by its definitions, as slow and plain as they are: the recursion of Cox
// and de Boor, the sum over the control points, the derivative by the product rule. Control points stand at the
// Greville abscissae, so that u,v,w are affine in x,y,z.
import { subtract } from './matrix.mjs';

function knotVector(kind, n, d) {
    const inner = (i) => (i - d) / (n - d);
    return Array.from({ length: n + d + 1 }, (_, i) =>
        kind === 'open' ? inner(i) : Math.min(Math.max(inner(i), 0), 1));
}

const greville = (t, d, i) => t.slice(i + 1, i + d + 1).reduce((sum, knot) => sum + knot, 0) / d;

// The knot span of u; the end of the domain belongs to the last one.
function spanOf(t, n, d, u) {
    for (let s = n - 1; s > d; s--) if (u >= t[s] && t[s] < t[s + 1]) return s;
    return d;
}

const fraction = (a, b) => (b === 0 ? 0 : a / b);

// One step of the recursion: values[j] is the function of degree d - 1 that begins at the knot first + j, and becomes that
// of degree d.
function raise(t, first, d, u, values) {
    for (let j = 0; j < values.length - 1; j++) {
        const i = first + j;
        values[j] = fraction(u - t[i], t[i + d] - t[i]) * values[j] +
            fraction(t[i + d + 1] - u, t[i + d + 1] - t[i + 1]) * values[j + 1];
    }
}

const BORDER = 1e-9;

export class Volume {
    // move: control points -> moved control points, both with u fastest; spec.low, spec.high: the box.
    constructor(spec, move) {
        Object.assign(this, spec);
        this.t = this.knots.map((kind, a) => knotVector(kind, this.size[a], this.degree[a]));
        // Where at() works.
        this.u = [0, 0, 0];
        // Of the values the last is 0: the function beyond those that are not zero.
        this.functions = this.degree.map((d) => ({ value: new Float64Array(d + 2), derivative: new Float64Array(d + 1) }));
        this.points = [];
        for (let k = 0; k < this.size[2]; k++)
            for (let j = 0; j < this.size[1]; j++)
                for (let i = 0; i < this.size[0]; i++) this.points.push(this.#rest([i, j, k]));
        const moved = move(this.points, this);
        this.moves = Float64Array.from(this.points.flatMap((p, i) => subtract(moved[i], p)));
        this.moved = moved;
    }

    #rest(index) {
        return index.map((i, a) =>
            this.low[a] + greville(this.t[a], this.degree[a], i) * (this.high[a] - this.low[a]));
    }

    // The displacement C_Q - C_P at x and its derivative E (rows), so that F = I + E. half: how far from x the place
    // may be that it stands for, along each axis; beside the box by no more it is at the nearest point of the border.
    // touched: a moved control point has it in its support; border: whether it is beside by more cannot be told with
    // doubles.
    at(x, half) {
        const { low, high, u } = this;
        let near = false, reached = true, inside = true;
        for (let a = 0; a < 3; a++) {
            const side = high[a] - low[a], value = (x[a] - low[a]) / side, room = half[a] / side;
            const doubt = BORDER + 1e-6 * room;
            const beside = Math.max(-value, value - 1);
            near ||= Math.abs(beside - room) < doubt;
            reached &&= beside < room + doubt;
            inside &&= beside <= room;
            u[a] = Math.min(Math.max(value, 0), 1);
        }
        const border = near && reached;
        return inside ? this.#sum(border) : { border, inside, touched: false };
    }

    // The functions along a direction that are not zero at u: the first one's number; N_i and dN_i/dx of them all.
    #functions(a) {
        const t = this.t[a], d = this.degree[a], u = this.u[a];
        const span = spanOf(t, this.size[a], d, u);
        const { value, derivative } = this.functions[a];
        const first = span - d, side = this.high[a] - this.low[a];
        value.fill(0);
        value[d] = 1;
        for (let degree = 1; degree < d; degree++) raise(t, first, degree, u, value);
        for (let j = 0; j <= d; j++) {
            const i = first + j;
            derivative[j] = (fraction(d, t[i + d] - t[i]) * value[j] - fraction(d, t[i + d + 1] - t[i + 1]) * value[j + 1]) / side;
        }
        raise(t, first, d, u, value);
        return first;
    }

    // Written out, for this is where the time goes.
    #sum(border) {
        const { moves, size: [n0, n1], degree: [d0, d1, d2] } = this;
        const i0 = this.#functions(0), j0 = this.#functions(1), k0 = this.#functions(2);
        const [along, across, up] = this.functions;
        let x = 0, y = 0, z = 0, xu = 0, xv = 0, xw = 0, yu = 0, yv = 0, yw = 0, zu = 0, zv = 0, zw = 0;
        let touched = false;
        for (let k = 0; k <= d2; k++)
            for (let j = 0; j <= d1; j++)
                for (let i = 0; i <= d0; i++) {
                    const at = 3 * (i0 + i + n0 * (j0 + j + n1 * (k0 + k)));
                    const mx = moves[at], my = moves[at + 1], mz = moves[at + 2];
                    if (mx === 0 && my === 0 && mz === 0) continue;
                    touched = true;
                    const nu = along.value[i], nv = across.value[j], nw = up.value[k];
                    const n = nu * nv * nw;
                    const du = along.derivative[i] * nv * nw;
                    const dv = nu * across.derivative[j] * nw;
                    const dw = nu * nv * up.derivative[k];
                    x += n * mx;
                    y += n * my;
                    z += n * mz;
                    xu += du * mx;
                    xv += dv * mx;
                    xw += dw * mx;
                    yu += du * my;
                    yv += dv * my;
                    yw += dw * my;
                    zu += du * mz;
                    zv += dv * mz;
                    zw += dw * mz;
                }
        return { delta: [x, y, z], gradient: [[xu, xv, xw], [yu, yv, yw], [zu, zv, zw]], touched, border, inside: true };
    }

    // What a lattice file holds of it; moves: its "moves", or none to give the moved points themselves.
    file(moves) {
        return {
            format: 'ffd-lattice', version: 1, size: this.size, degree: this.degree, knots: this.knots,
            rest: { box: { min: this.low, max: this.high } },
            ...(moves ? { moves } : { deformed: { points: this.moved } }),
        };
    }
}
