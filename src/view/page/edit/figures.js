// figures.js - what the report of ffd deform would say of the shape shown: flipped faces, torn edges, det F, moved vertices
// (src/maths.md 7 and 11).

const TORN = 1e-3;  // of an edge's length at rest
const STEPS = 1024;  // between two looks at the clock
const FLAT = 64 * Number.EPSILON;

// Ids of places: vertices with equal coordinates at rest have one.
function placesOf(rest) {
  const bits = new Uint32Array(rest.slice().map((x) => x + 0).buffer), count = rest.length / 3;
  let size = 16;
  while (size < 2 * count) size *= 2;
  const table = new Int32Array(size).fill(-1), ids = new Uint32Array(count);
  const differ = (v, w) => {
    for (let k = 0; k < 6; k++) if (bits[6 * v + k] !== bits[6 * w + k]) return true;
    return false;
  };
  for (let v = 0; v < count; v++) {
    let hash = 0;
    for (let k = 0; k < 6; k++) hash = Math.imul(hash ^ bits[6 * v + k], 0x9e3779b1) ^ (hash >>> 13);
    let at = (hash ^ (hash >>> 15)) & (size - 1);
    while (table[at] >= 0 && differ(table[at], v)) at = (at + 1) & (size - 1);
    if (table[at] < 0) table[at] = v;
    ids[v] = table[at];
  }
  return ids;
}

class Figures {
  constructor(shown) {
    this.shown = shown;
    this.dets = new Float32Array(shown.scene.vertices).fill(1);
    this.flags = new Uint8Array(shown.scene.triangles);
    this.edges = null;
    this.torn = [];
    this.clear();
  }

  // The shape has changed.
  clear() {
    this.run = null;
    this.found = null;
  }

  // Goes on for so many milliseconds. Returns whether all is known.
  work(milliseconds) {
    if (this.found) return true;
    this.run = this.run || this.find();
    const end = performance.now() + milliseconds;
    do {
      if (this.run.next().done) {
        this.run = null;
        return true;
      }
    } while (performance.now() < end);
    return false;
  }

  all() {
    this.work(Infinity);
    return this.found;
  }

  * find() {
    const found = {flipped: 0, torn: 0, minDet: Infinity, moved: 0};
    yield* this.findGradients(found);
    yield* this.findFlipped(found);
    this.gradients = null;
    this.findTorn(found);
    yield* this.countMoved(found);
    if (found.minDet === Infinity) found.minDet = 1;
    this.found = found;
  }

  * findGradients(found) {
    const {shown, dets} = this, {vertices} = shown.scene, F = new Float64Array(9);
    this.gradients = new Float32Array(9 * vertices);
    for (let v = 0; v < vertices; v++) {
      shown.gradient(v, F);
      this.gradients.set(F, 9 * v);
      for (const k of [0, 4, 8]) F[k] += 1;
      const det = determinant(F);
      dets[v] = det;
      if (det < found.minDet) found.minDet = det;
      if (v % STEPS === 0) yield;
    }
  }

  // Twice the vector of a polygon's area, by its triangles; before, or as it is shown.
  areaOf(first, end, isRest, out) {
    const {scene, edit: {rest}} = this.shown, list = scene.triangleIndices;
    const at = (v, a) => (isRest ? rest[3 * v + a] : this.shown.shown(v, a));
    let size = 0;
    out.fill(0);
    for (let t = first; t < end; t++) {
      const [p, q, r] = [list[3 * t], list[3 * t + 1], list[3 * t + 2]];
      const x = at(q, 0) - at(p, 0), y = at(q, 1) - at(p, 1), z = at(q, 2) - at(p, 2);
      const l = at(r, 0) - at(p, 0), m = at(r, 1) - at(p, 1), n = at(r, 2) - at(p, 2);
      out[0] += y * n - z * m;
      out[1] += z * l - x * n;
      out[2] += x * m - y * l;
      size += x * x + y * y + z * z + l * l + m * m + n * n;
    }
    return Math.hypot(out[0], out[1], out[2]) > FLAT * size;
  }

  // Whether n' . (F n) < 0, with F the mean of the corners' (src/maths.md 11).
  isFlipped(first, end) {
    const {gradients, before, after} = this, list = this.shown.scene.triangleIndices;
    if (!this.areaOf(first, end, true, before) || !this.areaOf(first, end, false, after)) return false;
    const corners = new Set(list.subarray(3 * first, 3 * end)), mean = [0, 0, 0, 0, 0, 0, 0, 0, 0];
    for (const v of corners) for (let k = 0; k < 9; k++) mean[k] += gradients[9 * v + k] / corners.size;
    let dot = 0;
    for (let r = 0; r < 3; r++) dot += after[r] * (before[r] + mean[3 * r] * before[0] + mean[3 * r + 1] * before[1] + mean[3 * r + 2] * before[2]);
    return dot < 0;
  }

  // Calls visit(first, end) with the triangles of each polygon.
  * faces(visit) {
    const {scene, edit: {face}} = this.shown;
    for (let first = 0, end; first < scene.triangles; first = end) {
      end = first + 1;
      while (face && end < scene.triangles && face[end]) end++;
      visit(first, end);
      if (first % STEPS === 0) yield;
    }
  }

  * findFlipped(found) {
    yield* this.faces((first, end) => {
      const is = this.isFlipped(first, end);
      this.flags.fill(is ? 1 : 0, first, end);
      found.flipped += is ? 1 : 0;
    });
  }

  // Edges of polygons between a vertex that the lattice moves and one that stays, once each.
  listEdges() {
    const {shown} = this, {scene, edit: {kind, uvw, rest}} = shown, list = scene.triangleIndices;
    this.edges = [];
    if (!kind.subarray(0, scene.vertices).some((of) => of === STAYS)) return;
    const places = placesOf(rest), known = new Set();
    const moves = (v) => kind[v] !== STAYS;
    // A place moves with any of its vertices.
    const moving = new Uint8Array(scene.vertices);
    for (let v = 0; v < scene.vertices; v++) if (moves(v)) moving[places[v]] = 1;
    const add = (a, b) => {
      const [p, q] = [places[a], places[b]];
      if (moving[p] === moving[q]) return;
      const key = Math.min(p, q) * scene.vertices + Math.max(p, q);
      const still = moving[p] ? b : a;
      if (known.has(key) || Number.isNaN(uvw[3 * still])) return;
      known.add(key);
      this.edges.push({still, other: still === a ? b : a, length: Math.hypot(...[0, 1, 2].map((k) => rest[3 * a + k] - rest[3 * b + k]))});
    };
    const visit = (first, end) => {
      // A side that two triangles of a polygon share is none of its edges.
      const sides = new Map();
      for (let i = 3 * first; i < 3 * end; i++) {
        const a = list[i], b = list[i % 3 === 2 ? i - 2 : i + 1], key = Math.min(a, b) + ' ' + Math.max(a, b);
        sides.set(key, sides.has(key) ? null : [a, b]);
      }
      for (const side of sides.values()) if (side) add(...side);
    };
    const touches = (first, end) => {
      let some = 0;
      for (let i = 3 * first; i < 3 * end; i++) some |= moving[places[list[i]]] ? 1 : 2;
      return some === 3;
    };
    for (const step of this.faces((first, end) => { if (touches(first, end)) visit(first, end); })) void step;
  }

  findTorn(found) {
    const {shown: {delta}} = this;
    if (!this.edges) this.listEdges();
    this.torn = this.edges.map((edge) => ({...edge, step: Math.hypot(delta[3 * edge.still], delta[3 * edge.still + 1], delta[3 * edge.still + 2])}))
      .filter(({step, length}) => step > TORN * length);
    found.torn = this.torn.length;
  }

  * countMoved(found) {
    const {shown} = this, {scene, edit: {kind, uvw, way, start, rest}, volume} = shown;
    for (let v = 0; v < scene.vertices; v++) {
      const points = [v, ...(shown.further ? shown.further.get(v) || [] : [])];
      const is = points.some((i) => kind[i] !== STAYS && (kind[i] === INSIDE || way[WAY * i + 9] !== 0) &&
        volume.isMovedAt(uvw[3 * i], uvw[3 * i + 1], uvw[3 * i + 2]));
      const before = shown.edit.gradient && [0, 1, 2].some((a) => start[3 * v + a] !== rest[3 * v + a]);
      found.moved += is || before ? 1 : 0;
      if (v % STEPS === 0) yield;
    }
  }
}

Object.assign(Figures.prototype, {before: [0, 0, 0], after: [0, 0, 0]});
