// The picture: paths as wide lines, from the parallel camera, drawn when something has changed.
import { FULL, HIDDEN, DASHED } from "./colours.js";
import { CHUNK, chosen, importance, withTints } from "./levels.js";
import { FIELDS, RAPID, isDrawn } from "./path.js";
import { ACROSS, FRAGMENT, TEXELS, VERTEX } from "./shaders.js";

const MANY = 60_000; // pieces of which a picture is made; more are drawn as thin lines
const SHARE = 50_000; // pieces of a picture in software at once, where it stands still
const SHARP = 0.4; // pixels that a line may be off when the picture stands still
const COARSEST = 6; // pixels, while it moves and is slow
const THIN = 1.5; // pixels; where the picture is coarser, lines are thin too
const [SLOW, FAST] = [45, 24]; // ms between pictures
const STILL = 220; // ms without movement, after which the picture is drawn sharp
const SQUARE = [0, 2, 1, 1, 2, 3]; // the corners of its two triangles
let shared = null; // the index of all rectangles

export function drawingOn(canvas) {
  const software = drawsInSoftware();
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: !software, preserveDrawingBuffer: true });
  renderer.autoClear = false;
  renderer.outputColorSpace = "srgb-linear"; // colours go to the screen as they are given
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.zoomToCursor = true;
  const drawing = {
    canvas, renderer, camera, controls, software, scene: new THREE.Scene(), paths: [], rest: null, share: SHARE, ground: new THREE.Color(),
    coarse: SHARP, moved: 0, stirred: false, asked: false, last: 0, size: 100, middle: [0, 0, 0], frames: 0, beforeDrawn: [],
  };
  controls.addEventListener("change", () => stir(drawing));
  new ResizeObserver(() => resized(drawing)).observe(canvas.parentElement);
  return drawing;
}

// Whether no graphics card helps: then smooth edges would cost more than they are worth.
function drawsInSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) throw new Error("this browser has no WebGL 2");
  const said = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(said ? said.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /SwiftShader|llvmpipe|softpipe|Basic Render/i.test(name);
}

export function setGround(drawing, colour) {
  drawing.ground.setStyle(colour, "srgb-linear");
  drawing.renderer.setClearColor(drawing.ground);
  for (const shown of drawing.paths) shown.uniforms.ground.value = drawing.ground;
  redraw(drawing);
}

function resized(drawing) {
  const { clientWidth, clientHeight } = drawing.canvas.parentElement;
  drawing.renderer.setSize(clientWidth, clientHeight, false);
  const high = drawing.camera.top - drawing.camera.bottom;
  const half = (high * clientWidth) / Math.max(clientHeight, 1) / 2;
  drawing.camera.left = -half;
  drawing.camera.right = half;
  drawing.camera.updateProjectionMatrix();
  redraw(drawing);
}

// --- when ---

export function redraw(drawing) {
  drawing.rest = null; // what is half drawn is out of date
  ask(drawing);
}

function ask(drawing) {
  if (drawing.asked) return;
  drawing.asked = true;
  requestAnimationFrame((now) => drawn(drawing, now));
}

// The camera or the time moves: be fast rather than sharp.
export function stir(drawing) {
  drawing.moved = performance.now();
  drawing.stirred = true; // also where a picture takes longer than STILL
  redraw(drawing);
}

function drawn(drawing, now) {
  drawing.asked = false;
  const between = now - drawing.last;
  drawing.last = now;
  const moving = drawing.stirred || performance.now() - drawing.moved < STILL;
  drawing.stirred = false;
  if (!moving) drawing.coarse = SHARP;
  else if (between > SLOW && between < 2000) drawing.coarse = Math.min(COARSEST, 2 * drawing.coarse);
  else if (between < FAST) drawing.coarse = Math.max(SHARP, drawing.coarse / 1.1);
  if (moving || !drawing.software) render(drawing);
  else renderShare(drawing);
  if (moving || drawing.rest?.length) ask(drawing);
}

// Draw sharp, and at once.
export function drawNow(drawing) {
  drawing.coarse = SHARP;
  render(drawing);
}

function render(drawing) {
  drawing.rest = null;
  const seen = prepared(drawing);
  for (const chunk of seen.flatMap((shown) => shown.chunks)) show(chunk, true);
  drawing.renderer.clear();
  drawing.renderer.render(drawing.scene, drawing.camera);
  drawing.frames += 1;
}

// A share of the pieces, and what stands around them with the last: in software a long program takes
// longer than a person likes to wait for a page, and so it is drawn over several pictures.
function renderShare(drawing) {
  const seen = drawing.paths.filter((shown) => shown.group.visible);
  if (!drawing.rest) {
    drawing.rest = prepared(drawing).flatMap((shown) => shown.chunks);
    drawing.renderer.clear();
    for (const chunk of drawing.rest) show(chunk, false);
  }
  const share = [];
  for (let pieces = 0; drawing.rest.length && pieces < drawing.share; pieces += share.at(-1).pieces) share.push(drawing.rest.shift());
  for (const chunk of share) show(chunk, true);
  if (drawing.rest.length) for (const shown of seen) drawing.renderer.render(shown.group, drawing.camera);
  else drawing.renderer.render(drawing.scene, drawing.camera);
  for (const chunk of share) show(chunk, false);
  drawing.frames += 1;
}

// Choose what is drawn of the paths that are seen, and how; return these.
function prepared(drawing) {
  const least = pixel(drawing) * drawing.coarse;
  const seen = drawing.paths.filter((shown) => shown.group.visible);
  for (const shown of seen) levelled(shown, least);
  const chunks = seen.flatMap((shown) => shown.chunks);
  const pieces = chunks.reduce((sum, chunk) => sum + chunk.pieces, 0);
  for (const chunk of chunks) chunk.isWide = pieces < MANY && drawing.coarse < THIN;
  drawing.camera.updateMatrixWorld();
  for (const act of drawing.beforeDrawn) act();
  return seen;
}

function show(chunk, seen) {
  chunk.wide.visible = seen && chunk.isWide;
  chunk.thin.visible = seen && !chunk.isWide;
}

// How many mm a pixel of the screen is.
export function pixel(drawing) {
  const { top, bottom, zoom } = drawing.camera;
  return (top - bottom) / zoom / Math.max(drawing.canvas.clientHeight, 1);
}

// --- paths ---

export function addPath(drawing, path) {
  const rows = Math.ceil(Math.max(path.count, 1) / TEXELS);
  const colours = new Uint8Array(4 * TEXELS * rows).fill(FULL);
  const texture = new THREE.DataTexture(colours, TEXELS, rows, THREE.RGBAFormat, THREE.UnsignedByteType);
  const uniforms = {
    viewport: { value: new THREE.Vector2(1, 1) }, width: { value: 2 }, behind: { value: 0 }, played: { value: Infinity },
    colours: { value: texture }, ground: { value: drawing.ground }, single: { value: [0, 0, 0, 0] },
    corners: { value: null }, per: { value: 4 },
  };
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms, side: THREE.DoubleSide,
  });
  const shown = { path, colours, texture, uniforms, material, group: new THREE.Group(), chunks: [] };
  shown.manner = mannersOf(path);
  const corners = path.corners.length / FIELDS;
  for (let first = 0; first < corners - 1; first += CHUNK) {
    shown.chunks.push(chunkOf(shown, first, Math.min(first + CHUNK, corners - 1)));
  }
  shown.group.position.set(...path.middle.map((value, axis) => value - drawing.middle[axis]));
  drawing.scene.add(shown.group);
  drawing.paths.push(shown);
  return shown;
}

// How each move is drawn, whatever its colour.
function mannersOf(path) {
  const found = new Uint8Array(path.count);
  for (let row = 0; row < path.count; row++) {
    const known = isDrawn(path, row) && path.tips?.pieces[row] !== 0;
    found[row] = !known ? HIDDEN : path.kind[row] === RAPID ? DASHED : FULL;
  }
  return found;
}

function chunkOf(shown, first, last) {
  const chunk = {
    first, last, level: NaN, weight: null, pieces: 0, sphere: sphereOf(shown.path.corners, first, last),
    wide: pieceOf(shown, THREE.Mesh, 4), thin: pieceOf(shown, THREE.LineSegments, 2),
  };
  return chunk;
}

// Something that draws corners of a path, none yet; `per` of its points make one piece.
function pieceOf(shown, kind, per, material = shown.material) {
  const object = new kind(new THREE.BufferGeometry(), material);
  const { uniforms } = material;
  object.onBeforeRender = (renderer) => {
    renderer.getSize(uniforms.viewport.value);
    uniforms.corners.value = object.userData.corners;
    uniforms.per.value = per;
    material.uniformsNeedUpdate = true;
  };
  object.userData.count = per === 4 ? SQUARE.length : per; // of points to draw a piece
  if (per === 4) object.geometry.setIndex(squares());
  shown.group.add(object);
  return object;
}

// The corners of rectangles, two triangles each, as many as a chunk can have.
function squares() {
  if (!shared) {
    const found = new Uint16Array(SQUARE.length * CHUNK);
    for (let k = 0; k < found.length; k++) found[k] = 4 * Math.floor(k / SQUARE.length) + SQUARE[k % SQUARE.length];
    shared = new THREE.BufferAttribute(found, 1);
  }
  return shared;
}

function give(object, texture, pieces, sphere) {
  object.userData.corners = texture;
  object.geometry.setDrawRange(0, object.userData.count * pieces);
  object.geometry.boundingSphere = sphere;
}

// A colour, roughly.
function tintOf(colours, row) {
  const at = 4 * row;
  return ((colours[at] >> 5) << 6) | ((colours[at + 1] >> 5) << 3) | (colours[at + 2] >> 5);
}

function sphereOf(corners, first, last) {
  const box = new THREE.Box3();
  const point = new THREE.Vector3();
  for (let at = FIELDS * first; at <= FIELDS * last; at += FIELDS) {
    box.expandByPoint(point.set(corners[at], corners[at + 1], corners[at + 2]));
  }
  return box.getBoundingSphere(new THREE.Sphere());
}

// Let each chunk hold the corners that matter at a size in mm.
function levelled(shown, least) {
  const level = Math.floor(Math.log2(least));
  for (const chunk of shown.chunks) {
    if (chunk.level === level) continue;
    chunk.level = level;
    chunk.weight ??= weightOf(shown, chunk);
    chunk.texture?.dispose();
    const corners = chosen(shown.path.corners, chunk.first, chunk.last, chunk.weight, 2 ** level);
    chunk.pieces = corners.length / FIELDS - 1;
    chunk.texture = textureOf(corners);
    for (const object of [chunk.wide, chunk.thin]) give(object, chunk.texture, chunk.pieces, chunk.sphere);
  }
}

function textureOf(corners) {
  const rows = Math.ceil(corners.length / FIELDS / ACROSS);
  const texels = new Float32Array(FIELDS * ACROSS * rows);
  texels.set(corners);
  const texture = new THREE.DataTexture(texels, ACROSS, rows, THREE.RGBAFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

function weightOf(shown, chunk) {
  const { corners } = shown.path;
  const rowOf = (corner) => corners[FIELDS * corner + 3];
  const manner = (corner) => shown.manner[rowOf(corner)];
  const isFixed = (corner) => manner(corner) !== manner(corner + 1);
  const weight = importance(corners, chunk.first, chunk.last, isFixed);
  return withTints(weight, corners, chunk.first, (corner) => tintOf(shown.colours, rowOf(corner)));
}

// The corners of some rows, to be drawn on top of the rest.
export function highlight(drawing, shown, rows, colour) {
  drawing.marked ??= [];
  const { path } = shown;
  for (const row of rows) {
    if (shown.manner[row] === HIDDEN) continue;
    const [from, to] = [path.last[row], path.last[row + 1]];
    const mesh = pieceOf(shown, THREE.Mesh, 4, markMaterial(shown, colour));
    give(mesh, textureOf(path.corners.slice(FIELDS * from, FIELDS * (to + 1))), to - from, new THREE.Sphere());
    mesh.frustumCulled = false;
    mesh.renderOrder = 2;
    drawing.marked.push(mesh);
  }
  redraw(drawing);
}

function markMaterial(shown, colour) {
  const uniforms = {
    ...shown.uniforms, corners: { value: null }, per: { value: 4 }, width: { value: 5 }, played: { value: Infinity }, single: { value: [...colour.map((c) => c / 255), 1] },
  };
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms,
    side: THREE.DoubleSide, depthTest: false,
  });
}

export function unmark(drawing) {
  for (const mesh of drawing.marked ?? []) {
    mesh.userData.corners.dispose();
    mesh.material.dispose();
    mesh.removeFromParent();
  }
  drawing.marked = [];
  redraw(drawing);
}

// Give each row a colour; `colourOf(row)` is [red, green, blue], or null for a row not to be seen.
export function paint(drawing, shown, colourOf) {
  const { colours, manner, path } = shown;
  for (let row = 0; row < path.count; row++) {
    const colour = manner[row] === HIDDEN ? null : colourOf(row);
    colours[4 * row + 3] = colour ? manner[row] : HIDDEN;
    if (colour) colours.set(colour, 4 * row);
  }
  shown.texture.needsUpdate = true;
  for (const chunk of shown.chunks) Object.assign(chunk, { level: NaN, weight: null });
  redraw(drawing);
}
