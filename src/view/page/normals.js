// normals.js - smooth normals before and after, with creases: where faces meet at more than about 60 degrees, a vertex
// is drawn once for each side. Vertices at one place, as at seams of textures, are smoothed as one.

const CREASE = 0.5;  // the cosine from which on faces are one surface
const MOST_SIDES = 24;

// An id for each place: equal positions before that move equally have one.
function weld(quantized, moves, count) {
  let size = 16;
  while (size < 2 * count) size *= 2;
  const table = new Int32Array(size).fill(-1);
  const ids = new Uint32Array(count);
  let places = 0;
  for (let v = 0; v < count; v++) {
    const i = 3 * v;
    let hash = Math.imul(quantized[i], 73856093) ^ Math.imul(quantized[i + 1], 19349663) ^
        Math.imul(quantized[i + 2], 83492791) ^ Math.imul(moves[i] + 7 * moves[i + 1] + 31 * moves[i + 2], 2654435761);
    hash = (hash ^ (hash >>> 15)) & (size - 1);
    for (;; hash = (hash + 1) & (size - 1)) {
      const other = table[hash];
      if (other < 0) {
        table[hash] = v;
        ids[v] = places++;
        break;
      }
      const j = 3 * other;
      if (quantized[i] === quantized[j] && quantized[i + 1] === quantized[j + 1] && quantized[i + 2] === quantized[j + 2] &&
          moves[i] === moves[j] && moves[i + 1] === moves[j + 1] && moves[i + 2] === moves[j + 2]) {
        ids[v] = ids[other];
        break;
      }
    }
  }
  return {ids, places};
}

// Normals of the faces, as long as twice their areas; `share` of the movement is added to the positions.
function faceNormals(before, move, triangles, share) {
  const normals = new Float32Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ax = before[a] + share * move[a], ay = before[a + 1] + share * move[a + 1], az = before[a + 2] + share * move[a + 2];
    const ux = before[b] + share * move[b] - ax, uy = before[b + 1] + share * move[b + 1] - ay,
        uz = before[b + 2] + share * move[b + 2] - az;
    const vx = before[c] + share * move[c] - ax, vy = before[c + 1] + share * move[c + 1] - ay,
        vz = before[c + 2] + share * move[c + 2] - az;
    normals[t] = uy * vz - uz * vy;
    normals[t + 1] = uz * vx - ux * vz;
    normals[t + 2] = ux * vy - uy * vx;
  }
  return normals;
}

// The corners of the triangles at each place, one list after the other.
function listCorners(triangles, ids, places) {
  const starts = new Uint32Array(places + 1);
  for (let i = 0; i < triangles.length; i++) starts[ids[triangles[i]] + 1]++;
  for (let p = 0; p < places; p++) starts[p + 1] += starts[p];
  const next = starts.slice(0, places);
  const corners = new Uint32Array(triangles.length);
  for (let i = 0; i < triangles.length; i++) corners[next[ids[triangles[i]]]++] = i;
  return {starts, corners};
}

// Numbers that are added one by one: a browser keeps the memory that arrays of its own have once had.
class Numbers {
  constructor(Type) {
    this.list = new Type(1024);
    this.length = 0;
  }

  // Returns the index of the number.
  push(value) {
    if (this.length === this.list.length) {
      const larger = new this.list.constructor(2 * this.length);
      larger.set(this.list);
      this.list = larger;
    }
    this.list[this.length] = value;
    return this.length++;
  }

  done() {
    return this.list.slice(0, this.length);
  }
}

// The sides of a place: they are used again for the next one.
class Sides {
  constructor(shapes) {
    this.shapes = shapes;
    this.list = [];
    this.count = 0;
  }

  // Returns the number of a new side.
  add() {
    if (this.count === this.list.length) this.list.push({sums: new Float64Array(3 * this.shapes), drawn: []});
    const side = this.list[this.count];
    side.sums.fill(0);
    side.drawn.length = 0;
    return this.count++;
  }
}

// Which of a place's sides a face belongs to; a new one where none is near.
function findSide(sides, x, y, z) {
  const length = Math.hypot(x, y, z);
  let best = -1, most = CREASE;
  for (let s = 0; s < sides.count; s++) {
    const {sums} = sides.list[s], sx = sums[0], sy = sums[1], sz = sums[2];
    const size = Math.hypot(sx, sy, sz);
    const cosine = size > 0 && length > 0 ? (sx * x + sy * y + sz * z) / (size * length) : 1;
    if (cosine >= most) {
      most = cosine;
      best = s;
    }
  }
  return best < 0 && sides.count < MOST_SIDES ? sides.add() : Math.max(best, 0);
}

function storeNormal(normals, at, x, y, z) {
  const factor = 32767 / (Math.hypot(x, y, z) || 1);
  normals[at] = x * factor;
  normals[at + 1] = y * factor;
  normals[at + 2] = z * factor;
}

// Normals of the faces before and after; and where animations move the mesh, of its anchors before and after.
function listFaces(scene) {
  const {before, move, triangleIndices: triangles, rig} = scene;
  const faces = [faceNormals(before, move, triangles, 0), faceNormals(before, move, triangles, 1)];
  const sides = rig ? rig.sides.filter((side) => side && side.anchors.length) : [];
  for (const {anchors} of sides) faces.push(faceNormals(anchors, anchors, triangles, 0));
  return faces;
}

// What is drawn: `sources` names the vertex of each drawn one, `wedges` its wedge (decode.js; empty where no texture is shown),
// `indices` the corners of the triangles. `normals` are
// those before and after, `groups` which are smoothed as one, `anchorNormals` those of listFaces, three floats a vertex each.
function splitVertices(scene) {
  const triangles = scene.triangleIndices;
  const {ids, places} = weld(scene.quantized, scene.moves, scene.vertices);
  const faces = listFaces(scene);
  const {starts, corners} = listCorners(triangles, ids, places);
  const indices = new Uint32Array(triangles.length);
  const sources = new Numbers(Uint32Array), wedges = new Numbers(Int32Array), groups = new Numbers(Uint32Array);
  const sums = faces.map(() => new Numbers(Float32Array));
  const wedgeOf = scene.wedges ? scene.wedges.corners : null;
  const drawn = new Int32Array(scene.vertices).fill(-1);
  const sideOf = [], sides = new Sides(faces.length);
  let groupCount = 0;
  for (let place = 0; place < places; place++) {
    sides.count = 0;
    for (let i = starts[place]; i < starts[place + 1]; i++) {
      const face = corners[i] - (corners[i] % 3);
      const number = findSide(sides, faces[0][face], faces[0][face + 1], faces[0][face + 2]);
      const side = sides.list[number];
      sideOf[i - starts[place]] = number;
      for (let s = 0; s < faces.length; s++) {
        for (let a = 0; a < 3; a++) side.sums[3 * s + a] += faces[s][face + a];
      }
    }
    for (let i = starts[place]; i < starts[place + 1]; i++) {
      const vertex = triangles[corners[i]];
      const side = sides.list[sideOf[i - starts[place]]];
      const wedge = wedgeOf ? wedgeOf[corners[i]] : undefined;
      let at = -1;
      for (const one of side.drawn) if (sources.list[one] === vertex && (!wedgeOf || wedges.list[one] === wedge)) at = one;
      if (at < 0) {
        at = sources.push(vertex);
        if (wedgeOf) wedges.push(wedge);
        side.drawn.push(at);
        groups.push(groupCount + sideOf[i - starts[place]]);
        for (let s = 0; s < faces.length; s++) for (let a = 0; a < 3; a++) sums[s].push(side.sums[3 * s + a]);
        drawn[vertex] = at;
      }
      indices[corners[i]] = at;
    }
    groupCount += sides.count;
  }
  for (let v = 0; v < scene.vertices; v++) {
    if (drawn[v] >= 0) continue;
    drawn[v] = sources.push(v);
    groups.push(groupCount++);
    if (wedgeOf) wedges.push(-1);
    for (const list of sums) for (const x of [0, 0, 1]) list.push(x);
  }
  const count = sources.length;
  const normals = new Int16Array(8 * count);
  for (let i = 0; i < count; i++) {
    for (const s of [0, 1]) storeNormal(normals, 8 * i + 4 * s, sums[s].list[3 * i], sums[s].list[3 * i + 1], sums[s].list[3 * i + 2]);
  }
  return {sources: sources.done(), wedges: wedges.done(), indices, normals, drawn, groups: groups.done(), groupCount, anchorNormals: sums.slice(2).map((list) => list.done())};
}

// The normals of what is drawn in a pose (rig.js), as splitVertices has them at rest.
function poseNormals(split, poses, restNormals) {
  const normals = restNormals.slice(), matrix = new Float64Array(12);
  [0, 1].forEach((number) => {
    const pose = poses[number];
    if (!pose) return;
    const from = split.anchorNormals[poses[0] === poses[1] || split.anchorNormals.length < 2 ? 0 : number];
    for (let i = 0; i < split.sources.length; i++) {
      blendBones(pose.side, pose.bones, split.sources[i], matrix);
      const [a, b, c, d, e, f, g, h, k] = matrix;
      const x = from[3 * i], y = from[3 * i + 1], z = from[3 * i + 2];
      // Cofactors: they turn normals as the matrix turns surfaces.
      storeNormal(normals, 8 * i + 4 * number, (e * k - f * h) * x + (f * g - d * k) * y + (d * h - e * g) * z,
        (c * h - b * k) * x + (a * k - c * g) * y + (b * g - a * h) * z,
        (b * f - c * e) * x + (c * d - a * f) * y + (a * e - b * d) * z);
    }
  });
  return normals;
}

// Sets the normals before (share 0) or after (1) by the faces as they are now. Their sides stay those at rest.
function smoothFaces(scene, split, share, normals) {
  const {groups, groupCount, indices} = split;
  const faces = faceNormals(scene.before, scene.move, scene.triangleIndices, share), sums = new Float32Array(3 * groupCount);
  for (let i = 0; i < indices.length; i++) {
    const to = 3 * groups[indices[i]], from = i - (i % 3);
    for (let a = 0; a < 3; a++) sums[to + a] += faces[from + a];
  }
  groups.forEach((group, at) => storeNormal(normals, 8 * at + 4 * share, sums[3 * group], sums[3 * group + 1], sums[3 * group + 2]));
}

// The same where morph targets have changed the shape.
function morphNormals(scene, split) {
  const normals = split.normals.slice();
  for (const share of [0, 1]) smoothFaces(scene, split, share, normals);
  return normals;
}

// Where a lattice is edited.
function setNormalsAfter(scene, split) {
  smoothFaces(scene, split, 1, split.normals);
}
