// rig.js - what moves the mesh over time: the page's skeletons and the keys of its animations (src/view/page_rig.h). A
// vertex is at the sum of share * world(node) * bind * anchor over the bones that it follows.

const STEP = 0, CUBIC = 2;
const ROTATION = 1, WEIGHTS = 3;
const FLAG_JOINT = 1, FLAG_MATRIX = 2;

function readSide(description, name) {
  if (!description) return null;
  const read = (block, Type) => readArray(`data-rig-${name}-${block}`, Type) || new Type(0);
  const side = {targets: description.targets, parents: read('parent', Int32Array), nodes: read('node', Float32Array),
    bones: read('bone', Uint32Array), binds: read('bind', Float32Array), weights: read('weight', Float32Array),
    channels: read('channel', Uint32Array), times: read('time', Float32Array), values: read('value', Float32Array),
    follows: read('follow', Uint16Array), anchors: read('anchor', Float32Array)};
  const offsets = read('offset', Uint32Array);
  side.movedVertices = offsets;
  side.offsets = new Float32Array(offsets.buffer, 0, offsets.length);
  return side;
}

// The after side follows the bones before where it has none of its own.
function readRig(scene) {
  const {rig} = scene;
  if (!rig) return null;
  const [before, after] = ['before', 'after'].map((name, number) => readSide(rig.sides[number], name));
  if (after && rig.isShared) {
    for (const key of ['parents', 'nodes', 'bones', 'binds', 'weights', 'channels', 'times', 'values', 'follows']) after[key] = before[key];
  }
  return {...rig, sides: [before, after]};
}

function isChannelWhole(side, channel, nodes) {
  const [target, path, kind, keys, width, time, value] = side.channels.subarray(7 * channel, 7 * channel + 7);
  return keys > 0 && time + keys <= side.times.length && value + keys * width * (kind === CUBIC ? 3 : 1) <= side.values.length &&
      (path === WEIGHTS ? target + width <= side.weights.length : target < nodes && width === (path === ROTATION ? 4 : 3));
}

// Whether all arrays are there from end to end.
function isSideWhole(side, vertices, channels) {
  const nodes = side.nodes.length / 12, {length: bones} = side.bones;
  const isMoved = side.anchors.length > 0;
  let offsets = 0;
  for (const [weight, count] of side.targets) {
    if (weight >= side.weights.length) return false;
    offsets += 4 * count;
  }
  if (side.parents.length !== 2 * nodes || side.binds.length !== 12 * bones || side.offsets.length !== offsets ||
      (isMoved && (side.anchors.length !== 3 * vertices || side.follows.length !== 8 * vertices))) return false;
  for (let n = 0; n < nodes; n++) if (side.parents[2 * n] >= n) return false;
  for (const node of side.bones) if (node >= nodes) return false;
  for (let i = 0; i < side.follows.length; i++) if (i % 8 < 4 && side.follows[i] >= bones) return false;
  for (let c = 0; c < channels; c++) if (!isChannelWhole(side, c, nodes)) return false;
  return true;
}

function isRigWhole(rig, vertices) {
  return rig.sides.every((side, number) => {
    const ranges = rig.animations.map((animation) => animation.channels[number]).filter(Boolean);
    return !side || isSideWhole(side, vertices, Math.max(0, ...ranges.map(([first, count]) => first + count)));
  });
}

function slerp(a, at, b, bt, share, to) {
  let cosine = 0;
  for (let i = 0; i < 4; i++) cosine += a[at + i] * b[bt + i];
  const sign = cosine >= 0 ? 1 : -1, square = 1 - cosine * cosine;
  let from = 1 - share, toward = share;
  const isArc = square > Number.EPSILON;
  if (isArc) {
    const sine = Math.sqrt(square), arc = Math.atan2(sine, cosine * sign);
    from = Math.sin((1 - share) * arc) / sine;
    toward = Math.sin(share * arc) / sine;
  }
  for (let i = 0; i < 4; i++) to[i] = a[at + i] * from + b[bt + i] * toward * sign;
  if (!isArc) normalize(to);
}

function normalize(q) {
  const length = Math.hypot(q[0], q[1], q[2], q[3]) || 1;
  for (let i = 0; i < 4; i++) q[i] /= length;
}

// The last key that is not behind the time; the first one if all are.
function findKey(times, first, count, time) {
  let low = 0, high = count;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[first + middle] <= time) low = middle;
    else high = middle;
  }
  return low;
}

// The value of a channel at a time, into an array that is long enough (glTF 2.0, appendix C).
function sampleChannel(side, channel, time, to) {
  const [, path, kind, keys, width, first, place] = side.channels.subarray(7 * channel, 7 * channel + 7);
  const {times, values} = side;
  const key = findKey(times, first, keys, time);
  const begin = times[first + key];
  const at = place + width * (kind === CUBIC ? 3 * key + 1 : key);
  if (key + 1 === keys || !(time > begin) || kind === STEP) {
    for (let i = 0; i < width; i++) to[i] = values[at + i];
    return;
  }
  const span = times[first + key + 1] - begin, u = (time - begin) / span;
  if (kind === CUBIC) {
    const uu = u * u, uuu = uu * u;
    for (let i = 0; i < width; i++) {
      to[i] = (2 * uuu - 3 * uu + 1) * values[at + i] + span * (uuu - 2 * uu + u) * values[at + width + i] +
          (3 * uu - 2 * uuu) * values[at + 3 * width + i] + span * (uuu - uu) * values[at + 2 * width + i];
    }
    if (path === ROTATION) normalize(to);
  } else if (path === ROTATION) {
    slerp(values, at, values, at + width, u, to);
  } else {
    for (let i = 0; i < width; i++) to[i] = values[at + i] * (1 - u) + values[at + width + i] * u;
  }
}

// out = a b, of 12 numbers each: linear row by row, and offset.
function joinMatrices(a, at, b, bt, out, to) {
  for (let r = 0; r < 3; r++) {
    const x = a[at + 3 * r], y = a[at + 3 * r + 1], z = a[at + 3 * r + 2];
    for (let c = 0; c < 3; c++) out[to + 3 * r + c] = x * b[bt + c] + y * b[bt + 3 + c] + z * b[bt + 6 + c];
    out[to + 9 + r] = x * b[bt + 9] + y * b[bt + 10] + z * b[bt + 11] + a[at + 9 + r];
  }
}

function localMatrix(nodes, at, isMatrix, out) {
  if (isMatrix) {
    for (let i = 0; i < 12; i++) out[i] = nodes[at + i];
    return;
  }
  const [x, y, z, w] = [nodes[at + 3], nodes[at + 4], nodes[at + 5], nodes[at + 6]];
  const turn = [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 2 * (x * y + z * w), 1 - 2 * (x * x + z * z),
    2 * (y * z - x * w), 2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)];
  for (let i = 0; i < 9; i++) out[i] = turn[i] * nodes[at + 7 + (i % 3)];
  for (let a = 0; a < 3; a++) out[9 + a] = nodes[at + a];
}

// The matrices of all nodes and the weights at a time; range: the channels [first, count] of an animation, or null.
function poseNodes(side, range, time) {
  const count = side.nodes.length / 12;
  const nodes = Float64Array.from(side.nodes), weights = Float64Array.from(side.weights), worlds = new Float64Array(12 * count);
  const [first, channels] = range || [0, 0];
  for (let c = first; c < first + channels; c++) {
    const target = side.channels[7 * c], path = side.channels[7 * c + 1];
    sampleChannel(side, c, time, path === WEIGHTS ? weights.subarray(target) : nodes.subarray(12 * target + [0, 3, 7][path]));
  }
  const local = new Float64Array(12);
  for (let n = 0; n < count; n++) {
    const parent = side.parents[2 * n];
    localMatrix(nodes, 12 * n, side.parents[2 * n + 1] & FLAG_MATRIX, local);
    if (parent < 0) worlds.set(local, 12 * n);
    else joinMatrices(worlds, 12 * parent, local, 0, worlds, 12 * n);
  }
  return {worlds, weights};
}

// The matrices of the bones, which take anchors to the picture's units.
function poseBones(scene, side, worlds) {
  const {center, scale} = scene.space;
  const bones = new Float64Array(side.binds.length);
  side.bones.forEach((node, b) => {
    joinMatrices(worlds, 12 * node, side.binds, 12 * b, bones, 12 * b);
    for (let i = 0; i < 9; i++) bones[12 * b + i] /= scale;
    for (let a = 0; a < 3; a++) bones[12 * b + 9 + a] = (bones[12 * b + 9 + a] - center[a]) / scale;
  });
  return bones;
}

// The anchors with the offsets of morph targets, by how much their weights differ from those at rest.
function morphAnchors(side, weights) {
  let points = side.anchors, at = 0;
  for (const [weight, count] of side.targets) {
    const by = weights[weight] - side.weights[weight];
    if (by !== 0 && points === side.anchors) points = side.anchors.slice();
    for (let i = at; by !== 0 && i < at + 4 * count; i += 4) {
      for (let a = 0; a < 3; a++) points[3 * side.movedVertices[i] + a] += by * side.offsets[i + 1 + a];
    }
    at += 4 * count;
  }
  return points;
}

// The matrix that a vertex follows.
function blendBones(side, bones, vertex, out) {
  const {follows} = side, at = 8 * vertex;
  out.fill(0);
  for (let i = 0; i < 4; i++) {
    const share = follows[at + 4 + i] / 65535, bone = 12 * follows[at + i];
    if (share === 0) continue;
    for (let k = 0; k < 12; k++) out[k] += share * bones[bone + k];
  }
}

// Where the vertices of a side are at a time of an animation, in the picture's units.
function poseSide(scene, number, animation, time) {
  const {rig} = scene;
  const side = rig.sides[number];
  const isStill = !side || side.anchors.length === 0 || !animation.channels[number];
  if (isStill) return null;
  const {worlds, weights} = poseNodes(side, animation.channels[number], time);
  const bones = poseBones(scene, side, worlds);
  const anchors = morphAnchors(side, weights);
  const points = new Float32Array(3 * scene.vertices), matrix = new Float64Array(12);
  for (let v = 0; v < scene.vertices; v++) {
    blendBones(side, bones, v, matrix);
    const x = anchors[3 * v], y = anchors[3 * v + 1], z = anchors[3 * v + 2];
    for (let a = 0; a < 3; a++) points[3 * v + a] = matrix[3 * a] * x + matrix[3 * a + 1] * y + matrix[3 * a + 2] * z + matrix[9 + a];
  }
  return {points, bones, worlds, side, weights, driven: drivenWeights(side, animation.channels[number])};
}

// Sets before and move of a scene to a time of an animation, null: to rest, and to the weights of its sliders. Returns the
// poses of both sides, null where one stands still, with isMorphed: whether targets have other weights than in the file.
function poseScene(scene, animation, time) {
  const {rest, targets} = scene;
  const poses = [0, 1].map((number) => (animation ? poseSide(scene, number, animation, time) : null));
  const isOne = animation && !scene.rig.hasAfter;
  if (isOne && poses[0]) poses[1] = {...poses[0], points: poses[0].points.slice()};
  const after = poses[1] ? poses[1].points : rest.before.map((x, i) => x + rest.move[i]);
  scene.before.set(poses[0] ? poses[0].points : rest.before);
  const added = [scene.before, after].map((points, number) => addTargets(scene, targets[number], poses[number], points));
  poses.isMorphed = added.includes(true) || poses.some((pose) => pose && isPoseMorphed(pose));
  const isStill = !poses[0] && !poses[1] && !poses.isMorphed;
  for (let i = 0; i < scene.move.length; i++) scene.move[i] = isStill ? rest.move[i] : after[i] - scene.before[i];
  return poses;
}

// Lines from each joint to the one above it, and the joints, as marks of the renderer; in the pose, or at rest.
function jointMarks(scene, animation, time) {
  const {rig} = scene;
  const places = rig.sides.map((side, number) => {
    const of = side || (number === 1 ? rig.sides[0] : null);
    return of ? poseNodes(of, animation ? animation.channels[side ? number : 0] : null, time).worlds : null;
  });
  const lines = [], points = [];
  const {parents} = rig.sides[0];
  const isOne = !rig.sides[1] || rig.isShared;
  const put = (list, n) => {
    const at = (worlds) => toPicture(scene, [...worlds.subarray(12 * n + 9, 12 * n + 12)]);
    const from = at(places[0]);
    const to = isOne || 12 * n + 12 > places[1].length ? from : at(places[1]);
    list.push(...from, ...to.map((x, a) => x - from[a]));
  };
  const joints = new Int32Array(parents.length / 2);  // of each node: it, or the next joint above it
  for (let n = 0; n < joints.length; n++) {
    const above = parents[2 * n] < 0 ? -1 : joints[parents[2 * n]];
    const isJoint = parents[2 * n + 1] & FLAG_JOINT;
    joints[n] = isJoint ? n : above;
    if (!isJoint) continue;
    put(points, n);
    if (above < 0) continue;
    put(lines, n);
    put(lines, above);
  }
  return {lines, points};
}

function countJoints(rig) {
  return rig ? rig.sides[0].parents.filter((flags, i) => i % 2 && flags & FLAG_JOINT).length : 0;
}
