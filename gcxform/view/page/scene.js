// What stands around the path: axes, a grid, the machine's travel, errors as arrows, the tool, and
// the plane in force.
import { css } from "./colours.js";
import { pixel } from "./drawing.js";
import { endOf, pointOn } from "./path.js";

const AXES = [["X", [213, 94, 0]], ["Y", [0, 158, 115]], ["Z", [0, 114, 178]]];
const LINES = 10; // of the grid, about, in each direction
const LONGEST = 0.08; // part of the size of the box that the largest error is drawn as
const HAIRS = 400; // tool axes that are drawn along the path
const ACCENT = [213, 94, 0];

export function sceneOf(drawing, told, box) {
  const size = box.getSize(new THREE.Vector3()).length() || 1;
  const scene = { drawing, told, box, size, layers: {}, labels: [] };
  scene.layers.grid = gridOf(scene);
  scene.layers.axes = triadOf(scene);
  if (told.envelope) scene.layers.envelope = envelopeOf(scene);
  if (told.lattice) scene.layers.errors = latticeOf(scene);
  scene.layers.plane = planeOf(scene);
  for (const layer of Object.values(scene.layers)) drawing.scene.add(layer);
  scene.tool = toolOf(scene);
  drawing.beforeDrawn.push(() => placeLabels(scene));
  return scene;
}

// Pieces of lines from points one after the other, in the coordinates of the program.
function lines(scene, points, colour, opacity = 1) {
  const middle = scene.drawing.middle;
  const geometry = flat(points.map((point) => point.map((value, axis) => value - middle[axis])));
  const material = new THREE.LineBasicMaterial({ transparent: opacity < 1, opacity });
  material.color.setStyle(css(colour), "srgb-linear");
  return new THREE.LineSegments(geometry, material);
}

function flat(points) {
  return new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(new Float32Array(points.flat()), 3));
}

function niceBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((factor) => factor * power).find((each) => each <= value);
}

// The box in the coordinates of the program.
function bounds(scene) {
  const { box, drawing } = scene;
  return ["x", "y", "z"].map((axis, k) => [box.min[axis] + drawing.middle[k], box.max[axis] + drawing.middle[k]]);
}

// A grid in the plane Z0, below what is cut.
function gridOf(scene) {
  const [x, y] = bounds(scene);
  const step = niceBelow(Math.max(x[1] - x[0], y[1] - y[0], scene.size / 4) / LINES) || 1;
  scene.step = step;
  const [left, right] = [Math.floor(x[0] / step) - 1, Math.ceil(x[1] / step) + 1];
  const [near, far] = [Math.floor(y[0] / step) - 1, Math.ceil(y[1] / step) + 1];
  const points = [];
  for (let k = left; k <= right; k++) points.push([k * step, near * step, 0], [k * step, far * step, 0]);
  for (let k = near; k <= far; k++) points.push([left * step, k * step, 0], [right * step, k * step, 0]);
  return lines(scene, points, [128, 136, 146], 0.28);
}

function triadOf(scene) {
  const group = new THREE.Group();
  const size = 0.14 * scene.size;
  AXES.forEach(([letter, colour], axis) => {
    const tip = [0, 0, 0];
    tip[axis] = size;
    group.add(lines(scene, [[0, 0, 0], tip], colour));
    scene.labels.push(labelOf(scene, letter, tip, colour));
  });
  return group;
}

function labelOf(scene, text, point, colour) {
  const element = document.createElement("span");
  element.className = "label";
  element.textContent = text;
  element.style.color = css(colour);
  scene.drawing.canvas.parentElement.append(element);
  return { element, point };
}

function placeLabels(scene) {
  const { camera, canvas, middle } = scene.drawing;
  const seen = new THREE.Vector3();
  for (const { element, point, layer } of scene.labels) {
    seen.set(...point.map((value, axis) => value - middle[axis])).project(camera);
    element.style.left = `${((seen.x + 1) / 2) * canvas.clientWidth}px`;
    element.style.top = `${((1 - seen.y) / 2) * canvas.clientHeight}px`;
    element.hidden = !(layer ?? scene.layers.axes).visible || (layer && !layer.children[0].visible);
  }
  scene.tool.scale.setScalar(34 * pixel(scene.drawing));
}

function envelopeOf(scene) {
  const [low, high] = scene.told.envelope;
  const points = [];
  for (let axis = 0; axis < 3; axis++) {
    const [one, other] = [0, 1, 2].filter((each) => each !== axis);
    for (const [p, q] of [[low, low], [low, high], [high, low], [high, high]]) {
      const from = [...low];
      from[one] = p[one];
      from[other] = q[other];
      const to = [...from];
      to[axis] = high[axis];
      points.push(from, to);
    }
  }
  return lines(scene, points, [204, 121, 167]);
}

// Errors as arrows, so long that the largest is seen.
function latticeOf(scene) {
  const { points, errors } = scene.told.lattice;
  const count = points.length / 3;
  let [most, low, high] = [0, Infinity, -Infinity];
  for (let k = 0; k < count; k++) most = Math.max(most, Math.hypot(...errors.slice(3 * k, 3 * k + 3)));
  for (const value of points) [low, high] = [Math.min(low, value), Math.max(high, value)];
  scene.factor = most ? niceBelow((LONGEST * (high - low)) / most) : 1;
  scene.most = most;
  const ends = [];
  for (let k = 0; k < count; k++) ends.push(...arrow(points.slice(3 * k, 3 * k + 3), errors.slice(3 * k, 3 * k + 3), scene.factor));
  return lines(scene, ends, ACCENT);
}

function arrow(from, error, factor) {
  const tip = from.map((value, axis) => value + factor * error[axis]);
  const across = [error[1] + error[2], error[2] - error[0], -error[0] - error[1]];
  const barb = (sign) => tip.map((value, axis) => value - factor * (0.28 * error[axis] - sign * 0.1 * across[axis]));
  return [from, tip, tip, barb(1), tip, barb(-1)];
}

// The tool: a cone that stands on its tip.
function toolOf(scene) {
  const cone = new THREE.Mesh(new THREE.ConeGeometry(0.28, 1, 24), new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.75, depthTest: false }));
  cone.material.color.setStyle(css(ACCENT), "srgb-linear");
  cone.geometry.rotateX(-Math.PI / 2).translate(0, 0, 0.5);
  cone.renderOrder = 3;
  cone.visible = false;
  scene.drawing.scene.add(cone);
  return cone;
}

// --- the tool axis ---

// From the tip to the holder at the end of a move, as the drawing has it; null where nobody says.
export function toolAxis(scene, program, row) {
  const { path } = program;
  if (path.vectors) {
    const found = path.vectors.map((column) => column[row]);
    if (Math.hypot(...found) > 0.5) return found;
  }
  const { table = [], head = [] } = program.chain;
  if (!table.length && !head.length) return null;
  let axis = new THREE.Vector3(0, 0, 1);
  for (const each of [...head].reverse()) axis = turned(axis, each, path, row, 1);
  if (program.follows[path.frame[row]]) for (const each of table) axis = turned(axis, each, path, row, -1);
  return axis && [axis.x, axis.y, axis.z];
}

function turned(axis, { letter, direction, sign }, path, row, way) {
  const column = path.axes.indexOf(letter);
  const degrees = column < 0 ? 0 : endOf(path, row, column);
  return axis.applyAxisAngle(new THREE.Vector3(...direction), (way * sign * degrees * Math.PI) / 180);
}

export function placeTool(scene, program, point, row) {
  scene.tool.visible = true;
  scene.tool.position.set(...point);
  const axis = toolAxis(scene, program, row) ?? [0, 0, 1];
  scene.tool.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...axis).normalize());
  const [x, y, z] = program.frames[program.path.frame[row]].tool ?? [0, 0, 0];
  for (const name of ["envelope", "errors"]) scene.layers[name]?.position.set(-x, -y, -z); // of the spindle
}

// --- the plane ---

const SIDES = { G17: [0, 1], G18: [2, 0], G19: [1, 2] };
const GREEN = [0, 158, 115];

// The plane in force where the tool is: a pane with an edge, and the code beside it.
function planeOf(scene) {
  const group = new THREE.Group();
  const size = 0.11 * scene.size;
  const half = size / 2;
  const around = [[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]];
  const pane = new THREE.Mesh(flat([0, 1, 2, 0, 2, 3].map((k) => around[k])), new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false }));
  pane.material.color.setStyle(css(GREEN), "srgb-linear");
  const edge = new THREE.LineSegments(flat([0, 1, 1, 2, 2, 3, 3, 0].map((k) => around[k])), new THREE.LineBasicMaterial());
  edge.material.color.setStyle(css(GREEN), "srgb-linear");
  const both = new THREE.Group().add(pane, edge);
  both.visible = false;
  group.add(both);
  scene.plane = { both, half, label: { ...labelOf(scene, "", [0, 0, 0], GREEN), layer: group } };
  scene.labels.push(scene.plane.label);
  return group;
}

// Let the plane be that of a move; `point` is as it is drawn.
export function placePlane(scene, program, point, row) {
  const { both, half, label } = scene.plane;
  const codes = program.modes[program.mode[program.path.block[row]]].split(" ");
  const code = codes.find((each) => SIDES[each]);
  both.visible = code !== undefined;
  if (!code) return;
  const [u, v] = SIDES[code].map((axis) => sideOf(program, row, axis));
  const normal = u.clone().cross(v);
  both.matrixAutoUpdate = false;
  both.matrix.makeBasis(u, v, normal).setPosition(...point);
  const corner = u.clone().add(v).multiplyScalar(1.15 * half);
  label.point = point.map((value, axis) => value + corner.getComponent(axis) + scene.drawing.middle[axis]);
  label.element.textContent = code;
}

export function hidePlane(scene) {
  scene.plane.both.visible = false;
}

// An axis of the words of a move as the drawing has it: turned with the frame, and with the table.
function sideOf(program, row, axis) {
  const { path, chain } = program;
  const { inverse, following } = program.frames[path.frame[row]];
  const unit = [0, 1, 2].map((each) => Number(each === axis));
  let side = new THREE.Vector3(...(inverse ? inverse[axis] : unit)).normalize();
  if (path.tips && !following) for (const each of chain.table ?? []) side = turned(side, each, path, row, -1);
  return side;
}

// Some of the tool axes along a path, as hairs.
export function hairsOf(scene, program) {
  const { path } = program;
  if (!path.count || !toolAxis(scene, program, path.count - 1)) return null;
  const points = [];
  const step = Math.max(1, Math.floor(path.count / HAIRS));
  for (let row = 0; row < path.count; row += step) {
    const axis = toolAxis(scene, program, row);
    if (!axis || !program.shown.manner[row]) continue;
    const foot = pointOn(path, row, 1);
    points.push(foot, foot.map((value, each) => value + 0.07 * scene.size * axis[each]));
  }
  return points.length ? lines(scene, points, [86, 180, 233], 0.8) : null;
}
