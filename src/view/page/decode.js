// decode.js - the page's data blocks: JSON, and arrays of little-endian numbers in base64.

const STATUS_NAMES = ['inside', 'outside', 'multiple', 'singular', 'invalid'];

function readJson(id) {
  const block = byId(id);
  try {
    return block ? JSON.parse(block.textContent) : null;
  } catch (problem) {
    return null;
  }
}

// The bytes of a block; it is taken out of the page, whose text would double the memory.
function readBytes(id) {
  const block = byId(id);
  if (!block) return null;
  const text = block.textContent;
  block.remove();
  const step = 1 << 20;  // a multiple of four characters
  const padding = text.endsWith('==') ? 2 : text.endsWith('=') ? 1 : 0;
  const bytes = new Uint8Array((text.length / 4) * 3 - padding);
  for (let at = 0, to = 0; at < text.length; at += step) {
    const run = atob(text.slice(at, at + step));
    for (let i = 0; i < run.length; i++) bytes[to++] = run.charCodeAt(i);
  }
  return bytes;
}

const isLittleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

function readArray(id, Type) {
  const bytes = readBytes(id);
  if (!bytes) return null;
  const size = Type.BYTES_PER_ELEMENT;
  if (!isLittleEndian && size > 1) {
    for (let at = 0; at < bytes.length; at += size) bytes.subarray(at, at + size).reverse();
  }
  return new Type(bytes.buffer, 0, Math.floor(bytes.length / size));
}

// Control points: at rest and deformed, three numbers each.
function readCage(description, index) {
  const values = description.shown ? readArray('data-cage-' + index, Float64Array) : null;
  const count = values ? values.length / 6 : 0;
  const rest = new Float64Array(3 * count);
  const deformed = new Float64Array(3 * count);
  for (let p = 0; p < count; p++) {
    rest.set(values.subarray(6 * p, 6 * p + 3), 3 * p);
    deformed.set(values.subarray(6 * p + 3, 6 * p + 6), 3 * p);
  }
  return {...description, index, count, rest, deformed};
}

// The box of the mesh before and after, as centre and half of the longest side: it is drawn in -1 to 1.
function measureAll(scene) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const take = (points) => {
    for (let i = 0; i < points.length; i++) {
      const x = points[i];
      if (x < low[i % 3]) low[i % 3] = x;
      if (x > high[i % 3]) high[i % 3] = x;
    }
  };
  if (scene.vertices) {
    take(scene.low);
    take(scene.low.map((x, a) => x + 65535 * scene.step[a]));
  }
  // A mesh of one place has no size that lattices could be compared with.
  if (!(Math.max(...low.map((x, a) => high[a] - x)) > 0)) {
    for (const cage of scene.cages) {
      take(cage.rest);
      take(cage.deformed);
    }
  }
  if (!(low[0] <= high[0])) return {center: [0, 0, 0], scale: 1};
  const half = low.map((x, a) => high[a] / 2 - x / 2);
  return {center: low.map((x, a) => x / 2 + high[a] / 2), scale: Math.max(...half) || 1};
}

// Wedges: vertices with the coordinates of a texture; the corners of triangles name them. Null: no texture is shown.
function readWedges(scene) {
  if (scene.wedges === undefined) return null;
  return {vertices: readArray('data-wedge', Uint32Array), texcoords: readArray('data-texcoord', Uint16Array), corners: readArray('data-corner', Uint32Array),
    count: scene.wedges};
}

function areWedgesWhole(wedges, scene) {
  return [[wedges.vertices, wedges.count], [wedges.texcoords, scene.texcoordLow.length * wedges.count], [wedges.corners, 3 * scene.triangles]]
    .every(([array, size]) => array && array.length === size);
}

// Covariances of Gaussian splats before and after: of each vertex xx, xy, xz, yy, yz, zz (src/view/page_splats.h).
function readSplats(vertices) {
  const sides = ['before', 'after'].map((name) => {
    const bytes = readBytes('data-splat-' + name);
    if (!bytes || bytes.length !== 16 * vertices) return null;
    const view = new DataView(bytes.buffer);
    return Float32Array.from({length: 6 * vertices}, (_, i) => {
      const at = 16 * Math.floor(i / 6);
      return view.getFloat32(at, true) * view.getInt16(at + 4 + 2 * (i % 6), true) / 32767;
    });
  });
  return sides[0] ? [sides[0], sides[1] || sides[0]] : null;
}

// The files of the textures.
function readImages(scene) {
  return scene.images.map((type, index) => {
    const bytes = readBytes('data-image-' + index);
    return bytes && bytes.length ? new Blob([bytes], {type}) : null;
  });
}

// Whether the arrays are there from end to end: a file may be cut, and texts beyond a browser's limit are empty.
function isWhole(scene) {
  const sizes = [[scene.quantized, 3 * scene.vertices], [scene.moves, 3 * scene.vertices], [scene.triangleIndices, 3 * scene.triangles],
    [scene.segmentIndices, 2 * scene.segments], [scene.pointIndices, scene.points]];
  return sizes.every(([array, size]) => array && array.length === size);
}

// Everything that the page knows; null where it is not all there: scene, report, arrays. Positions are in the file's units, in doubles only where
// one asks for a vertex; `before` and `move` are floats in the picture's.
function readScene() {
  const scene = readJson('scene');
  if (!scene) return null;
  scene.report = readJson('report');
  scene.cages = scene.cages.map(readCage);
  if (scene.edit && !readEdit(scene)) return null;
  if (scene.edit) quantizeRest(scene);
  else {
    scene.quantized = readArray('data-before', Uint16Array);
    scene.moves = readArray('data-move', Int16Array);
  }
  scene.statuses = readArray('data-status', Uint8Array);
  scene.dets = readArray('data-det', Float32Array);
  scene.colors = readArray('data-color', Uint8Array);
  scene.numbers = readArray('data-number', scene.numberSize === 8 ? Float64Array : Uint32Array);
  const wedges = readWedges(scene);
  if (wedges && !areWedgesWhole(wedges, scene)) return null;
  scene.wedges = wedges;
  scene.images = readImages(scene);
  scene.triangleIndices = wedges ? wedges.corners.map((wedge) => wedges.vertices[wedge]) : readArray('data-triangle', Uint32Array);
  scene.flipped = readArray('data-flipped', Uint8Array);
  scene.segmentIndices = readArray('data-segment', Uint32Array);
  scene.pointIndices = readArray('data-point', Uint32Array);
  scene.splats = readSplats(scene.vertices);
  scene.rig = readRig(scene);
  scene.targets = readTargets(scene);
  if (!scene.targets || !isWhole(scene) || (scene.rig && !isRigWhole(scene.rig, scene.vertices))) return null;
  scene.space = measureAll(scene);
  const {center, scale} = scene.space;
  const count = 3 * scene.vertices;
  scene.before = new Float32Array(count);
  scene.move = new Float32Array(count);
  for (let i = 0; i < count; i++) {
    const x = scene.edit ? scene.edit.rest[i] - center[i % 3] : scene.low[i % 3] - center[i % 3] + scene.quantized[i] * scene.step[i % 3];
    scene.before[i] = x / scale;
    scene.move[i] = (scene.moves[i] * scene.moveStep) / scale;
  }
  for (const slider of scene.sliders) slider.value = slider.weight;
  scene.rest = scene.rig || scene.sliders.length ? {before: scene.before.slice(), move: scene.move.slice()} : null;
  return scene;
}

function vertexNumber(scene, vertex) {
  return scene.numbers ? scene.numbers[vertex] : vertex;
}

// A vertex in the file's units, to the page's precision.
function vertexBefore(scene, vertex) {
  if (scene.edit) return [...scene.edit.rest.subarray(3 * vertex, 3 * vertex + 3)];
  return [0, 1, 2].map((a) => scene.low[a] + scene.quantized[3 * vertex + a] * scene.step[a]);
}

function vertexMove(scene, vertex) {
  if (scene.edit) return [...scene.move.subarray(3 * vertex, 3 * vertex + 3)].map((x) => x * scene.space.scale);
  return [0, 1, 2].map((a) => scene.moves[3 * vertex + a] * scene.moveStep);
}

// A point of the file's units in the picture's.
function toPicture(scene, point) {
  const {center, scale} = scene.space;
  return point.map((x, a) => (x - center[a]) / scale);
}

// The part that each vertex belongs to; of several the first.
function partsOfVertices(scene) {
  const parts = new Int32Array(scene.vertices).fill(-1);
  scene.parts.forEach((part, index) => {
    for (let i = 3 * part.first; i < 3 * (part.first + part.count); i++) {
      const vertex = scene.triangleIndices[i];
      if (parts[vertex] < 0) parts[vertex] = index;
    }
  });
  return parts;
}
