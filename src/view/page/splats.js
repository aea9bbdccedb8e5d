// splats.js - Gaussian splats as ellipses with their colours and opacities, from back to front. Their order is found for
// each picture, by counting depths in 16 bits: its time is proportional to their number, and needs no worker.

const SPLAT_TEXELS = 6;   // of the table, a splat: place, movement with opacity, covariances before and after, colour
const SPLAT_WIDTH = 3072;  // of the table; a multiple of SPLAT_TEXELS
const DEPTHS = 1 << 16;

const SPLAT_VERTEX = `#version 300 es
precision highp float;
precision highp sampler2D;
layout(location = 0) in uint splat;
uniform sampler2D table;
uniform mat4 camera, projection;
uniform vec2 viewport;
uniform float blend;
out vec4 shown;
out vec2 place;
vec4 texel(int k) {
  int at = int(splat) * ${SPLAT_TEXELS} + k;
  return texelFetch(table, ivec2(at % ${SPLAT_WIDTH}, at / ${SPLAT_WIDTH}), 0);
}
void main() {
  vec4 before = texel(0), move = texel(1), a = texel(2), b = texel(3), c = texel(4);
  vec3 diagonal = mix(vec3(a.x, a.w, b.y), vec3(b.z, c.y, c.w), blend);
  vec3 mixed = mix(vec3(a.y, a.z, b.x), vec3(b.w, c.x, c.z), blend);
  mat3 spread = mat3(diagonal.x, mixed.x, mixed.y, mixed.x, diagonal.y, mixed.z, mixed.y, mixed.z, diagonal.z);
  vec4 seen = camera * vec4(before.xyz + blend * move.xyz, 1.0);
  shown = vec4(texel(5).rgb, move.w);
  place = vec2(0.0);
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  if (seen.z > -0.001) return;
  // Zwicker et al. 2001, EWA splatting: the ellipse on the screen to first order, in pixels; 0.3 as 3DGS and pictures have it.
  vec2 size = 0.5 * viewport * vec2(projection[0][0], projection[1][1]) / -seen.z;
  vec2 slope = clamp(seen.xy / -seen.z, -1.3 / vec2(projection[0][0], projection[1][1]), 1.3 / vec2(projection[0][0], projection[1][1]));
  mat3 turn = mat3(camera);
  mat3 view = turn * spread * transpose(turn);
  vec3 across = vec3(size.x, 0.0, size.x * slope.x), down = vec3(0.0, size.y, size.y * slope.y);
  float xx = dot(across, view * across) + 0.3, yy = dot(down, view * down) + 0.3, xy = dot(across, view * down);
  float middle = 0.5 * (xx + yy), far = length(vec2(0.5 * (xx - yy), xy));
  vec2 axis = abs(xy) > 1e-9 * middle ? normalize(vec2(xy, middle + far - xx)) : xx >= yy ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  place = 3.0 * corner;
  vec2 reach = place.x * sqrt(middle + far) * axis + place.y * sqrt(max(middle - far, 0.1)) * vec2(-axis.y, axis.x);
  vec4 at = projection * seen;
  gl_Position = at + vec4(2.0 * reach / viewport * at.w, 0.0, 0.0);
}`;

const SPLAT_FRAGMENT = `#version 300 es
precision highp float;
in vec4 shown;
in vec2 place;
out vec4 result;
void main() {
  float square = dot(place, place), alpha = shown.a * exp(-0.5 * square);
  if (square > 9.0 || alpha < 1.0 / 255.0) discard;
  result = vec4(shown.rgb * alpha, alpha);
}`;

// Whether a vertex of the mesh is a splat.
function isSplat(scene, vertex) {
  return Boolean(scene.splats) && [0, 3, 5].some((i) => scene.splats[0][6 * vertex + i] > 0);
}

class Splats {
  constructor(gl, scene) {
    this.gl = gl;
    this.scene = scene;
    this.vertices = scene.pointIndices.filter((v) => isSplat(scene, v));
    this.count = this.vertices.length;
    if (!this.count) return;
    this.program = compile(gl, SPLAT_VERTEX, SPLAT_FRAGMENT);
    this.rows = Math.ceil(this.count * SPLAT_TEXELS / SPLAT_WIDTH);
    this.table = new Float32Array(4 * SPLAT_WIDTH * this.rows);
    this.texture = gl.createTexture();
    this.order = new Uint32Array(this.count);
    this.keys = new Uint16Array(this.count);
    this.depths = new Float32Array(this.count);
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    this.buffer = makeBuffer(gl, gl.ARRAY_BUFFER, this.order);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribIPointer(0, 1, gl.UNSIGNED_INT, 0, 0);
    gl.vertexAttribDivisor(0, 1);
    gl.bindVertexArray(null);
    this.fill();
  }

  // Places, movements and covariances, as the scene has them now.
  fill() {
    if (!this.count) return;
    const {scene, table} = this, square = scene.space.scale ** 2;
    this.vertices.forEach((v, i) => {
      const at = 4 * SPLAT_TEXELS * i;
      for (let a = 0; a < 3; a++) {
        table[at + a] = scene.before[3 * v + a];
        table[at + 4 + a] = scene.move[3 * v + a];
      }
      table[at + 7] = scene.colors ? scene.colors[4 * v + 3] / 255 : 1;
      for (let k = 0; k < 12; k++) table[at + 8 + k] = scene.splats[k < 6 ? 0 : 1][6 * v + k % 6] / square;
    });
    this.isChanged = true;
  }

  // The colours of a colouring (colors.js).
  paint(paint) {
    if (!this.count) return;
    this.vertices.forEach((v, i) => this.table.set(paintOf(this.scene, paint, v), 4 * (SPLAT_TEXELS * i + 5)));
    this.isChanged = true;
  }

  upload() {
    const {gl} = this;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    if (!this.isChanged) return;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, SPLAT_WIDTH, this.rows, 0, gl.RGBA, gl.FLOAT, this.table);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  // Orders the splats from the farthest to the nearest.
  sort(camera, blend) {
    const {table, depths, keys, order, count} = this;
    const seen = [camera[2], camera[6], camera[10], camera[14], blend].join();
    if (seen === this.sortedFor && !this.isChanged) return;
    this.sortedFor = seen;
    let low = Infinity, high = -Infinity;
    for (let i = 0, at = 0; i < count; i++, at += 4 * SPLAT_TEXELS) {
      const depth = camera[2] * (table[at] + blend * table[at + 4]) + camera[6] * (table[at + 1] + blend * table[at + 5]) +
          camera[10] * (table[at + 2] + blend * table[at + 6]);
      depths[i] = depth;
      if (depth < low) low = depth;
      if (depth > high) high = depth;
    }
    const starts = new Uint32Array(DEPTHS + 1), size = (DEPTHS - 1) / (high - low || 1);
    for (let i = 0; i < count; i++) {
      keys[i] = (depths[i] - low) * size;
      starts[keys[i] + 1]++;
    }
    for (let k = 0; k < DEPTHS; k++) starts[k + 1] += starts[k];
    for (let i = 0; i < count; i++) order[starts[keys[i]]++] = i;
    const {gl} = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, order, gl.DYNAMIC_DRAW);
  }

  draw(state, width, height) {
    const {gl} = this;
    if (!this.count) return;
    const {program, places} = this.program, {camera, projection} = state.matrices;
    gl.useProgram(program);
    gl.uniformMatrix4fv(places.camera, false, camera);
    gl.uniformMatrix4fv(places.projection, false, projection);
    gl.uniform1f(places.blend, state.blend);
    gl.uniform2f(places.viewport, width, height);
    gl.uniform1i(places.table, 0);
    gl.activeTexture(gl.TEXTURE0);
    this.upload();
    this.sort(camera, state.blend);
    this.isChanged = false;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.bindVertexArray(this.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
    gl.bindVertexArray(null);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
}
