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

// Which of a place's sides a face belongs to; a new one where none is near.
function findSide(sides, x, y, z) {
  const length = Math.hypot(x, y, z);
  let best = -1, most = CREASE;
  for (let s = 0; s < sides.length; s++) {
    const side = sides[s];
    const size = Math.hypot(side.x, side.y, side.z);
    const cosine = size > 0 && length > 0 ? (side.x * x + side.y * y + side.z * z) / (size * length) : 1;
    if (cosine >= most) {
      most = cosine;
      best = s;
    }
  }
  if (best < 0 && sides.length < MOST_SIDES) {
    best = sides.length;
    sides.push({x: 0, y: 0, z: 0, ax: 0, ay: 0, az: 0, drawn: []});
  }
  return Math.max(best, 0);
}

function storeNormal(normals, at, x, y, z) {
  const factor = 32767 / (Math.hypot(x, y, z) || 1);
  normals[at] = x * factor;
  normals[at + 1] = y * factor;
  normals[at + 2] = z * factor;
}

// What is drawn: `sources` names the vertex of each drawn one, `indices` the corners of the triangles.
function splitVertices(scene) {
  const triangles = scene.triangleIndices;
  const {ids, places} = weld(scene.quantized, scene.moves, scene.vertices);
  const faceBefore = faceNormals(scene.before, scene.move, triangles, 0);
  const faceAfter = faceNormals(scene.before, scene.move, triangles, 1);
  const {starts, corners} = listCorners(triangles, ids, places);
  const indices = new Uint32Array(triangles.length);
  const sources = [], normalsBefore = [], normalsAfter = [];
  const drawn = new Int32Array(scene.vertices).fill(-1);
  const sideOf = [];
  for (let place = 0; place < places; place++) {
    const sides = [];
    for (let i = starts[place]; i < starts[place + 1]; i++) {
      const face = corners[i] - (corners[i] % 3);
      const number = findSide(sides, faceBefore[face], faceBefore[face + 1], faceBefore[face + 2]);
      const side = sides[number];
      sideOf[i - starts[place]] = number;
      side.x += faceBefore[face];
      side.y += faceBefore[face + 1];
      side.z += faceBefore[face + 2];
      side.ax += faceAfter[face];
      side.ay += faceAfter[face + 1];
      side.az += faceAfter[face + 2];
    }
    for (let i = starts[place]; i < starts[place + 1]; i++) {
      const vertex = triangles[corners[i]];
      const side = sides[sideOf[i - starts[place]]];
      let at = side.drawn.find((one) => sources[one] === vertex);
      if (at === undefined) {
        at = sources.push(vertex) - 1;
        side.drawn.push(at);
        normalsBefore.push(side.x, side.y, side.z);
        normalsAfter.push(side.ax, side.ay, side.az);
        drawn[vertex] = at;
      }
      indices[corners[i]] = at;
    }
  }
  for (let v = 0; v < scene.vertices; v++) {
    if (drawn[v] >= 0) continue;
    drawn[v] = sources.push(v) - 1;
    normalsBefore.push(0, 0, 1);
    normalsAfter.push(0, 0, 1);
  }
  const count = sources.length;
  const normals = new Int16Array(8 * count);
  for (let i = 0; i < count; i++) {
    storeNormal(normals, 8 * i, normalsBefore[3 * i], normalsBefore[3 * i + 1], normalsBefore[3 * i + 2]);
    storeNormal(normals, 8 * i + 4, normalsAfter[3 * i], normalsAfter[3 * i + 1], normalsAfter[3 * i + 2]);
  }
  return {sources: Uint32Array.from(sources), indices, normals, drawn};
}
