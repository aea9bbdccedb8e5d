// morph.js - morph targets: their sliders, and what they add to both shapes (src/view/page_targets.h).

const TARGET_STEPS = 100;  // of a slider, from 0 to 1

// Of each side its targets; the side after shares those before where they are the same.
function readTargets(scene) {
  const vertices = readArray('data-target-vertex', Uint32Array) || new Uint32Array(0);
  const offsets = readArray('data-target-offset', Int16Array) || new Int16Array(0);
  let at = 0;
  const sides = scene.targets.map((list) => list.map(([slider, count, step, rigWeight]) => {
    const target = {slider, step, rigWeight, vertices: vertices.subarray(at, at + count), offsets: offsets.subarray(3 * at, 3 * (at + count))};
    at += count;
    return target;
  }));
  const isWhole = vertices.length === at && offsets.length === 3 * at && vertices.every((v) => v < scene.vertices) &&
      sides.every((list) => list.every(({slider}) => slider < scene.sliders.length));
  return isWhole ? [sides[0], scene.sameTargets ? sides[0] : sides[1]] : null;
}

// What an animation drives on a side: a set of indices in the weights of its skeleton.
function drivenWeights(side, range) {
  const driven = new Set();
  const [first, count] = (side && range) || [0, 0];
  for (let c = first; c < first + count; c++) {
    const [target, path, , , width] = side.channels.subarray(7 * c, 7 * c + 7);
    for (let i = 0; path === WEIGHTS && i < width; i++) driven.add(target + i);
  }
  return driven;
}

// Adds to the points of a side what its targets move them by, as far as sliders differ from the weights of the shape. In a
// pose an offset turns with the bones of its vertex, from where these are at rest; what the animation drives is in the pose.
// Returns whether anything was added.
function addTargets(scene, targets, pose, points) {
  const from = new Float64Array(12), to = new Float64Array(12), offset = [0, 0, 0];
  let isMorphed = false;
  for (const target of targets) {
    const {value, weight} = scene.sliders[target.slider];
    const by = (value - weight) * target.step / scene.space.scale;
    if (by === 0 || (pose && pose.driven.has(target.rigWeight))) continue;
    isMorphed = true;
    for (let i = 0; i < target.vertices.length; i++) {
      const v = target.vertices[i];
      for (let a = 0; a < 3; a++) offset[a] = by * target.offsets[3 * i + a];
      if (pose) {
        blendBones(pose.side, restBones(scene, pose.side), v, from);
        blendBones(pose.side, pose.bones, v, to);
        turnOffset(from, to, offset);
      }
      for (let a = 0; a < 3; a++) points[3 * v + a] += offset[a];
    }
  }
  return isMorphed;
}

function restBones(scene, side) {
  side.restBones = side.restBones || poseBones(scene, side, poseNodes(side, null).worlds);
  return side.restBones;
}

// offset = to from^-1 offset, by Cramer's rule; nothing where there is no inverse.
function turnOffset(from, to, offset) {
  const [a, b, c, d, e, f, g, h, k] = from;
  const [x, y, z] = offset;
  const det = a * (e * k - f * h) - b * (d * k - f * g) + c * (d * h - e * g);
  const p = det ? (x * (e * k - f * h) - b * (y * k - f * z) + c * (y * h - e * z)) / det : 0;
  const q = det ? (a * (y * k - f * z) - x * (d * k - f * g) + c * (d * z - y * g)) / det : 0;
  const r = det ? (a * (e * z - y * h) - b * (d * z - y * g) + x * (d * h - e * g)) / det : 0;
  for (let i = 0; i < 3; i++) offset[i] = to[3 * i] * p + to[3 * i + 1] * q + to[3 * i + 2] * r;
}

// Whether a pose has other weights than the file shows at rest.
function isPoseMorphed(pose) {
  return pose.side.targets.some(([weight]) => pose.weights[weight] !== pose.side.weights[weight]);
}

// The weights that sliders show: those of the animation where this drives them.
function shownWeights(scene, poses) {
  const weights = scene.sliders.map(({value}) => value);
  poses.forEach((pose, number) => {
    for (const {slider, rigWeight} of pose ? scene.targets[number] : []) {
      if (pose.driven.has(rigWeight)) weights[slider] = pose.weights[rigWeight];
    }
  });
  return weights;
}

// The rows of the panel.
function targetSection(viewer) {
  const {sliders} = viewer.scene;
  if (!sliders.length) return null;
  const list = make('div', 'list targets');
  list.tabIndex = 0;
  list.setAttribute('role', 'group');
  list.setAttribute('aria-label', 'Morph targets');
  for (const slider of sliders) {
    const input = make('input'), value = make('output', 'count');
    Object.assign(input, {type: 'range', step: 1 / TARGET_STEPS, min: Math.min(0, Math.floor(slider.weight)), max: Math.max(1, Math.ceil(slider.weight))});
    slider.show = (weight) => {
      input.value = weight;
      value.textContent = numberText(weight, 3);
    };
    slider.show(slider.weight);
    input.addEventListener('input', () => viewer.setTarget(slider, Number(input.value)));
    list.append(make('label', 'target', nameElement(slider.name), input, value));
  }
  const reset = button('As in the file', () => {
    for (const slider of sliders) slider.value = slider.weight;
    viewer.setTarget(sliders[0], sliders[0].weight);
  });
  const card = section(`Morph targets (${numberText(sliders.length)})`, make('div', 'tools', reset), list);
  card.id = 'targets';
  return card;
}
