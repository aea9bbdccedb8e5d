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

    // The displacement C_Q - C_P at x and its derivative E (rows), so that F = I + E. touched: a moved control
    // point has x in its support; border: x lies on the border of the box, as far as doubles can tell.
    at(x) {
        const side = subtract(this.high, this.low);
        const u = x.map((value, a) => (value - this.low[a]) / side[a]);
        const border = u.some((value) => Math.abs(value) < BORDER || Math.abs(value - 1) < BORDER) &&
            u.every((value) => value > -BORDER && value < 1 + BORDER);
        if (!u.every((value) => value >= 0 && value <= 1)) return { border, inside: false, touched: false };
        const functions = u.map((value, a) => this.#functions(a, value, side[a]));
        return { ...this.#sum(functions), border, inside: true };
    }

    // [i, N_i, dN_i/dx] of the functions along a direction that are not zero.
    #functions(a, u, side) {
        const [t, n, d] = [this.t[a], this.size[a], this.degree[a]];
        const span = spanOf(t, n, d, u);
        const found = [];
        for (let i = span - d; i <= span; i++) found.push([i, basis(t, i, d, u, span), slope(t, i, d, u, span) / side]);
        return found;
    }

    #sum([along, across, up]) {
        const delta = [0, 0, 0], gradient = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
        let touched = false;
        for (const [k, nw, dw] of up)
            for (const [j, nv, dv] of across)
                for (const [i, nu, du] of along) {
                    const move = this.moves[i + this.size[0] * (j + this.size[1] * k)];
                    if (move[0] === 0 && move[1] === 0 && move[2] === 0) continue;
                    touched = true;
                    for (let a = 0; a < 3; a++) {
                        delta[a] += nu * nv * nw * move[a];
                        gradient[a][0] += du * nv * nw * move[a];
                        gradient[a][1] += nu * dv * nw * move[a];
                        gradient[a][2] += nu * nv * dw * move[a];
                    }
                }
        return { delta, gradient, touched };
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
