// pick.js - what is under a click: a control point, else the nearest vertex of the triangle that a ray meets first.

const CONTROL_PIXELS = 9;

function blended(before, move, vertex, blend) {
  return [0, 1, 2].map((a) => before[3 * vertex + a] + blend * move[3 * vertex + a]);
}

// Moeller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997. Infinity: it misses.
function meet(eye, ray, p, q, r) {
  const e1x = q[0] - p[0], e1y = q[1] - p[1], e1z = q[2] - p[2], e2x = r[0] - p[0], e2y = r[1] - p[1], e2z = r[2] - p[2];
  const hx = ray[1] * e2z - ray[2] * e2y, hy = ray[2] * e2x - ray[0] * e2z, hz = ray[0] * e2y - ray[1] * e2x;
  const det = e1x * hx + e1y * hy + e1z * hz;
  if (det === 0) return Infinity;
  const sx = eye[0] - p[0], sy = eye[1] - p[1], sz = eye[2] - p[2];
  const u = (sx * hx + sy * hy + sz * hz) / det;
  if (!(u >= 0 && u <= 1)) return Infinity;
  const kx = sy * e1z - sz * e1y, ky = sz * e1x - sx * e1z, kz = sx * e1y - sy * e1x;
  const v = (ray[0] * kx + ray[1] * ky + ray[2] * kz) / det;
  const far = (e2x * kx + e2y * ky + e2z * kz) / det;
  return v >= 0 && u + v <= 1 && far > 0 ? far : Infinity;
}

// The triangle that a ray meets first, in the parts that are shown; -1: none.
function findTriangle(scene, hidden, blend, eye, ray) {
  const {before, move, triangleIndices: list} = scene;
  const p = [0, 0, 0], q = [0, 0, 0], r = [0, 0, 0];
  const load = (to, v) => {
    to[0] = before[3 * v] + blend * move[3 * v];
    to[1] = before[3 * v + 1] + blend * move[3 * v + 1];
    to[2] = before[3 * v + 2] + blend * move[3 * v + 2];
  };
  let best = -1, least = Infinity;
  scene.parts.forEach((part, index) => {
    if (hidden.has(index)) return;
    for (let t = part.first; t < part.first + part.count; t++) {
      load(p, list[3 * t]);
      load(q, list[3 * t + 1]);
      load(r, list[3 * t + 2]);
      const far = meet(eye, ray, p, q, r);
      if (far < least) {
        least = far;
        best = t;
      }
    }
  });
  return best;
}

// The one of some vertices, or control points, that is nearest to a place on the screen.
function findNearest(viewer, candidates, x, y, pixels) {
  let best = null, least = pixels * pixels;
  for (const candidate of candidates) {
    const seen = viewer.project(candidate.point);
    const far = seen ? (seen.x - x) ** 2 + (seen.y - y) ** 2 : Infinity;
    if (far < least) {
      least = far;
      best = candidate;
    }
  }
  return best;
}

function* listControls(scene, blend) {
  for (const cage of scene.cages) {
    for (let p = 0; p < cage.count; p++) {
      const point = [0, 1, 2].map((a) => cage.rest[3 * p + a] + blend * (cage.deformed[3 * p + a] - cage.rest[3 * p + a]));
      yield {cage, p, point: toPicture(scene, point)};
    }
  }
}

function pick(viewer, x, y) {
  const {scene, settings} = viewer;
  const {blend} = settings;
  const control = settings.showCage && !settings.isPosed ? findNearest(viewer, listControls(scene, blend), x, y, CONTROL_PIXELS) : null;
  if (control) return control;
  const ray = viewer.camera.ray(x, y, viewer.canvas.clientWidth, viewer.canvas.clientHeight);
  const triangle = findTriangle(scene, viewer.hidden, blend, viewer.matrices.eye, ray);
  const corners = triangle >= 0 ? [...scene.triangleIndices.subarray(3 * triangle, 3 * triangle + 3)] : [];
  const loose = triangle >= 0 ? corners : [...new Set([...scene.pointIndices, ...scene.segmentIndices])];
  const candidates = loose.map((vertex) => ({vertex, triangle, point: blended(scene.before, scene.move, vertex, blend)}));
  return findNearest(viewer, candidates, x, y, triangle >= 0 ? Infinity : 10);
}
