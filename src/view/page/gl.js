// gl.js - draws the scene with WebGL2: buffers once, then one picture for each state of camera, slider and settings.
// It is our own, as all it has to draw are surfaces, lines and discs: the whole page has a tenth of the size of three.js
// in Debian 12 (91 kB, 851 kB), needs no package for its build, and mixes both shapes on the graphics card.

const NEAR_SHARE = 0.02;
// Edges that wait for their other side; browsers end a set at 16 million.
const MOST_HALVES = 8000000;

function compile(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const places = {};
  for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; i >= 0; i--) {
    const {name} = gl.getActiveUniform(program, i);
    places[name] = gl.getUniformLocation(program, name);
  }
  return {program, places};
}

// A texture, of one grey pixel until its image is decoded.
function makeTexture(gl, wrap) {
  const wraps = {repeat: gl.REPEAT, mirror: gl.MIRRORED_REPEAT, clamp: gl.CLAMP_TO_EDGE};
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, Uint8Array.of(190, 192, 196, 255));
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wraps[wrap[0]]);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wraps[wrap[1]]);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  return texture;
}

// Decodes an image, no larger than the graphics card takes.
async function decodeImage(gl, blob) {
  const options = {premultiplyAlpha: 'none', colorSpaceConversion: 'none', imageOrientation: 'from-image'};
  const whole = await createImageBitmap(blob, options);
  const most = gl.getParameter(gl.MAX_TEXTURE_SIZE), side = Math.max(whole.width, whole.height);
  if (side <= most) return whole;
  const share = most / side;
  return createImageBitmap(blob, {...options, resizeQuality: 'high', resizeWidth: Math.max(1, Math.floor(share * whole.width)),
    resizeHeight: Math.max(1, Math.floor(share * whole.height))});
}

function fillTexture(gl, texture, bitmap) {
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
  gl.generateMipmap(gl.TEXTURE_2D);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  const sharp = gl.getExtension('EXT_texture_filter_anisotropic');
  if (sharp) gl.texParameterf(gl.TEXTURE_2D, sharp.TEXTURE_MAX_ANISOTROPY_EXT, 4);
}

function keyOf(use) {
  return use.image + ' ' + use.wrap;
}

// Whether an image is opaque everywhere, as far as a small copy shows.
function isOpaque(bitmap) {
  const canvas = new OffscreenCanvas(64, 64), context = canvas.getContext('2d');
  context.drawImage(bitmap, 0, 0, 64, 64);
  return context.getImageData(0, 0, 64, 64).data.every((value, i) => i % 4 < 3 || value === 255);
}

function makeBuffer(gl, kind, data) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(kind, buffer);
  gl.bufferData(kind, data, gl.STATIC_DRAW);
  return buffer;
}

function bindAttribute(gl, place, buffer, size, type, normalized, stride, offset, divisor) {
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, size, type, normalized, stride, offset);
  if (divisor) gl.vertexAttribDivisor(place, divisor);
}

// Three floats of each source, from an array of three for each vertex.
function gather(values, sources) {
  const result = new Float32Array(3 * sources.length);
  for (let i = 0; i < sources.length; i++) {
    for (let a = 0; a < 3; a++) result[3 * i + a] = values[3 * sources[i] + a];
  }
  return result;
}

// Coordinates of the drawn vertices in their textures, as the page has them.
function gatherTexcoords(scene, wedges, width) {
  const result = new Uint16Array(width * wedges.length);
  wedges.forEach((wedge, i) => {
    if (wedge >= 0) result.set(scene.wedges.texcoords.subarray(width * wedge, width * (wedge + 1)), width * i);
  });
  return result;
}

// Buffers of the mesh; `paint` holds two floats and a colour for each drawn vertex, set by setPaint.
function makeSurface(gl, scene) {
  const split = splitVertices(scene);
  const {sources, indices, drawn} = split;
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const before = makeBuffer(gl, gl.ARRAY_BUFFER, gather(scene.before, sources));
  bindAttribute(gl, 0, before, 3, gl.FLOAT, false, 0, 0);
  const move = makeBuffer(gl, gl.ARRAY_BUFFER, gather(scene.move, sources));
  bindAttribute(gl, 1, move, 3, gl.FLOAT, false, 0, 0);
  const normals = makeBuffer(gl, gl.ARRAY_BUFFER, split.normals);
  bindAttribute(gl, 2, normals, 3, gl.SHORT, true, 16, 0);
  bindAttribute(gl, 3, normals, 3, gl.SHORT, true, 16, 8);
  const values = makeBuffer(gl, gl.ARRAY_BUFFER, new Float32Array(2 * sources.length));
  bindAttribute(gl, 4, values, 2, gl.FLOAT, false, 0, 0);
  const colors = makeBuffer(gl, gl.ARRAY_BUFFER, new Uint8Array(4 * sources.length).fill(255));
  bindAttribute(gl, 5, colors, 4, gl.UNSIGNED_BYTE, true, 0, 0);
  if (scene.wedges) {
    const width = scene.texcoordLow.length;
    bindAttribute(gl, 6, makeBuffer(gl, gl.ARRAY_BUFFER, gatherTexcoords(scene, split.wedges, width)), width, gl.UNSIGNED_SHORT, true, 0, 0);
  }
  gl.bindVertexArray(null);
  const list = (from) => makeBuffer(gl, gl.ELEMENT_ARRAY_BUFFER, from.map((v) => drawn[v]));
  return {
    array, before, move, normals, split, values, colors, sources, indices,
    triangles: makeBuffer(gl, gl.ELEMENT_ARRAY_BUFFER, indices),
    segments: list(scene.segmentIndices),
    points: list(scene.pointIndices.filter((v) => !isSplat(scene, v))),
    flipped: {buffer: gl.createBuffer(), count: 0},
    edges: null,
  };
}

// Lines, twelve floats each; or discs, six.
function makeMarks(gl, floats, perMark) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const buffer = makeBuffer(gl, gl.ARRAY_BUFFER, Float32Array.from(floats));
  for (let a = 0; a < perMark / 3; a++) {
    bindAttribute(gl, a, buffer, 3, gl.FLOAT, false, 4 * perMark, 12 * a, perMark === 12 ? 1 : 0);
  }
  gl.bindVertexArray(null);
  return {array, buffer, count: floats.length / perMark};
}

function freeMarks(gl, marks) {
  if (!marks) return;
  gl.deleteVertexArray(marks.array);
  gl.deleteBuffer(marks.buffer);
}

// Whether a material lets through what is behind it.
function isBlended(material) {
  return Boolean(material) && material.alpha === 'blend' && !material.lost;
}

// Edges of the triangles that are shown: once each, but for borders that run the wrong way.
function makeEdges(gl, surface, runs) {
  const {indices} = surface;
  const lines = [];
  const halves = new Set();
  const key = (a, b) => a * surface.sources.length + b;
  for (const run of runs) {
    for (let t = 3 * run.first; t < 3 * run.end; t += 3) {
      for (let c = 0; c < 3; c++) {
        const a = indices[t + c], b = indices[t + (c + 1) % 3];
        if (halves.delete(key(b, a))) continue;
        if (halves.size >= MOST_HALVES) halves.clear();
        halves.add(key(a, b));
        lines.push(a, b);
      }
    }
  }
  return {buffer: makeBuffer(gl, gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(lines)), count: lines.length};
}

class Renderer {
  constructor(canvas, scene) {
    const gl = canvas.getContext('webgl2', {antialias: true, alpha: true, premultipliedAlpha: true, preserveDrawingBuffer: true});  // for paper
    if (!gl) throw new Error('WebGL2 is not there');
    this.gl = gl;
    this.canvas = canvas;
    this.scene = scene;
    this.programs = {
      surface: compile(gl, SURFACE_VERTEX, SURFACE_FRAGMENT),
      line: compile(gl, LINE_VERTEX, LINE_FRAGMENT),
      disc: compile(gl, DISC_VERTEX, DISC_FRAGMENT),
    };
    this.surface = makeSurface(gl, scene);
    this.splats = new Splats(gl, scene);
    this.ramp = gl.createTexture();
    this.textures = new Map();
    this.runs = [];
    this.marks = {};
  }

  // Decodes the textures, and calls `redraw` after each.
  loadTextures(redraw) {
    for (const material of this.scene.materials) {
      for (const use of [material.base, material.glow, material.opacity]) this.loadTexture(use, redraw);
    }
  }

  async loadTexture(use, redraw) {
    const {gl, scene, textures} = this;
    const blob = use ? scene.images[use.image] : null;
    if (!blob || textures.has(keyOf(use))) return;
    const texture = {of: makeTexture(gl, use.wrap), isOpaque: true};
    textures.set(keyOf(use), texture);
    try {
      const bitmap = await decodeImage(gl, blob);
      fillTexture(gl, texture.of, bitmap);
      texture.isOpaque = isOpaque(bitmap);
      bitmap.close();
    } catch (problem) {
      tellProblem('A texture of this page cannot be decoded.');
    }
    redraw();
  }

  // Values, colours and the ramp of a colouring (colors.js).
  setPaint(paint) {
    const {gl, surface} = this;
    this.paint = paint;
    const {sources} = surface;
    if (paint.values) {
      const values = new Float32Array(2 * sources.length);
      for (let i = 0; i < sources.length; i++) {
        const value = paint.values[sources[i]];
        const isKnown = !Number.isNaN(value);
        values[2 * i] = isKnown ? value : 0;
        values[2 * i + 1] = isKnown ? 1 : 0;
      }
      gl.bindBuffer(gl.ARRAY_BUFFER, surface.values);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    }
    const colors = new Uint32Array(sources.length).fill(0xffffffff);
    if (paint.colors) {
      for (let i = 0; i < sources.length; i++) colors[i] = paint.colors[sources[i]];
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, surface.colors);
    gl.bufferData(gl.ARRAY_BUFFER, colors, gl.STATIC_DRAW);
    if (paint.ramp) {
      gl.bindTexture(gl.TEXTURE_2D, this.ramp);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, paint.ramp);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    }
    this.splats.paint(paint);
    this.setParts(this.hidden || new Set());
  }

  // Runs of triangles that are drawn in one colour; flipped ones of the parts that are shown.
  setParts(hidden) {
    const {gl, scene, surface} = this;
    this.hidden = hidden;
    this.runs = [];
    const flipped = [];
    if (surface.edges) gl.deleteBuffer(surface.edges.buffer);
    surface.edges = null;
    scene.parts.forEach((part, index) => {
      if (hidden.has(index) || part.count === 0) return;
      const isPlain = this.paint && this.paint.mode === 0, material = isPlain ? part.material : null;
      const last = this.runs[this.runs.length - 1];
      if (last && last.end === part.first && last.material === material) last.end += part.count;
      else this.runs.push({first: part.first, end: part.first + part.count, material, of: isPlain ? scene.materials[part.material] : {color: [1, 1, 1, 1]}});
      for (let t = part.first; scene.flipped && t < part.first + part.count; t++) {
        if (scene.flipped[t]) flipped.push(...surface.indices.subarray(3 * t, 3 * t + 3));
      }
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, surface.flipped.buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(flipped), gl.STATIC_DRAW);
    surface.flipped.count = flipped.length;
  }

  // Brings the mesh to where its scene has been posed (rig.js).
  setPose(poses) {
    const {gl, scene, surface} = this;
    const normals = poses.isMorphed ? morphNormals(scene, surface.split) : poses[0] || poses[1] ? poseNormals(surface.split, poses, surface.split.normals) : surface.split.normals;
    for (const [buffer, values] of [[surface.before, gather(scene.before, surface.sources)],
      [surface.move, gather(scene.move, surface.sources)], [surface.normals, normals]]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    }
    this.splats.fill();
  }

  // Takes the positions after, and with them their normals, as the scene has them now.
  updateMove(withNormals) {
    const {gl, scene, surface} = this;
    surface.gathered = surface.gathered || new Float32Array(3 * surface.sources.length);
    const {gathered, sources} = surface, {move} = scene;
    for (let i = 0, to = 0; i < sources.length; i++) {
      const from = 3 * sources[i];
      gathered[to++] = move[from];
      gathered[to++] = move[from + 1];
      gathered[to++] = move[from + 2];
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, surface.move);
    gl.bufferData(gl.ARRAY_BUFFER, gathered, gl.DYNAMIC_DRAW);
    if (withNormals) {
      setNormalsAfter(scene, surface.split);
      gl.bindBuffer(gl.ARRAY_BUFFER, surface.normals);
      gl.bufferData(gl.ARRAY_BUFFER, surface.split.normals, gl.DYNAMIC_DRAW);
    }
    if (this.splats.count) this.splats.fill();
  }

  // Lines and discs under a name, in place of those that it had.
  setMarks(name, floats, perMark) {
    freeMarks(this.gl, this.marks[name]);
    this.marks[name] = floats.length ? makeMarks(this.gl, floats, perMark) : null;
  }

  resize() {
    const {canvas} = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    this.ratio = ratio;
    this.markSize = canvas.clientWidth < 600 ? 0.7 * ratio : ratio;
  }

  use(name) {
    const {gl} = this;
    const {program, places} = this.programs[name];
    gl.useProgram(program);
    gl.uniformMatrix4fv(places.camera, false, this.state.matrices.camera);
    gl.uniformMatrix4fv(places.projection, false, this.state.matrices.projection);
    gl.uniform1f(places.blend, this.state.blend);
    return places;
  }

  draw(state) {
    const {gl} = this;
    this.state = state;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    this.drawSurface();
    this.splats.draw(state, this.canvas.width, this.canvas.height);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    // What stands round the mesh at rest has no place in a pose.
    if (!state.isPosed) this.drawCage();
    if (state.showJoints) {
      this.drawLines('joints', 2.6, state.colors.joint, 0.6, state.blend);
      this.drawDiscs('jointPoints', 7, state.colors.joint, state.colors.rim, 0.6, state.blend);
    }
    if (state.showTears && !state.isPosed && !state.isMorphed) this.drawLines('tears', 3.4, state.colors.tear, 0.55, state.blend);
    this.drawLines('chosen', 6, state.colors.chosen, 0.8, state.blend);
    this.drawDiscs('chosenPoint', 13, state.colors.chosen, state.colors.rim, 1, state.blend);
    for (const {name, isLine, size, color, hiddenShare} of state.tools || []) {
      if (isLine) this.drawLines(name, size, color, hiddenShare, state.blend);
      else this.drawDiscs(name, size, color, state.colors.rim, hiddenShare, state.blend);
    }
    gl.depthMask(true);
  }

  drawSurface() {
    const {gl, surface, state, paint} = this;
    const places = this.use('surface');
    gl.bindVertexArray(surface.array);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.ramp);
    gl.uniform1i(places.ramp, 0);
    gl.uniform1i(places.mode, paint.mode);
    gl.uniform1i(places.isSmooth, state.isSmooth ? 1 : 0);
    gl.uniform2f(places.range, ...paint.range);
    gl.uniform3f(places.unknownColor, ...UNKNOWN_COLOR);
    gl.uniform3f(places.foldedColor, ...FOLDED_COLOR);
    gl.uniform1f(places.pointSize, 4 * this.ratio);
    gl.uniform1i(places.element, 0);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, surface.triangles);
    this.drawRuns(places);
    if (state.showFlipped && surface.flipped.count) {
      gl.polygonOffset(0, 0);
      gl.uniform1i(places.mode, 4);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, surface.flipped.buffer);
      gl.drawElements(gl.TRIANGLES, surface.flipped.count, gl.UNSIGNED_INT, 0);
      gl.uniform1i(places.mode, paint.mode);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
    this.drawLoose(places);
    gl.bindVertexArray(null);
  }

  setMaterial(places, of) {
    const {gl, scene, paint} = this;
    const shown = paint.mode === 0 && of ? of : null;
    gl.uniform4f(places.baseColor, ...(paint.mode === 0 ? baseColor(of, Boolean(scene.colors)) : [1, 1, 1, 1]));
    gl.uniform1f(places.cutoff, shown && shown.alpha === 'mask' && !shown.lost ? shown.cutoff : 0);
    gl.uniform3f(places.emission, ...(shown ? shown.emission : [0, 0, 0]));
    gl.uniform1i(places.isTwoSided, shown && shown.twoSided ? 1 : 0);
    gl.uniform1i(places.isBlended, isBlended(shown) ? 1 : 0);
    gl.uniform1i(places.isUnlit, shown && shown.unlit ? 1 : 0);
    if (scene.wedges) {
      const four = (list, factor) => [0, 1, 2, 3].map((a) => factor * (list[a] || 0));
      gl.uniform4f(places.texcoordLow, ...four(scene.texcoordLow, 1));
      gl.uniform4f(places.texcoordSize, ...four(scene.texcoordStep, 65535));
    }
    const base = this.bindTexture(1, places.base, shown && shown.base), glow = this.bindTexture(2, places.glow, shown && shown.glow);
    const opacity = this.bindTexture(3, places.opacity, shown && shown.opacity);
    gl.uniform1i(places.hasBase, base ? 1 : 0);
    gl.uniform1i(places.hasGlow, glow ? scene.texcoordLow.length / 2 : 0);
    gl.uniform1i(places.hasOpacity, opacity ? (opacity.isOpaque ? 2 : 1) : 0);
    gl.activeTexture(gl.TEXTURE0);
  }

  // Binds the texture of a use, if it has one.
  bindTexture(unit, place, use) {
    const {gl} = this;
    const texture = use ? this.textures.get(keyOf(use)) : undefined;
    gl.uniform1i(place, unit);
    if (!texture) return undefined;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture.of);
    return texture;
  }

  drawRun(places, run) {
    const {gl} = this;
    this.setMaterial(places, run.of);
    gl.drawElements(gl.TRIANGLES, 3 * (run.end - run.first), gl.UNSIGNED_INT, 12 * run.first);
  }

  // Solid surfaces first; then what is seen through, the farthest part first, its back before its front.
  drawRuns(places) {
    const {gl, paint} = this;
    const isSeenThrough = (run) => paint.mode === 0 && isBlended(run.of);
    this.runs.filter((run) => !isSeenThrough(run)).forEach((run) => this.drawRun(places, run));
    const glass = this.runs.filter(isSeenThrough);
    if (!glass.length) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.enable(gl.CULL_FACE);
    const far = new Map(glass.map((run) => [run, this.depthOf(run)]));
    for (const run of glass.sort((a, b) => far.get(b) - far.get(a))) {
      for (const side of [gl.FRONT, gl.BACK]) {
        gl.cullFace(side);
        this.drawRun(places, run);
      }
    }
    gl.disable(gl.CULL_FACE);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  // The mean distance of a run's triangles from the eye, by some of them.
  depthOf(run) {
    const {scene, surface, state} = this;
    const m = state.matrices.camera, step = Math.max(1, Math.floor((run.end - run.first) / 64));
    let sum = 0, count = 0;
    for (let t = run.first; t < run.end; t += step, count++) {
      const v = 3 * surface.sources[surface.indices[3 * t]];
      const at = [0, 1, 2].map((a) => scene.before[v + a] + state.blend * scene.move[v + a]);
      sum -= m[2] * at[0] + m[6] * at[1] + m[10] * at[2] + m[14];
    }
    return sum / count;
  }

  // Segments and points of the mesh; edges of its triangles.
  drawLoose(places) {
    const {gl, scene, surface, state} = this;
    this.setMaterial(places, undefined);
    // What has no colours of its own is told from the ground.
    if (!scene.colors && this.paint.mode === 0) gl.uniform4f(places.baseColor, ...state.colors.loose);
    gl.uniform1i(places.element, 2);
    if (scene.segments) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, surface.segments);
      gl.drawElements(gl.LINES, 2 * scene.segments, gl.UNSIGNED_INT, 0);
    }
    const points = scene.points - this.splats.count;
    if (points) {
      gl.uniform1i(places.element, 1);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, surface.points);
      gl.drawElements(gl.POINTS, points, gl.UNSIGNED_INT, 0);
    }
    if (state.showEdges) {
      surface.edges = surface.edges || makeEdges(gl, surface, this.runs);
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      gl.uniform1i(places.element, 2);
      gl.uniform1i(places.mode, 0);
      gl.uniform4f(places.baseColor, ...state.colors.edge);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, surface.edges.buffer);
      gl.drawElements(gl.LINES, surface.edges.count, gl.UNSIGNED_INT, 0);
      gl.disable(gl.BLEND);
    }
  }

  drawCage() {
    const {state} = this, seen = state.hidesBehind ? 0 : 1;
    if (state.showRest) this.drawLines('cage', 1.2, state.colors.rest, 0.5 * seen, 0);
    if (state.showCage) {
      this.drawLines('cage', 1.6, state.colors.cage, 0.3 * seen, state.blend);
      this.drawDiscs('controls', 8.5, state.colors.control, state.colors.rim, 0.4 * seen, state.blend);
    }
  }

  // Twice: what is seen, and faintly what is behind a surface.
  twice(color, hiddenShare, place, drawOnce) {
    const {gl} = this;
    gl.depthFunc(gl.LEQUAL);
    gl.uniform4f(place, ...color);
    drawOnce();
    gl.depthFunc(gl.GREATER);
    gl.uniform4f(place, color[0], color[1], color[2], color[3] * hiddenShare);
    drawOnce();
    gl.depthFunc(gl.LEQUAL);
  }

  drawLines(name, width, color, hiddenShare, blend) {
    const {gl, state} = this;
    const marks = this.marks[name];
    if (!marks) return;
    const places = this.use('line');
    gl.uniform1f(places.blend, blend);
    gl.uniform2f(places.viewport, this.canvas.width, this.canvas.height);
    gl.uniform1f(places.width, width * this.markSize);
    gl.uniform1f(places.near, state.matrices.near);
    gl.uniform1f(places.towards, 0.0015);
    gl.bindVertexArray(marks.array);
    this.twice(color, hiddenShare, places.color, () => gl.drawArraysInstanced(gl.TRIANGLES, 0, 6, marks.count));
    gl.bindVertexArray(null);
  }

  drawDiscs(name, size, color, rim, hiddenShare, blend) {
    const {gl} = this;
    const marks = this.marks[name];
    if (!marks) return;
    const places = this.use('disc');
    gl.uniform1f(places.blend, blend);
    gl.uniform1f(places.size, size * this.markSize);
    gl.uniform1f(places.towards, 0.002);
    gl.uniform4f(places.rim, ...rim);
    gl.bindVertexArray(marks.array);
    this.twice(color, hiddenShare, places.color, () => gl.drawArrays(gl.POINTS, 0, marks.count));
    gl.bindVertexArray(null);
  }
}
