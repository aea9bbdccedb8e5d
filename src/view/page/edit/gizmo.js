// gizmo.js - handles at the selection's middle, with which it is moved, turned and scaled. In the picture's units.

const GIZMO_PIXELS = 84;
const GRAB_PIXELS = 10;
const RING_STEPS = 40;
const AXIS_NAMES = ['x', 'y', 'z'];
const AXIS_COLORS = [[0.9, 0.2, 0.2, 1], [0.15, 0.62, 0.2, 1], [0.2, 0.4, 0.95, 1]];
const CENTER_COLOR = [1, 0.78, 0.1, 1];

function plus(a, b, share = 1) {
  return a.map((x, k) => x + share * b[k]);
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// How long the handles are, in the picture's units, where the middle is.
function gizmoSize(viewer, center) {
  const seen = viewer.project(center);
  const height = viewer.canvas.clientHeight || 1;
  return seen ? 2 * seen.depth * Math.tan(FIELD_OF_VIEW / 2) * GIZMO_PIXELS / height : 0;
}

// The points of a ring about an axis.
function ringPoints(center, axis, size) {
  const [b, c] = [(axis + 1) % 3, (axis + 2) % 3], points = [];
  for (let i = 0; i <= RING_STEPS; i++) {
    const point = [...center], angle = 2 * Math.PI * i / RING_STEPS;
    point[b] += size * Math.cos(angle);
    point[c] += size * Math.sin(angle);
    points.push(point);
  }
  return points;
}

// The corners of a small square between two axes, which moves in their plane.
function planeCorners(center, normal, size) {
  const [b, c] = [(normal + 1) % 3, (normal + 2) % 3];
  return [[0.28, 0.28], [0.5, 0.28], [0.5, 0.5], [0.28, 0.5], [0.28, 0.28]].map(([s, t]) => {
    const point = [...center];
    point[b] += s * size;
    point[c] += t * size;
    return point;
  });
}

function linesOf(points) {
  const lines = [];
  for (let i = 0; i + 1 < points.length; i++) lines.push(...points[i], 0, 0, 0, ...points[i + 1], 0, 0, 0);
  return lines;
}

// The handles of a mode: what they are drawn as, and what they do.
function listHandles(mode, center, size) {
  const handles = [];
  for (let axis = 0; axis < 3; axis++) {
    const end = [...center];
    end[axis] += size;
    if (mode === 'rotate') {
      handles.push({kind: 'ring', axis, lines: linesOf(ringPoints(center, axis, size)), grabs: ringPoints(center, axis, size), color: AXIS_COLORS[axis]});
      continue;
    }
    const grabs = [0.45, 0.6, 0.75, 0.9, 1].map((share) => plus(center, plus(end, center, -1), share));
    handles.push({kind: 'axis', axis, lines: linesOf([center, end]), points: end, grabs, color: AXIS_COLORS[axis]});
    if (mode === 'move') {
      const corners = planeCorners(center, axis, size), middle = corners[0].map((x, a) => (x + corners[2][a]) / 2);
      handles.push({kind: 'plane', axis, lines: linesOf(corners), grabs: [middle], color: AXIS_COLORS[axis]});
    }
  }
  if (mode !== 'rotate') handles.push({kind: 'center', points: center, grabs: [center], color: CENTER_COLOR});
  return handles;
}

// The handle at a place of the screen.
function findHandle(viewer, handles, x, y) {
  let best = null, least = GRAB_PIXELS;
  for (const handle of handles) {
    for (const grab of handle.grabs) {
      const seen = viewer.project(grab);
      const far = seen ? Math.hypot(seen.x - x, seen.y - y) : Infinity;
      if (far < least) {
        least = far;
        best = handle;
      }
    }
  }
  return best;
}

// Where a ray through the screen meets a plane; null: nowhere in front.
function meetPlane(viewer, x, y, point, normal) {
  const {eye} = viewer.matrices, ray = viewer.camera.ray(x, y, viewer.canvas.clientWidth, viewer.canvas.clientHeight), slope = dot(ray, normal);
  if (Math.abs(slope) < 1e-6 * Math.hypot(...ray)) return null;
  const far = dot(plus(point, eye, -1), normal) / slope;
  return far > 0 ? plus(eye, ray, far) : null;
}

// How far along an axis a way on the screen leads.
function alongAxis(viewer, center, axis, from, to) {
  const small = gizmoSize(viewer, center) / 10, tip = [...center];
  tip[axis] += small;
  const a = viewer.project(center), b = viewer.project(tip);
  if (!a || !b) return 0;
  const dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  return square > 1e-6 ? small * ((to[0] - from[0]) * dx + (to[1] - from[1]) * dy) / square : 0;
}

// The movement in the picture's units that a drag of a handle is; axis: -1 without one.
function movementOf(viewer, kind, axis, center, from, to) {
  if (kind === 'axis') {
    const by = [0, 0, 0];
    by[axis] = alongAxis(viewer, center, axis, from, to);
    return by;
  }
  const normal = kind === 'plane' ? [0, 1, 2].map((a) => (a === axis ? 1 : 0)) : viewer.matrices.back;
  const begin = meetPlane(viewer, ...from, center, normal), end = meetPlane(viewer, ...to, center, normal);
  return begin && end ? plus(end, begin, -1) : [0, 0, 0];
}

// The angle, in degrees, by which a drag of a ring turns about an axis.
function angleOf(viewer, axis, center, from, to) {
  const seen = viewer.project(center);
  if (!seen) return 0;
  const angle = (p) => Math.atan2(p[1] - seen.y, p[0] - seen.x);
  const turned = Math.atan2(Math.sin(angle(to) - angle(from)), Math.cos(angle(to) - angle(from)));
  // On the screen y points down; an axis that points to the eye turns against the clock.
  const isTowards = plus(viewer.matrices.eye, center, -1)[axis] > 0;
  return (isTowards ? -1 : 1) * turned * 180 / Math.PI;
}

// The factor of a drag of a handle for scaling.
function factorOf(viewer, center, from, to) {
  const seen = viewer.project(center);
  const far = (p) => Math.max(1, Math.hypot(p[0] - seen.x, p[1] - seen.y));
  return seen ? far(to) / far(from) : 1;
}
