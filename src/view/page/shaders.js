// shaders.js - the programs that run on the graphics card: surfaces (also loose points and segments of the mesh),
// lines of a width, discs.

const TO_LINEAR = `
vec3 toLinear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }`;

const SURFACE_VERTEX = `#version 300 es
layout(location = 0) in vec3 before;
layout(location = 1) in vec3 move;
layout(location = 2) in vec3 normalBefore;
layout(location = 3) in vec3 normalAfter;
layout(location = 4) in vec2 value;
layout(location = 5) in vec4 color;
layout(location = 6) in vec4 texcoord;
uniform mat4 camera, projection;
uniform float blend, pointSize;
uniform vec4 texcoordLow, texcoordSize;
out vec3 position, normal;
out vec2 shownValue;
out vec4 shownColor, shownTexcoord;
${TO_LINEAR}
void main() {
  vec4 seen = camera * vec4(before + blend * move, 1.0);
  position = seen.xyz;
  normal = mat3(camera) * mix(normalBefore, normalAfter, blend);
  shownValue = value;
  // Between vertices colours are mixed as light.
  shownColor = vec4(toLinear(color.rgb), color.a);
  shownTexcoord = texcoordLow + texcoordSize * texcoord;
  gl_Position = projection * seen;
  gl_PointSize = pointSize;
}`;

// mode 0: materials; 1: the ramp by value; 2: the ramp by log2 of value, folded from 0 on; 3: the vertices' colours;
// 4: stripes. value.y is 1 where value.x is known.
const SURFACE_FRAGMENT = `#version 300 es
precision highp float;
precision highp int;
in vec3 position, normal;
in vec2 shownValue;
in vec4 shownColor, shownTexcoord;
uniform int mode, element;
// hasGlow 2: by the second coordinates. hasOpacity 1: by alpha; 2: by luminance.
uniform int hasBase, hasGlow, hasOpacity;
uniform bool isSmooth, isTwoSided, isBlended, isUnlit;
uniform float cutoff;
uniform vec3 emission;
uniform vec2 range;
uniform vec4 baseColor;
uniform vec3 unknownColor, foldedColor;
uniform sampler2D ramp, base, glow, opacity;
out vec4 result;

${TO_LINEAR}
vec3 toScreen(vec3 c) { return mix(c * 12.92, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }

// v is upwards, the rows of an image downwards.
vec4 look(sampler2D image, vec2 at) { return texture(image, vec2(at.x, 1.0 - at.y)); }

// Linear, with the opacity.
vec4 materialColor() {
  vec4 own = baseColor * shownColor;
  float plain = own.a;
  if (hasBase != 0) own *= look(base, shownTexcoord.xy);
  if (hasOpacity != 0) {
    vec4 cover = look(opacity, shownTexcoord.xy);
    own.a = plain * (hasOpacity == 1 ? cover.a : dot(toScreen(cover.rgb), vec3(0.2126, 0.7152, 0.0722)));
  }
  return own;
}

vec3 emitted() {
  if (hasGlow == 0) return emission;
  return emission * look(glow, hasGlow == 2 ? shownTexcoord.zw : shownTexcoord.xy).rgb;
}

vec3 markColor() {
  if (mode == 3) return shownColor.rgb;
  if (mode == 4) {
    float stripe = fract((gl_FragCoord.x + gl_FragCoord.y) / 10.0);
    return toLinear(stripe < 0.5 ? vec3(0.98, 0.45, 0.06) : vec3(0.2, 0.09, 0.02));
  }
  if (shownValue.y < 0.999) return toLinear(unknownColor);
  float x = shownValue.x;
  if (mode == 2) {
    if (x <= 0.0) {
      float stripe = fract((gl_FragCoord.x - gl_FragCoord.y) / 8.0);
      return toLinear(stripe < 0.5 ? foldedColor : foldedColor * 0.45);
    }
    x = log2(x);
  }
  float at = clamp((x - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0);
  return toLinear(texture(ramp, vec2((at * 255.0 + 0.5) / 256.0, 0.5)).rgb);
}

vec3 facing() {
  vec3 flat_ = cross(dFdx(position), dFdy(position));
  vec3 n = isSmooth ? normal : flat_;
  if (dot(n, n) < 1e-12) n = flat_;
  n = dot(n, n) > 0.0 ? normalize(n) : vec3(0.0, 0.0, 1.0);
  if (isSmooth ? !gl_FrontFacing : dot(n, position) > 0.0) n = -n;
  return n;
}

void main() {
  vec4 own = mode == 0 ? materialColor() : vec4(markColor(), 1.0);
  if (mode == 0 && own.a < cutoff) discard;
  vec3 surface = own.rgb;
  if (element == 1) {
    vec2 at = 2.0 * gl_PointCoord - 1.0;
    if (dot(at, at) > 1.0) discard;
  }
  if (element != 0) {
    result = vec4(toScreen(surface) * baseColor.a, baseColor.a);
    return;
  }
  vec3 n = facing();
  vec3 toEye = normalize(-position);
  float key = max(dot(n, normalize(vec3(-0.45, 0.65, 0.75))), 0.0);
  float fill = max(dot(n, normalize(vec3(0.8, 0.1, 0.45))), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  float light = mode == 0 || mode == 4 ? 0.2 + 0.14 * sky + 0.72 * key + 0.2 * fill
                                       : 0.44 + 0.12 * sky + 0.42 * key + 0.12 * fill;
  vec3 halfway = normalize(normalize(vec3(-0.45, 0.65, 0.75)) + toEye);
  float shine = (mode == 0 ? 0.1 : 0.03) * pow(max(dot(n, halfway), 0.0), 36.0);
  float edge = 1.0 - 0.22 * pow(1.0 - max(dot(n, toEye), 0.0), 3.0);
  vec3 lit = surface * light * edge + shine;
  // The inner side of a surface is darker and cooler.
  if (!gl_FrontFacing && mode != 4 && !(mode == 0 && isTwoSided)) lit *= vec3(0.58, 0.62, 0.72);
  if (mode == 0 && isUnlit) lit = surface;
  if (mode == 0) lit += emitted();
  // A surface that is cut by its opacity, or has none, is solid where it is.
  float alpha = mode == 0 && isBlended ? own.a : 1.0;
  result = vec4(toScreen(lit) * alpha, alpha);
}`;

// An instance is a line; its two triangles are as wide as `width` pixels.
const LINE_VERTEX = `#version 300 es
layout(location = 0) in vec3 fromBefore;
layout(location = 1) in vec3 fromMove;
layout(location = 2) in vec3 toBefore;
layout(location = 3) in vec3 toMove;
uniform mat4 camera, projection;
uniform vec2 viewport;
uniform float blend, width, near, towards;
void main() {
  vec4 a = camera * vec4(fromBefore + blend * fromMove, 1.0);
  vec4 b = camera * vec4(toBefore + blend * toMove, 1.0);
  float edge = -near * 1.01;
  if (a.z > edge && b.z < edge) a = mix(a, b, (a.z - edge) / (a.z - b.z));
  if (b.z > edge && a.z < edge) b = mix(b, a, (b.z - edge) / (b.z - a.z));
  a.xyz *= 1.0 - towards;
  b.xyz *= 1.0 - towards;
  vec4 p = projection * a, q = projection * b;
  vec2 along = (q.xy / q.w - p.xy / p.w) * viewport;
  along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  bool isEnd = gl_VertexID == 1 || gl_VertexID == 2 || gl_VertexID == 4;
  float side = gl_VertexID == 2 || gl_VertexID == 4 || gl_VertexID == 5 ? 1.0 : -1.0;
  vec4 here = isEnd ? q : p;
  here.xy += across * side * width / viewport * here.w;
  gl_Position = here;
}`;

const LINE_FRAGMENT = `#version 300 es
precision highp float;
uniform vec4 color;
out vec4 result;
void main() { result = vec4(color.rgb * color.a, color.a); }`;

const DISC_VERTEX = `#version 300 es
layout(location = 0) in vec3 before;
layout(location = 1) in vec3 move;
uniform mat4 camera, projection;
uniform float blend, size, towards;
void main() {
  vec4 seen = camera * vec4(before + blend * move, 1.0);
  seen.xyz *= 1.0 - towards;
  gl_Position = projection * seen;
  gl_PointSize = size;
}`;

const DISC_FRAGMENT = `#version 300 es
precision highp float;
uniform vec4 color, rim;
uniform float size;
out vec4 result;
void main() {
  float far = length(2.0 * gl_PointCoord - 1.0) * size * 0.5;
  float cover = clamp(size * 0.5 - far, 0.0, 1.0);
  vec4 shown = mix(color, rim, clamp(far - size * 0.5 + 2.2, 0.0, 1.0));
  float alpha = shown.a * cover;
  if (alpha <= 0.0) discard;
  result = vec4(shown.rgb * alpha, alpha);
}`;
