// How pieces of a path become pixels.
export const TEXELS = 2048; // a row of the texture of colours
export const ACROSS = 256; // a row of the texture of corners

// A piece of path is a rectangle that faces the screen (4 corners) or a thin line (2); where it lies
// is in a texture, because software renderers are slow at instances.
export const VERTEX = `
precision highp float; precision highp int; precision highp sampler2D;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform vec2 viewport; uniform float width, behind; uniform int per;
uniform sampler2D corners, colours; uniform vec4 single;
out vec3 shade; out float along, travelled; flat out int dashed;
vec4 cornerAt(int k) { return texelFetch(corners, ivec2(k % ${ACROSS}, k / ${ACROSS}), 0); }
void main() {
  int piece = gl_VertexID / per, nth = gl_VertexID % per;
  vec4 first = cornerAt(piece), second = cornerAt(piece + 1);
  int row = int(second.w);
  vec4 colour = texelFetch(colours, ivec2(row % ${TEXELS}, row / ${TEXELS}), 0);
  if (colour.a == 0.0) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  vec4 a = projectionMatrix * modelViewMatrix * vec4(first.xyz, 1.0);
  vec4 b = projectionMatrix * modelViewMatrix * vec4(second.xyz, 1.0);
  vec2 way = 0.5 * (b.xy - a.xy) * viewport;
  float size = length(way);
  float part = per == 2 ? float(nth) : float(nth / 2);
  gl_Position = mix(a, b, part);
  if (per > 2) {
    vec2 unit = size > 0.0 ? way / size : vec2(1.0, 0.0);
    float side = nth % 2 == 1 ? 1.0 : -1.0;
    gl_Position.xy += (vec2(-unit.y, unit.x) * side + unit * (2.0 * part - 1.0)) * width / viewport;
  }
  gl_Position.z += behind;
  along = part * size;
  dashed = colour.a < 0.9 ? 1 : 0;
  shade = mix(colour.rgb, single.rgb, single.a);
  travelled = mix(first.w, second.w, part);
}`;
export const FRAGMENT = `
precision highp float;
uniform vec3 ground; uniform float played;
in vec3 shade; in float along, travelled; flat in int dashed; out vec4 fragment;
void main() {
  if (dashed == 1 && mod(along, 9.0) > 5.0) discard;
  fragment = vec4(travelled > played ? mix(shade, ground, 0.86) : shade, 1.0);
}`;
