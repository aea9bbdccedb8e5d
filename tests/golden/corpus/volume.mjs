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

function basis(t, i, d, u, span) {
    if (d === 0) return i === span ? 1 : 0;
    return fraction(u - t[i], t[i + d] - t[i]) * basis(t, i, d - 1, u, span) +
        fraction(t[i + d + 1] - u, t[i + d + 1] - t[i + 1]) * basis(t, i + 1, d - 1, u, span);
}

const slope = (t, i, d, u, span) =>
    fraction(d, t[i + d] - t[i]) * basis(t, i, d - 1, u, span) -
    fraction(d, t[i + d + 1] - t[i + 1]) * basis(t, i + 1, d - 1, u, span);

const BORDER = 1e-9;

export class Volume {
    // move: control points -> moved control points, both with u fastest; spec.low, spec.high: the box.
    constructor(spec, move) {
        Object.assign(this, spec);
        this.t = this.knots.map((kind, a) => knotVector(kind, this.size[a], this.degree[a]));
        // Where at() works.
        this.u = [0, 0, 0];
        this.functions = this.degree.map((d) => ({ value: new Float64Array(d + 1), derivative: new Float64Array(d + 1) }));
        this.points = [];
        for (let k = 0; k < this.size[2]; k++)
            for (let j = 0; j < this.size[1]; j++)
                for (let i = 0; i < this.size[0]; i++) this.points.push(this.#rest([i, j, k]));
        const moved = move(this.points, this);
        this.moves = this.points.map((p, i) => subtract(moved[i], p));
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
        for (let i = 0; i <= d; i++) {
            value[i] = basis(t, span - d + i, d, u, span);
            derivative[i] = slope(t, span - d + i, d, u, span) / (this.high[a] - this.low[a]);
        }
        return span - d;
    }

    #sum(border) {
        const i0 = this.#functions(0), j0 = this.#functions(1), k0 = this.#functions(2);
        const [along, across, up] = this.functions;
        const delta = [0, 0, 0], gradient = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
        let touched = false;
        for (let k = 0; k <= this.degree[2]; k++)
            for (let j = 0; j <= this.degree[1]; j++)
                for (let i = 0; i <= this.degree[0]; i++) {
                    const move = this.moves[i0 + i + this.size[0] * (j0 + j + this.size[1] * (k0 + k))];
                    if (move[0] === 0 && move[1] === 0 && move[2] === 0) continue;
                    touched = true;
                    const nu = along.value[i], nv = across.value[j], nw = up.value[k];
                    const n = nu * nv * nw;
                    const du = along.derivative[i] * nv * nw;
                    const dv = nu * across.derivative[j] * nw;
                    const dw = nu * nv * up.derivative[k];
                    for (let a = 0; a < 3; a++) {
                        delta[a] += n * move[a];
                        gradient[a][0] += du * move[a];
                        gradient[a][1] += dv * move[a];
                        gradient[a][2] += dw * move[a];
                    }
                }
        return { delta, gradient, touched, border, inside: true };
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
