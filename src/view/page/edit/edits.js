// edits.js - the offsets of the control points: what changes them, by whole steps that can be undone. Knows nothing of
// what is drawn.

const AXES = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]};
const SAME_PLACE = 1e-6;  // of the lattice's diagonal: where a mirror image is looked for
const SMOOTHING = 0.5;

function unit(vector) {
  const length = Math.hypot(...vector);
  if (vector.length !== 3 || !vector.every(Number.isFinite) || !(length > 0)) throw new Error(`not a direction: ${vector}`);
  return vector.map((x) => x / length);
}

function axisOf(axis) {
  if (typeof axis === 'string' && !AXES[axis]) throw new Error(`not an axis: ${axis} (x, y, z or [x, y, z])`);
  return unit(typeof axis === 'string' ? AXES[axis] : [...axis]);
}

// Right-handed, row by row (Rodrigues).
function rotation(axis, degrees) {
  const [x, y, z] = axisOf(axis), angle = degrees * Math.PI / 180;
  // Quarter turns are exact.
  const quarter = degrees % 90 === 0 ? ((degrees / 90) % 4 + 4) % 4 : -1;
  const c = quarter >= 0 ? [1, 0, -1, 0][quarter] : Math.cos(angle), s = quarter >= 0 ? [0, 1, 0, -1][quarter] : Math.sin(angle), t = 1 - c;
  return [t * x * x + c, t * x * y - s * z, t * x * z + s * y, t * x * y + s * z, t * y * y + c, t * y * z - s * x,
    t * x * z - s * y, t * y * z + s * x, t * z * z + c];
}

function finite(numbers, count, what) {
  const list = [...numbers].map(Number);
  if (list.length !== count || !list.every(Number.isFinite)) throw new Error(`${what} takes ${count} numbers`);
  return list;
}

class Edits {
  constructor(rest, size, closed, offsets) {
    this.rest = rest;
    this.size = size;
    this.closed = closed;
    this.count = rest.length / 3;
    this.offsets = offsets.slice();
    this.selected = new Uint8Array(this.count);
    this.radius = null;
    this.plane = null;
    this.strength = 1;
    this.done = [];
    this.undone = [];
    this.listeners = [];
    this.saved = 0;  // the number of steps when it was saved
  }

  onChange(listener) {
    this.listeners.push(listener);
  }

  tell(flags) {
    for (const listener of this.listeners) listener(flags);
  }

  point(j) {
    return [0, 1, 2].map((a) => this.rest[3 * j + a] + this.strength * this.offsets[3 * j + a]);
  }

  // Selection

  select(indices, mode = 'set') {
    const list = [...indices].map(Number);
    const wrong = list.find((j) => !Number.isInteger(j) || j < 0 || j >= this.count);
    if (wrong !== undefined) throw new Error(`there is no control point ${wrong}: they are 0 to ${this.count - 1}`);
    if (!['set', 'add', 'remove'].includes(mode)) throw new Error(`${mode} is not set, add or remove`);
    if (mode === 'set') this.selected.fill(0);
    for (const j of list) this.selected[j] = mode === 'remove' ? 0 : 1;
    this.tell(new Uint8Array(this.count));
  }

  selection() {
    const list = [];
    this.selected.forEach((is, j) => { if (is) list.push(j); });
    return list;
  }

  // Those at the mirror images of what goes along, which go along too.
  imagesOf(shares) {
    if (!this.plane) return [];
    const list = [];
    shares.forEach((share, j) => {
      const image = this.plane.images[j];
      if (share > 0 && image >= 0 && !(shares[image] > 0)) list.push(image);
    });
    return list;
  }

  centroid() {
    const list = this.selection(), sum = [0, 0, 0];
    for (const j of list) this.point(j).forEach((x, a) => { sum[a] += x / list.length; });
    return list.length ? sum : null;
  }

  // How far each control point goes along: 1 where it is selected; near it (1 - (x/r)^2)^2.
  shares() {
    const list = this.selection(), {rest, radius, count} = this, shares = Float64Array.from(this.selected);
    if (!(radius > 0)) return shares;
    for (let j = 0; j < count; j++) {
      if (shares[j]) continue;
      let least = Infinity;
      for (const s of list) {
        const x = rest[3 * j] - rest[3 * s], y = rest[3 * j + 1] - rest[3 * s + 1], z = rest[3 * j + 2] - rest[3 * s + 2];
        least = Math.min(least, x * x + y * y + z * z);
      }
      const left = 1 - least / (radius * radius);
      shares[j] = left > 0 ? left * left : 0;
    }
    return shares;
  }

  soft(radius) {
    if (radius !== null && !(Number(radius) >= 0 && Number.isFinite(Number(radius)))) throw new Error('soft takes a radius, or null');
    this.radius = radius === null || Number(radius) === 0 ? null : Number(radius);
    this.tell(new Uint8Array(this.count));
  }

  // Mirror

  mirror(plane) {
    this.plane = null;
    if (plane) {
      const normal = plane.axis === undefined ? unit(finite(plane.normal, 3, 'normal')) : axisOf(plane.axis);
      const at = Number(plane.at || 0);
      const point = plane.axis === undefined ? finite(plane.point, 3, 'point') : normal.map((x) => x * at);
      this.plane = {normal, point, ...this.findImages(normal, point)};
    }
    this.tell(new Uint8Array(this.count));
    return this.plane ? this.plane.without : 0;
  }

  // The control point at whose mirror image each one is at rest; -1: there is none.
  findImages(normal, point) {
    const {rest, count} = this, low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < 3 * count; i++) {
      low[i % 3] = Math.min(low[i % 3], rest[i]);
      high[i % 3] = Math.max(high[i % 3], rest[i]);
    }
    const near = SAME_PLACE * Math.hypot(...low.map((x, a) => high[a] - x)), cell = 2 * near || 1, table = new Map();
    const keyOf = (p) => p.map((x) => Math.round(x / cell)).join(' ');
    for (let j = 0; j < count; j++) {
      const key = keyOf([...rest.subarray(3 * j, 3 * j + 3)]);
      if (!table.has(key)) table.set(key, []);
      table.get(key).push(j);
    }
    const images = new Int32Array(count).fill(-1), sides = new Float64Array(count);
    let without = 0;
    for (let j = 0; j < count; j++) {
      const p = [...rest.subarray(3 * j, 3 * j + 3)];
      sides[j] = p.reduce((sum, x, a) => sum + normal[a] * (x - point[a]), 0);
      const image = p.map((x, a) => x - 2 * sides[j] * normal[a]);
      let least = near;
      for (const dx of [-1, 0, 1]) for (const dy of [-1, 0, 1]) for (const dz of [-1, 0, 1]) {
        const key = keyOf([image[0] + dx * cell, image[1] + dy * cell, image[2] + dz * cell]);
        for (const k of table.get(key) || []) {
          const far = Math.hypot(...image.map((x, a) => x - rest[3 * k + a]));
          if (far <= least) {
            least = far;
            images[j] = k;
          }
        }
      }
      if (images[j] < 0) without++;
    }
    return {images, sides, without, near};
  }

  reflect(vector) {
    const {normal} = this.plane, along = vector.reduce((sum, x, a) => sum + x * normal[a], 0);
    return vector.map((x, a) => x - 2 * along * normal[a]);
  }

  // Adds to each change that of the mirror image. changes: Map from a control point to [share, vector].
  withImages(changes) {
    if (!this.plane) return changes;
    const {images, sides, near} = this.plane, all = new Map();
    for (const [j, [share, vector]] of changes) {
      const image = images[j];
      if (image === j || Math.abs(sides[j]) <= near) {
        // In the plane only what is along it is its own image.
        const other = this.reflect(vector);
        all.set(j, [share, vector.map((x, a) => (x + other[a]) / 2)]);
        continue;
      }
      const rival = image >= 0 ? changes.get(image) : undefined;
      // Of two that are each other's image the one with the larger share leads; of equal ones that on the normal's side.
      const leads = !rival || share > rival[0] || (share === rival[0] && sides[j] > 0);
      if (!leads) continue;
      all.set(j, [share, vector]);
      if (image >= 0) all.set(image, [share, this.reflect(vector)]);
    }
    return all;
  }

  // Steps

  // Changes offsets by vectors in the shown size: Map from a control point to [share, vector].
  changesBy(vectorOf) {
    const changes = new Map();
    this.shares().forEach((share, j) => { if (share > 0) changes.set(j, [share, vectorOf(j, share)]); });
    return this.withImages(changes);
  }

  // The offsets after a change, of the control points that it has.
  offsetsAfter(changes, from = this.offsets) {
    if (this.strength === 0) throw new Error('the strength is 0: nothing that is moved would show');
    const indices = [...changes.keys()], values = [];
    for (const j of indices) {
      const [, vector] = changes.get(j);
      for (let a = 0; a < 3; a++) values.push(from[3 * j + a] + vector[a] / this.strength);
    }
    return {indices, values};
  }

  // Sets offsets as one step; the same ones again are none. run: steps in a row with this same word are one.
  commit({indices, values}, before = this.offsets, run = null) {
    const step = {indices: [], before: [], after: [], run};
    indices.forEach((j, n) => {
      if ([0, 1, 2].every((a) => Object.is(values[3 * n + a], before[3 * j + a]))) return;
      step.indices.push(j);
      for (let a = 0; a < 3; a++) {
        step.before.push(before[3 * j + a]);
        step.after.push(values[3 * n + a]);
      }
    });
    if (step.after.some((x) => !Number.isFinite(x))) throw new Error('that is too far for numbers');
    if (!step.indices.length) return;
    const last = this.done[this.done.length - 1];
    const goesOn = run !== null && last && last.run === run && this.undone.length === 0 && this.saved !== this.done.length &&
      last.indices.length === step.indices.length && last.indices.every((j, n) => j === step.indices[n]);
    if (goesOn) last.after = step.after;
    else this.done.push(step);
    this.undone = [];
    if (this.saved > this.done.length - 1) this.saved = -1;
    this.put(step.indices, step.after);
  }

  put(indices, values) {
    const flags = new Uint8Array(this.count);
    indices.forEach((j, n) => {
      flags[j] = 1;
      for (let a = 0; a < 3; a++) this.offsets[3 * j + a] = values[3 * n + a];
    });
    this.tell(flags);
  }

  moveBy(vector) {
    const by = finite(vector, 3, 'move');
    return this.changesBy((j, share) => by.map((x) => share * x));
  }

  // By a matrix about a point: the shown control points.
  mapBy(matrix, about) {
    const center = about === undefined || about === null ? this.centroid() : finite(about, 3, 'about');
    return this.changesBy((j, share) => {
      const from = this.point(j).map((x, a) => x - center[a]);
      return [0, 1, 2].map((r) => share * (matrix[3 * r] * from[0] + matrix[3 * r + 1] * from[1] + matrix[3 * r + 2] * from[2] - from[r]));
    });
  }

  move(vector) {
    const by = finite(vector, 3, 'move');
    if (this.selected.some((is) => is)) this.commit(this.offsetsAfter(this.moveBy(by)));
  }

  // As move; nudges of the same points in a row are one step.
  nudge(vector) {
    const list = this.selection();
    if (list.length) this.commit(this.offsetsAfter(this.moveBy(vector)), this.offsets, `nudge ${list} ${this.radius}`);
  }

  rotate(axis, degrees, about) {
    const matrix = rotation(axis, finite([degrees], 1, 'rotate')[0]);
    if (this.selected.some((is) => is)) this.commit(this.offsetsAfter(this.mapBy(matrix, about)));
  }

  scale(factor, about) {
    const by = typeof factor === 'number' ? [factor, factor, factor] : factor, [x, y, z] = finite(by, 3, 'scale');
    if (this.selected.some((is) => is)) this.commit(this.offsetsAfter(this.mapBy([x, 0, 0, 0, y, 0, 0, 0, z], about)));
  }

  // Sets the offsets of the selected points back to 0; without a selection of all.
  reset() {
    const list = this.selection(), indices = list.length ? list : Array.from({length: this.count}, (_, j) => j);
    this.commit({indices, values: new Array(3 * indices.length).fill(0)});
  }

  neighbours(j) {
    const [nu, nv, nw] = this.size, at = [j % nu, Math.floor(j / nu) % nv, Math.floor(j / (nu * nv))], strides = [1, nu, nu * nv], sizes = [nu, nv, nw];
    const found = [];
    for (let a = 0; a < 3; a++) {
      for (const step of [-1, 1]) {
        let next = at[a] + step;
        if (this.closed[a]) next = (next + sizes[a]) % sizes[a];
        if (next >= 0 && next < sizes[a]) found.push(j + (next - at[a]) * strides[a]);
      }
    }
    return found;
  }

  // Brings offsets nearer to the mean of their neighbours'; without a selection all.
  smooth() {
    const some = this.selected.some((is) => is), indices = [], values = [];
    const shares = some ? this.shares() : new Float64Array(this.count).fill(1);
    shares.forEach((share, j) => {
      const near = this.neighbours(j);
      if (!(share > 0) || !near.length) return;
      indices.push(j);
      for (let a = 0; a < 3; a++) {
        const mean = near.reduce((sum, k) => sum + this.offsets[3 * k + a], 0) / near.length, own = this.offsets[3 * j + a];
        values.push(own + share * SMOOTHING * (mean - own));
      }
    });
    this.commit({indices, values});
  }

  undo() {
    const step = this.done.pop();
    if (!step) return;
    this.undone.push(step);
    this.put(step.indices, step.before);
  }

  redo() {
    const step = this.undone.pop();
    if (!step) return;
    this.done.push(step);
    this.put(step.indices, step.after);
  }

  setStrength(share) {
    const [strength] = finite([share], 1, 'strength');
    if (!(strength >= 0 && strength <= 2)) throw new Error('strength is from 0 to 2');
    this.strength = strength;
    this.tell(null);
  }

  // Takes all offsets, as one step.
  take(offsets) {
    this.commit({indices: Array.from({length: this.count}, (_, j) => j), values: [...offsets]});
  }

  // What is saved: the offsets times the strength.
  shownOffsets() {
    return this.offsets.map((x) => x * this.strength);
  }
}
