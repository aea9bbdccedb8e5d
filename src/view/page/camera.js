// camera.js - where one looks from: it turns round a target, in perspective. All in the picture's units.

const FIELD_OF_VIEW = (28 * Math.PI) / 180;
const MOST_PITCH = Math.PI / 2 - 0.001;
// yaw is turned from +z to +x
const VIEWS = {
  front: [0, 0], back: [Math.PI, 0], left: [-Math.PI / 2, 0], right: [Math.PI / 2, 0], top: [0, MOST_PITCH],
  bottom: [0, -MOST_PITCH],
  iso: [Math.PI / 5, Math.PI / 7],
};

function perspective(aspect, near, far) {
  const f = 1 / Math.tan(FIELD_OF_VIEW / 2);
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
    0, 0, (2 * far * near) / (near - far), 0]);
}

// At most so many points decide how far away the camera has to be.
const FIT_POINTS = 4000;

// Splats with less opacity, of 255, do not widen the picture.
const FAINT = 13;

// The mesh is from -1 to 1. Cages widen the picture by its largest extent on each side at most; one can go back from there.
const FIT_REACH = 3;

// Points of both shapes and of the cages, evenly chosen.
function listFitPoints(scene) {
  const points = [];
  const step = Math.ceil(scene.vertices / FIT_POINTS) || 1;
  for (let v = 0; v < scene.vertices; v += step) {
    if (scene.splats && scene.colors && scene.colors[4 * v + 3] < FAINT) continue;
    for (const share of [0, 1]) points.push([0, 1, 2].map((a) => scene.before[3 * v + a] + share * scene.move[3 * v + a]));
  }
  for (const cage of scene.cages) {
    const skip = Math.ceil(cage.count / FIT_POINTS) || 1;
    for (let p = 0; p < cage.count; p += skip) {
      for (const list of [cage.rest, cage.deformed]) points.push(toPicture(scene, [...list.subarray(3 * p, 3 * p + 3)]));
    }
  }
  return points;
}

// From axes in which y points upwards to those of the mesh, in which `up` does, and back.
const TURNS = {y: ([x, y, z]) => [x, y, z], z: ([x, y, z]) => [x, -z, y], x: ([x, y, z]) => [y, -x, z]};
const TURNS_BACK = {y: ([x, y, z]) => [x, y, z], z: ([x, y, z]) => [x, z, -y], x: ([x, y, z]) => [-y, x, z]};

class Camera {
  constructor(points, up = 'y') {
    this.upwards = up;
    this.hold(points);
    this.aspect = 1;
    this.target = [0, 0, 0];
    [this.yaw, this.pitch] = VIEWS.iso;
    this.distance = 4 * this.radius;
  }

  // When it fits, all of these points are in the picture as far as FIT_REACH goes.
  hold(points) {
    this.points = points;
    this.radius = points.reduce((most, p) => Math.max(most, Math.hypot(...p)), 0) || 1;
  }

  // Right, up and backwards, as the world has them.
  axes() {
    const {yaw, pitch} = this;
    const turn = TURNS[this.upwards];
    const back = [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
    const right = [Math.cos(yaw), 0, -Math.sin(yaw)];
    const up = [-Math.sin(yaw) * Math.sin(pitch), Math.cos(pitch), -Math.cos(yaw) * Math.sin(pitch)];
    return {right: turn(right), up: turn(up), back: turn(back)};
  }

  // Where it looks, and from how far, for all points to be seen: in the middle of them, as it sees them.
  fit() {
    const {right, up, back} = this.axes();
    const tangent = Math.tan(FIELD_OF_VIEW / 2);
    const slopes = [tangent * this.aspect * 0.92, tangent * (this.aspect < 1.3 ? 0.74 : 0.82)];
    const near = this.points.map((p) => p.map((x) => Math.min(Math.max(x, -FIT_REACH), FIT_REACH)));
    const seen = near.map((p) => [right, up, back].map((axis) => p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2]));
    let middle = [0, 0], distance = 0.05;
    // The point that needs most room on each side decides; perspective moves the middle, so that twice is nearer.
    for (let pass = 0; pass < 3; pass++) {
      const need = [0, 1].map((a) => [1, -1].map((side) =>
        seen.reduce((most, p) => Math.max(most, side * (p[a] - middle[a]) / slopes[a] + p[2]), -Infinity)));
      middle = middle.map((m, a) => m + (need[a][0] - need[a][1]) * slopes[a] / 2);
      distance = Math.max(0.05, ...need.map(([high, low]) => (high + low) / 2));
    }
    if (!Number.isFinite(distance)) return {target: [0, 0, 0], distance: 4};
    return {target: right.map((_, a) => middle[0] * right[a] + middle[1] * up[a]), distance};
  }

  matrices() {
    const {right, up, back} = this.axes();
    const eye = this.target.map((x, a) => x + this.distance * back[a]);
    const near = Math.max(this.distance - 2.5 * this.radius, this.distance * NEAR_SHARE);
    const far = this.distance + 3 * this.radius;
    const along = (axis) => -(eye[0] * axis[0] + eye[1] * axis[1] + eye[2] * axis[2]);
    const camera = new Float32Array([right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
      along(right), along(up), along(back), 1]);
    return {camera, projection: perspective(this.aspect, near, far), near, eye, right, up, back};
  }

  turn(yaw, pitch) {
    this.yaw += yaw;
    this.pitch = Math.min(Math.max(this.pitch + pitch, -MOST_PITCH), MOST_PITCH);
  }

  // By shares of the picture's height.
  shift(x, y) {
    const {right, up} = this.axes();
    const size = 2 * this.distance * Math.tan(FIELD_OF_VIEW / 2);
    this.target = this.target.map((t, a) => t - size * (x * right[a] - y * up[a]));
  }

  zoom(factor) {
    this.distance = Math.min(Math.max(this.distance * factor, 0.004), 40 * this.radius);
  }

  // Where a point is in a picture of that size, and how far away; null behind the eye.
  project(point, matrices, width, height) {
    const {camera, projection} = matrices;
    const seen = [0, 1, 2].map((r) => camera[r] * point[0] + camera[4 + r] * point[1] + camera[8 + r] * point[2] + camera[12 + r]);
    if (seen[2] >= -matrices.near * 0.5) return null;
    const x = (projection[0] * seen[0]) / -seen[2], y = (projection[5] * seen[1]) / -seen[2];
    return {x: (x + 1) / 2 * width, y: (1 - y) / 2 * height, depth: -seen[2]};
  }

  // The direction from the eye through a place of the picture.
  ray(x, y, width, height) {
    const {right, up, back} = this.axes();
    const tangent = Math.tan(FIELD_OF_VIEW / 2);
    const sx = (2 * x / width - 1) * tangent * this.aspect, sy = (1 - 2 * y / height) * tangent;
    return right.map((_, a) => sx * right[a] + sy * up[a] - back[a]);
  }
}

// Turns a direction in which the camera is, in the axes of the mesh, into yaw and pitch.
function anglesOf(direction, up = 'y') {
  const [x, y, z] = TURNS_BACK[up](direction);
  return [Math.atan2(x, z), Math.min(Math.max(Math.atan2(y, Math.hypot(x, z)), -MOST_PITCH), MOST_PITCH)];
}
