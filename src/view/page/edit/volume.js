// volume.js - the lattice that is edited, and where it takes points: p + sum R_j(u,v,w) D_j (src/maths.md 7.1). All in
// doubles and in the file's units.

const MOST_ORDER = 15;
// Weights that differ from those at rest by one factor, to this share, are not moved.
const SAME_WEIGHTS = 4 * Number.EPSILON;

class Volume {
  constructor({size, degree, knots, rest, weights, deformedWeights}) {
    this.size = size;
    this.directions = [0, 1, 2].map((a) => new Direction(degree[a], knots[a], size[a]));
    this.count = size[0] * size[1] * size[2];
    this.rest = rest;
    this.weights = weights;
    this.goal = deformedWeights;
    this.origin = [0, 1, 2].map((a) => (rest[a] + rest[3 * this.count - 3 + a]) / 2);
    this.offsets = new Float64Array(3 * this.count);
    this.deformed = weights ? weights.slice() : null;
    this.strength = 1;
    const array = () => new Float64Array(MOST_ORDER);
    this.values = [array(), array(), array()];
    this.turns = [array(), array(), array()];
    this.lower = array();
    this.spans = [0, 0, 0];
    this.columns = [new Int32Array(MOST_ORDER), new Int32Array(MOST_ORDER), new Int32Array(MOST_ORDER)];
    this.setStrength(1);
  }

  // Deformed weights are (1 - s) times those at rest and s times those of the file.
  setStrength(share) {
    this.strength = share;
    const {weights, goal, deformed} = this;
    this.hasMovedWeights = false;
    if (!weights) return;
    for (let j = 0; j < this.count; j++) deformed[j] = (1 - share) * weights[j] + share * (goal ? goal[j] : weights[j]);
    for (let j = 1; j < this.count && !this.hasMovedWeights; j++) {
      const a = deformed[j] * weights[0], b = weights[j] * deformed[0];
      this.hasMovedWeights = Math.abs(a - b) > SAME_WEIGHTS * Math.abs(b);
    }
  }

  // The spans of a place, the functions there, and their control points along each direction.
  locate(u, v, w) {
    const at = [u, v, w];
    for (let a = 0; a < 3; a++) {
      const direction = this.directions[a], span = direction.span(at[a]), columns = this.columns[a];
      this.spans[a] = span;
      direction.basis(span, at[a], this.values[a]);
      for (let k = 0; k <= direction.degree; k++) columns[k] = direction.pointOf(span - direction.degree + k);
    }
  }

  // Calls visit(j, N_j) for the control points that act at a place.
  visit(u, v, w, visit) {
    this.locate(u, v, w);
    const [du, dv, dw] = this.directions.map((direction) => direction.degree), [nu, nv] = this.size;
    for (let c = 0; c <= dw; c++) {
      for (let b = 0; b <= dv; b++) {
        const row = nu * (this.columns[1][b] + nv * this.columns[2][c]), share = this.values[1][b] * this.values[2][c];
        for (let a = 0; a <= du; a++) visit(row + this.columns[0][a], share * this.values[0][a]);
      }
    }
  }

  // Sets out[at..] to the displacement at a place.
  displace(u, v, w, out, at) {
    this.locate(u, v, w);
    if (this.weights) this.displaceWeighted(out, at);
    else this.displacePlain(out, at);
  }

  displacePlain(out, at) {
    const [Nu, Nv, Nw] = this.values, [cu, cv, cw] = this.columns, {offsets: D, directions, strength} = this;
    const du = directions[0].degree, dv = directions[1].degree, dw = directions[2].degree, nu = this.size[0], nv = this.size[1];
    let x = 0, y = 0, z = 0;
    for (let c = 0; c <= dw; c++) {
      for (let b = 0; b <= dv; b++) {
        const row = nu * (cv[b] + nv * cw[c]), share = Nv[b] * Nw[c];
        let p = 0, q = 0, r = 0;
        for (let a = 0; a <= du; a++) {
          const j = 3 * (row + cu[a]), value = Nu[a];
          p += value * D[j];
          q += value * D[j + 1];
          r += value * D[j + 2];
        }
        x += share * p;
        y += share * q;
        z += share * r;
      }
    }
    out[at] = strength * x;
    out[at + 1] = strength * y;
    out[at + 2] = strength * z;
  }

  // With weights: sum N q D / sum N q; and where weights are moved, what they do to the points at rest.
  displaceWeighted(out, at) {
    const {values, columns, offsets: D, rest: P, weights: h, deformed: q, origin, directions, strength, size} = this;
    let bottom = 0, restBottom = 0;
    const sum = [0, 0, 0], moved = [0, 0, 0], still = [0, 0, 0];
    for (let c = 0; c <= directions[2].degree; c++) {
      for (let b = 0; b <= directions[1].degree; b++) {
        const row = size[0] * (columns[1][b] + size[1] * columns[2][c]), share = values[1][b] * values[2][c];
        for (let a = 0; a <= directions[0].degree; a++) {
          const j = row + columns[0][a], value = share * values[0][a], of = value * q[j], ofRest = value * h[j];
          bottom += of;
          restBottom += ofRest;
          for (let k = 0; k < 3; k++) {
            sum[k] += of * D[3 * j + k];
            moved[k] += of * (P[3 * j + k] - origin[k]);
            still[k] += ofRest * (P[3 * j + k] - origin[k]);
          }
        }
      }
    }
    for (let k = 0; k < 3; k++) {
      out[at + k] = strength * sum[k] / bottom + (this.hasMovedWeights ? moved[k] / bottom - still[k] / restBottom : 0);
    }
  }

  // Whether a control point that acts at a place is moved.
  isMovedAt(u, v, w) {
    let is = false;
    this.visit(u, v, w, (j, value) => {
      const D = this.offsets;
      is = is || (value !== 0 && (this.hasMovedWeights || D[3 * j] !== 0 || D[3 * j + 1] !== 0 || D[3 * j + 2] !== 0));
    });
    return is && (this.strength !== 0 || this.hasMovedWeights);
  }

  // The derivatives by u, v, w at a place: of the displacement (E), and of the volume at rest (J), row by row.
  gradients(u, v, w, E, J) {
    const at = [u, v, w], {values, turns, columns, directions, size, weights: h, deformed: q, rest: P, offsets: D, origin, strength} = this;
    this.locate(u, v, w);
    for (let a = 0; a < 3; a++) directions[a].slopes(this.spans[a], at[a], this.lower, turns[a]);
    // Of sums N h (P - o), N h, N q (P - o), N q D, N q: the value and three derivatives.
    const top = new Float64Array(12), bottom = new Float64Array(4), moved = new Float64Array(12), dragged = new Float64Array(12), below = new Float64Array(4);
    const N = [0, 0, 0, 0];
    for (let c = 0; c <= directions[2].degree; c++) {
      for (let b = 0; b <= directions[1].degree; b++) {
        const row = size[0] * (columns[1][b] + size[1] * columns[2][c]);
        for (let a = 0; a <= directions[0].degree; a++) {
          const j = row + columns[0][a], x = values[0][a], y = values[1][b], z = values[2][c];
          N[0] = x * y * z;
          N[1] = turns[0][a] * y * z;
          N[2] = x * turns[1][b] * z;
          N[3] = x * y * turns[2][c];
          const rested = h ? h[j] : 1, acting = q ? q[j] : 1;
          for (let d = 0; d < 4; d++) {
            const of = N[d] * rested, by = N[d] * acting;
            bottom[d] += of;
            below[d] += by;
            for (let k = 0; k < 3; k++) {
              const p = P[3 * j + k] - origin[k];
              top[3 * d + k] += of * p;
              moved[3 * d + k] += by * p;
              dragged[3 * d + k] += by * strength * D[3 * j + k];
            }
          }
        }
      }
    }
    // Quotients: (A / W)' = (A' - (A / W) W') / W.
    const slope = (sums, weights, d, k) => (weights[0] === 0 ? 0 : (sums[3 * d + k] - sums[k] / weights[0] * weights[d]) / weights[0]);
    for (let k = 0; k < 3; k++) {
      for (let d = 1; d < 4; d++) {
        const rested = slope(top, bottom, d, k);
        J[3 * k + d - 1] = rested;
        E[3 * k + d - 1] = slope(dragged, below, d, k) + (this.hasMovedWeights ? slope(moved, below, d, k) - rested : 0);
      }
    }
  }
}

function determinant(m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

function multiply(a, b, out) {
  for (let r = 0; r < 3; r++) {
    for (let c = 0; c < 3; c++) out[3 * r + c] = a[3 * r] * b[c] + a[3 * r + 1] * b[3 + c] + a[3 * r + 2] * b[6 + c];
  }
}

// Returns false where a matrix has no inverse.
function invert(m, out) {
  const det = determinant(m), [a, b, c, d, e, f, g, h, k] = m;
  if (!(Math.abs(det) > 0) || !Number.isFinite(1 / det)) return false;
  const cofactors = [e * k - f * h, c * h - b * k, b * f - c * e, f * g - d * k, a * k - c * g, c * d - a * f, d * h - e * g, b * g - a * h, a * e - b * d];
  cofactors.forEach((x, i) => { out[i] = x / det; });
  return true;
}
