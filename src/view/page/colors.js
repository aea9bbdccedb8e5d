// colors.js - what a mesh is coloured by, and the legend of each.

const UNKNOWN_COLOR = [0.58, 0.6, 0.63];
const FOLDED_COLOR = [0.85, 0.12, 0.72];
const GREY = [0.5, 0.52, 0.55, 1];  // linear: of what has no material
// By ffd_vertex_status.
const STATUS_COLORS = [[74, 144, 217], [160, 164, 170], [240, 160, 32], [150, 96, 210], [214, 40, 40]];

// viridis (van der Walt, Smith), and a ramp from blue over white to red.
const SEQUENTIAL = ['440154', '482878', '3e4989', '31688e', '26828e', '1f9e89', '35b779', '6ece58', 'b5de2b', 'fde725'];
const DIVERGING = ['1d3f8f', '2f66b8', '5b95d3', '9cc3e6', 'd7e6f2', 'f6f6f4', 'f7dccb', 'f0b08f', 'dd7757', 'bd3a33', '8a1222'];

function fromHex(text) {
  return [0, 2, 4].map((at) => parseInt(text.slice(at, at + 2), 16));
}

// 256 colours, four bytes each.
function makeRamp(stops) {
  const colors = stops.map(fromHex);
  const ramp = new Uint8Array(1024);
  for (let i = 0; i < 256; i++) {
    const at = (i / 255) * (colors.length - 1);
    const low = Math.min(Math.floor(at), colors.length - 2);
    for (let c = 0; c < 3; c++) ramp[4 * i + c] = colors[low][c] + (at - low) * (colors[low + 1][c] - colors[low][c]) + 0.5;
    ramp[4 * i + 3] = 255;
  }
  return ramp;
}

function pack([r, g, b]) {
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

// The base colour of a material, linear, with its opacity; undefined: there is none. A white one without a texture, or
// colours of the vertices, is a little darker, so that it shows its shape; one whose texture is lost is grey.
function baseColor(material, hasColors) {
  if (!material) return hasColors ? [1, 1, 1, 1] : GREY;
  if (material.lost) return [0.47, 0.49, 0.52, 1];
  const [r, g, b, a] = material.color.map((x) => Math.min(Math.max(x || 0, 0), 1));
  return Math.min(r, g, b) > 0.9 && !material.base && !hasColors ? [0.72, 0.72, 0.73, a] : [r, g, b, a];
}

// Whether the mesh has colours to be looked at: textures, colours of vertices, or of materials that are not all white.
function hasOwnColors(scene) {
  const isColored = ({material}) => {
    const of = scene.materials[material];
    return of && (of.base || of.color.slice(0, 3).some((x) => x < 0.9));
  };
  return Boolean(scene.colors) || scene.parts.some(isColored);
}

function lengthsOf(scene) {
  const lengths = new Float32Array(scene.vertices);
  for (let v = 0; v < scene.vertices; v++) {
    lengths[v] = scene.moveStep * Math.hypot(scene.moves[3 * v], scene.moves[3 * v + 1], scene.moves[3 * v + 2]);
  }
  return lengths;
}

// Powers of two round 1 within which all det F are, at most 16 and 1/16.
function detSpan(dets) {
  let most = 0;
  for (const det of dets) {
    if (det > 0) most = Math.max(most, Math.abs(Math.log2(det)));
  }
  return Math.min(Math.max(most, 0.05), 4);
}

// The colourings that a scene has: key, label, and what the renderer needs.
function listPaints(scene) {
  const paints = [];
  const lengths = lengthsOf(scene);
  const most = lengths.reduce((a, b) => Math.max(a, b), 0);
  if (most > 0) {
    paints.push({key: 'displacement', label: 'Displacement', mode: 1, values: lengths, ramp: makeRamp(SEQUENTIAL),
      stops: SEQUENTIAL, range: [0, most]});
  }
  if (scene.statuses) {
    const colors = Uint32Array.from(scene.statuses, (status) => pack(STATUS_COLORS[Math.min(status, 4)]));
    paints.push({key: 'status', label: 'Status', mode: 3, colors, range: [0, 1]});
  }
  if (scene.dets && scene.dets.some((det) => !Number.isNaN(det))) {
    const span = detSpan(scene.dets);
    paints.push({key: 'det', label: 'det F', mode: 2, values: scene.dets, ramp: makeRamp(DIVERGING), stops: DIVERGING,
      range: [-span, span], span});
  }
  const colors = scene.colors ? new Uint32Array(scene.colors.buffer, 0, scene.vertices) : null;
  paints.push({key: 'plain', label: 'Plain', mode: 0, colors, range: [0, 1]});
  return paints;
}

// The colour of a vertex that is not lit, 0 to 1.
function paintOf(scene, paint, vertex) {
  if (!paint.ramp) {
    const color = paint.colors ? paint.colors[vertex] : 0xffffffff;
    return [0, 8, 16].map((shift) => (color >>> shift & 255) / 255);
  }
  const value = paint.values[vertex];
  if (Number.isNaN(value)) return UNKNOWN_COLOR;
  if (paint.mode === 2 && value <= 0) return FOLDED_COLOR;
  const [low, high] = paint.range, share = ((paint.mode === 2 ? Math.log2(value) : value) - low) / (high - low || 1);
  const at = 4 * Math.round(255 * Math.min(Math.max(share, 0), 1));
  return [0, 1, 2].map((c) => paint.ramp[at + c] / 255);
}

function swatch(color, text, extra) {
  const box = make('i', 'swatch');
  box.style.background = color;
  const line = make('li', '', box, text);
  if (extra) line.append(make('b', '', extra));
  return line;
}

// A bar with texts below it: [place from 0 to 1, text].
function barLegend(title, stops, ticks) {
  const bar = make('div', 'ramp');
  bar.style.background = `linear-gradient(to right, ${stops.map((s) => '#' + s).join(', ')})`;
  const texts = make('div', 'ticks');
  ticks.forEach(([place, text], index) => {
    const tick = make('span', index === 0 ? 'first' : index === ticks.length - 1 ? 'last' : '', text);
    tick.style.left = `${100 * place}%`;
    texts.append(tick);
  });
  return [make('p', 'title', title), bar, texts];
}

function statusLegend(scene) {
  const counts = [0, 0, 0, 0, 0];
  scene.statuses.forEach((status) => counts[Math.min(status, 4)]++);
  const list = make('ul', 'swatches');
  counts.forEach((count, status) => {
    if (count || status < 2) list.append(swatch(`rgb(${STATUS_COLORS[status]})`, STATUS_NAMES[status], numberText(count)));
  });
  return [make('p', 'title', 'Status of the vertices'), list];
}

function detLegend(scene, paint) {
  const {span} = paint;
  const text = (power) => numberText(2 ** power, 3);
  const parts = barLegend('det F: volume after, relative to before', paint.stops,
    [[0, text(-span)], [0.25, text(-span / 2)], [0.5, '1'], [0.75, text(span / 2)], [1, text(span)]]);
  const list = make('ul', 'swatches');
  const rgb = (color) => `rgb(${color.map((x) => Math.round(255 * x))})`;
  if (paint.values.some((det) => det <= 0)) list.append(swatch(rgb(FOLDED_COLOR), 'at most 0: folded'));
  if (paint.values.some((det) => Number.isNaN(det))) list.append(swatch(rgb(UNKNOWN_COLOR), 'not known'));
  return [...parts, list];
}

function plainLegend(scene) {
  const used = scene.parts.map(({material}) => scene.materials[material]).filter((of) => of);
  const what = [];
  if (used.some((of) => of.base || of.glow)) what.push('textures');
  if (scene.colors) what.push('colours of the vertices');
  if (!what.length) what.push('colours of the materials');
  const isLost = used.some((of) => of.lost);
  return [make('p', 'title', 'As it is: ' + what.join(' and ')), ...(isLost ? [make('p', '', 'Grey: a texture that is not there.')] : [])];
}

function showLegend(scene, paint) {
  const legend = byId('legend');
  let content;
  if (paint.key === 'displacement') {
    const ticks = [0, 0.25, 0.5, 0.75, 1].map((share) => [share, numberText(share * paint.range[1], 3)]);
    content = barLegend('Displacement, in units of the file', paint.stops, ticks);
  } else if (paint.key === 'status') {
    content = statusLegend(scene);
  } else if (paint.key === 'det') {
    content = detLegend(scene, paint);
  } else {
    content = plainLegend(scene);
  }
  legend.replaceChildren(...content);
}
