// shown.js - what the edited lattice makes of the mesh: where its points are, and the arrays that are drawn.

const INSIDE = 0, EXTENDED = 1, STAYS = 2;  // edit_kind
const WAY = 13;  // numbers that say how a point follows the border: EDIT_WAY

// The arrays of a page that edits (src/view/page_edit.h).
function readEdit(scene) {
  const {edit} = scene;
  const take = (name, Type) => readArray('data-edit-' + name, Type);
  for (const name of ['start', 'uvw', 'rest', 'gradient', 'way', 'factor', 'offset', 'weight', 'deformed-weight']) edit[name] = take(name, Float64Array);
  edit.kind = take('kind', Uint8Array);
  edit.owner = take('owner', Uint32Array);
  edit.face = take('face', Uint8Array);
  edit.knots = [0, 1, 2].map((a) => take('knot-' + a, Float64Array));
  const points = edit.kind ? edit.kind.length : -1, cage = scene.cages[edit.cage];
  return [[edit.start, 3 * points], [edit.uvw, 3 * points], [edit.rest, 3 * scene.vertices], [edit.offset, 3 * cage.count]]
    .every(([array, size]) => array && array.length === size) && edit.knots.every((list) => list && list.length > 0);
}

// Quantized positions, by which vertices at one place are drawn as one; those of a view are written so.
function quantizeRest(scene) {
  const {low, step, edit} = scene;
  scene.quantized = Uint16Array.from(edit.rest, (x, i) => (step[i % 3] > 0 ? Math.round((x - low[i % 3]) / step[i % 3]) : 0));
  scene.moves = new Int16Array(3 * scene.vertices);
}

class Shown {
  constructor(scene) {
    const {edit} = scene, cage = scene.cages[edit.cage];
    this.scene = scene;
    this.edit = edit;
    this.points = edit.kind.length;
    this.volume = new Volume({size: cage.size, degree: edit.degree, knots: edit.knots, rest: cage.rest, weights: edit.weight,
      deformedWeights: edit['deformed-weight']});
    this.delta = new Float64Array(3 * this.points);
    this.groupByCell();
    this.listFurther();
  }

  // Points of a cell follow each other: a changed control point acts in some cells only.
  groupByCell() {
    const {volume, points, edit: {uvw}} = this;
    const cells = new Map(), cellOf = new Int32Array(points).fill(-1);
    this.cells = [];
    const [U, V, W] = volume.directions;
    for (let i = 0; i < points; i++) {
      const u = uvw[3 * i];
      if (Number.isNaN(u)) continue;
      const spans = [U.span(u), V.span(uvw[3 * i + 1]), W.span(uvw[3 * i + 2])];
      const key = (spans[0] * V.functions + spans[1]) * W.functions + spans[2];
      let cell = cells.get(key);
      if (cell === undefined) {
        cell = this.cells.push(spans) - 1;
        cells.set(key, cell);
      }
      cellOf[i] = cell;
    }
    this.starts = new Uint32Array(this.cells.length + 1);
    for (const cell of cellOf) if (cell >= 0) this.starts[cell + 1]++;
    for (let c = 0; c < this.cells.length; c++) this.starts[c + 1] += this.starts[c];
    const next = this.starts.slice();
    this.order = new Uint32Array(this.starts[this.cells.length]);
    cellOf.forEach((cell, i) => { if (cell >= 0) this.order[next[cell]++] = i; });
  }

  // Points behind the vertices, by the vertices that they make: of morph targets.
  listFurther() {
    const {edit, scene} = this;
    this.further = null;
    if (!edit.owner) return;
    this.further = new Map();
    edit.owner.forEach((vertex, i) => {
      if (!this.further.has(vertex)) this.further.set(vertex, []);
      this.further.get(vertex).push(scene.vertices + i);
    });
  }

  // Whether a control point with a flag acts in a cell; null: all have one.
  isTouched(cell, flags) {
    if (!flags) return true;
    const {volume} = this, spans = this.cells[cell], [nu, nv] = volume.size;
    const [U, V, W] = volume.directions;
    for (let c = 0; c <= W.degree; c++) {
      for (let b = 0; b <= V.degree; b++) {
        const row = nu * (V.pointOf(spans[1] - V.degree + b) + nv * W.pointOf(spans[2] - W.degree + c));
        for (let a = 0; a <= U.degree; a++) if (flags[row + U.pointOf(spans[0] - U.degree + a)]) return true;
      }
    }
    return false;
  }

  // Takes new offsets. flags: of the control points that changed; null: all did.
  update(offsets, flags) {
    const {volume, edit: {uvw, kind, way}, delta, order, starts} = this;
    volume.offsets.set(offsets);
    for (let cell = 0; cell < this.cells.length; cell++) {
      if (!this.isTouched(cell, flags)) continue;
      for (let n = starts[cell]; n < starts[cell + 1]; n++) {
        const i = order[n], at = 3 * i;
        volume.displace(uvw[at], uvw[at + 1], uvw[at + 2], delta, at);
        if (kind[i] === EXTENDED) for (let a = 0; a < 3; a++) delta[at + a] *= way[WAY * i + 9];
        if (i < this.scene.vertices && !this.further) this.place(i);
      }
    }
    if (this.further || !flags) for (let v = 0; v < this.scene.vertices; v++) this.place(v);
  }

  // A coordinate of a point, where the lattice takes it.
  coordinate(i, a) {
    return this.edit.start[3 * i + a] + (this.edit.kind[i] === STAYS ? 0 : this.delta[3 * i + a]);
  }

  // A coordinate of a vertex: of several points the sum.
  shown(v, a) {
    const further = this.further ? this.further.get(v) : undefined;
    if (!further) return this.coordinate(v, a);
    const {factor} = this.edit;
    return further.reduce((sum, i) => sum + factor[i] * this.coordinate(i, a), factor[v] * this.coordinate(v, a));
  }

  // Sets what is drawn of a vertex.
  place(v) {
    const {scene, edit: {rest}} = this, {move, space: {scale}} = scene;
    for (let a = 0; a < 3; a++) move[3 * v + a] = (this.shown(v, a) - rest[3 * v + a]) / scale;
  }

  // F - I of the whole deformation at a vertex, row by row.
  gradient(v, E) {
    const {edit: {uvw, kind, way, gradient}, volume} = this, at = 3 * v;
    E.fill(0);
    if (kind[v] !== STAYS) {
      const by = this.byUvw, J = this.jacobian;
      volume.gradients(uvw[at], uvw[at + 1], uvw[at + 2], by, J);
      if (kind[v] === INSIDE) {
        if (invert(J, this.inverse)) multiply(by, this.inverse, E);
      } else {
        const own = way.subarray(WAY * v, WAY * v + WAY), fade = own[9];
        multiply(by, own, E);
        for (let r = 0; r < 3; r++) {
          // The displacement at the border is what the fade has left, undone.
          const whole = fade > 0 ? this.delta[at + r] / fade : 0;
          for (let c = 0; c < 3; c++) E[3 * r + c] = fade * E[3 * r + c] + whole * own[10 + c];
        }
      }
    }
    if (!gradient) return;
    // F = F2 F1: E = E1 + E2 + E2 E1.
    const first = gradient.subarray(9 * v, 9 * v + 9);
    if (Number.isNaN(first[0])) return;
    multiply(E, first, this.product);
    for (let i = 0; i < 9; i++) E[i] += first[i] + this.product[i];
  }
}

Object.assign(Shown.prototype, {byUvw: new Float64Array(9), jacobian: new Float64Array(9), inverse: new Float64Array(9), product: new Float64Array(9)});
