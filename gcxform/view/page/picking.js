// Which move is under the pointer.
import { HIDDEN } from "./colours.js";
import { FIELDS } from "./path.js";

const NEAR = 9; // pixels

// The row of a path that is nearest to a point of the canvas (pixels), and of those the foremost.
export function rowAt(drawing, shown, x, y) {
  const view = viewOf(drawing, shown);
  let best = { row: -1, score: Infinity };
  for (const chunk of shown.chunks) {
    if (couldBeNear(view, chunk.sphere, x, y)) best = nearestOf(view, shown, chunk, x, y, best);
  }
  return best;
}

// What takes a corner to pixels and depth: three rows of four numbers.
function viewOf(drawing, shown) {
  const { camera, canvas } = drawing;
  camera.updateMatrixWorld();
  shown.group.updateMatrixWorld();
  const whole = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  const m = whole.multiply(shown.group.matrixWorld).elements;
  const [w, h] = [canvas.clientWidth / 2, canvas.clientHeight / 2];
  return {
    x: [m[0] * w, m[4] * w, m[8] * w, (m[12] + 1) * w],
    y: [-m[1] * h, -m[5] * h, -m[9] * h, (1 - m[13]) * h],
    z: [m[2], m[6], m[10], m[14]],
    scale: Math.hypot(m[1], m[5], m[9]) * h,
  };
}

function along(line, x, y, z) {
  return line[0] * x + line[1] * y + line[2] * z + line[3];
}

function couldBeNear(view, sphere, x, y) {
  const { center, radius } = sphere;
  const away = Math.hypot(along(view.x, center.x, center.y, center.z) - x, along(view.y, center.x, center.y, center.z) - y);
  return away <= radius * view.scale + NEAR;
}

function nearestOf(view, shown, chunk, x, y, best) {
  const { corners } = shown.path;
  let [ax, ay, az] = [NaN, NaN, NaN];
  for (let corner = chunk.first; corner <= chunk.last; corner++) {
    const at = FIELDS * corner;
    const [px, py, pz] = [corners[at], corners[at + 1], corners[at + 2]];
    const [bx, by, bz] = [along(view.x, px, py, pz), along(view.y, px, py, pz), along(view.z, px, py, pz)];
    const row = corners[at + 3];
    if (corner > chunk.first && shown.colours[4 * row + 3] !== HIDDEN) {
      const [dx, dy] = [bx - ax, by - ay];
      const part = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
      const away = Math.hypot(ax + part * dx - x, ay + part * dy - y);
      const score = away + 2 * (az + part * (bz - az));
      if (away <= NEAR && score < best.score) best = { row, score };
    }
    [ax, ay, az] = [bx, by, bz];
  }
  return best;
}
