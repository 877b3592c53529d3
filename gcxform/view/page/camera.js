// Where one looks from, and what box all of it is in.
import { DASHED, FULL } from "./colours.js";
import { stir } from "./drawing.js";
import { FIELDS } from "./path.js";

export const VIEWS = {
  iso: [1, -1.2, 0.9], top: [0, -1e-4, 1], front: [0, -1, 0], right: [1, 0, 0], back: [0, 1, 0],
  left: [-1, 0, 0], bottom: [0, -1e-4, -1],
};

export function lookAt(drawing, box, way) {
  const [centre, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3()).length() || 1];
  const { camera, controls, canvas } = drawing;
  const direction = way ? new THREE.Vector3(...way) : camera.position.clone().sub(controls.target);
  camera.position.copy(centre).addScaledVector(direction.normalize(), 4 * size);
  controls.target.copy(centre);
  camera.near = -8 * size;
  camera.far = 16 * size;
  camera.zoom = 1;
  camera.lookAt(centre);
  camera.updateMatrixWorld();
  const aspect = canvas.clientWidth / Math.max(canvas.clientHeight, 1);
  const seen = extentOn(camera, box);
  const high = 1.12 * Math.max(seen.y, seen.x / aspect, 1e-3);
  Object.assign(camera, { top: high / 2, bottom: -high / 2, left: (-high * aspect) / 2, right: (high * aspect) / 2 });
  camera.updateProjectionMatrix();
  controls.update();
  stir(drawing);
}

// Turn the picture about the vertical, by an angle in rad.
export function turnBy(drawing, angle) {
  const { camera, controls } = drawing;
  const arm = camera.position.clone().sub(controls.target).applyAxisAngle(camera.up, angle);
  camera.position.copy(controls.target).add(arm);
  controls.update();
  stir(drawing);
}

// How wide and high a box is on the screen, in mm.
function extentOn(camera, box) {
  const seen = new THREE.Box3();
  for (let k = 0; k < 8; k++) {
    const corner = new THREE.Vector3(...["x", "y", "z"].map((axis, bit) => ((k >> bit) & 1 ? box.max : box.min)[axis]));
    seen.expandByPoint(corner.applyMatrix4(camera.matrixWorldInverse));
  }
  return seen.getSize(new THREE.Vector3());
}

// The box of what is cut, of rapids as well if `all`.
export function boxOf(drawing, all = false) {
  const box = new THREE.Box3();
  const point = new THREE.Vector3();
  for (const shown of drawing.paths) {
    const { corners } = shown.path;
    for (let at = FIELDS; at < corners.length; at += FIELDS) {
      const manner = shown.manner[corners[at + 3]];
      if (manner === FULL || (all && manner === DASHED)) {
        for (const from of [at - FIELDS, at]) {
          point.set(corners[from], corners[from + 1], corners[from + 2]);
          box.expandByPoint(point.add(shown.group.position));
        }
      }
    }
  }
  if (box.isEmpty() && !all) return boxOf(drawing, true);
  return box.isEmpty() ? box.set(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1)) : box;
}
