// Buttons, menus and keys.
import { VIEWS, boxOf, lookAt } from "./camera.js";
import { showCertificate } from "./certificate.js";
import { chooseNothing, clicked, stepMove } from "./choosing.js";
import { redraw, setGround } from "./drawing.js";
import { colourNames, paintAll, showLegend } from "./painting.js";
import { toggle } from "./player.js";
import { byId, button, made, view } from "./state.js";

const KEYS = `space  play or stop          ← →  one move back or on
↑ ↓  one line (in a list)     f  all of it
1 to 7  isometric, top, front, right, back, left, bottom
+ -  nearer, farther          c  next colour
s  next of the programs       r  rapids
d  dark or light              esc  nothing chosen
drag to turn, drag with the right button or two fingers to move, wheel or pinch to zoom, click a move`;

export function buildControls() {
  for (const name of colourNames()) byId("colour").add(new Option(name, name));
  byId("colour").addEventListener("change", () => setColour(byId("colour").value));
  if (view.programs.length > 1) {
    [["both", -1], ["before", 0], ["after", 1]].forEach(([name, nth]) => button("sides", name, () => setAlone(nth)));
    setAlone(-1);
  }
  button("parts", "rapids", () => setRapids(!view.rapids)).ariaPressed = "true";
  button("views", "all", lookAtAll);
  for (const name of ["iso", "top", "front", "right"]) button("views", name, () => turn(name));
  byId("theme").addEventListener("click", () => setDark(!view.dark));
  byId("help").addEventListener("click", showHelp);
  document.addEventListener("keydown", pressed);
  if (view.head.certificate) addCertificate();
  listenToCanvas(byId("canvas"));
}

// Let all that is shown be seen, the machine as well where it is.
function lookAtAll() {
  const box = boxOf(view.drawing, view.rapids);
  for (const name of ["envelope", "errors"]) {
    const layer = view.scene.layers[name];
    if (layer?.visible) box.union(new THREE.Box3().setFromObject(layer));
  }
  lookAt(view.drawing, box);
}

function turn(name) {
  lookAt(view.drawing, boxOf(view.drawing, view.rapids), VIEWS[name]);
}

function setColour(name) {
  view.colour = name;
  byId("colour").value = name;
  paintAll();
}

function setAlone(nth) {
  view.alone = nth;
  view.programs.forEach((program, k) => { program.shown.group.visible = nth < 0 || nth === k; });
  [...byId("sides").children].forEach((each, k) => { each.ariaPressed = String(k === nth + 1); });
  paintAll();
}

function setRapids(seen) {
  view.rapids = seen;
  byId("parts").firstChild.ariaPressed = String(seen);
  paintAll();
}

export function setDark(dark) {
  view.dark = dark;
  document.documentElement.classList.toggle("dark", dark);
  setGround(view.drawing, getComputedStyle(document.documentElement).getPropertyValue("--ground").trim());
  paintAll();
}

function addCertificate() {
  const pages = { path: "path", certificate: "certificate" };
  showCertificate(byId("certificate"), view.head.certificate);
  for (const name of Object.keys(pages)) {
    const tab = button("tabs", name, () => setTab(name));
    tab.role = "tab";
    tab.ariaSelected = String(name === "path");
  }
}

function setTab(name) {
  for (const tab of byId("tabs").children) tab.ariaSelected = String(tab.textContent === name);
  for (const part of [byId("path"), document.querySelector(".tools"), document.querySelector("footer")]) part.hidden = name !== "path";
  byId("certificate").hidden = name !== "certificate";
}

function showHelp() {
  const dialog = byId("keys");
  const close = made("button", "close");
  close.addEventListener("click", () => dialog.close());
  dialog.replaceChildren(made("h2", "Keys"), made("pre", KEYS), made("h2", "three.js"), made("pre", byId("licence").content.textContent), close);
  dialog.showModal();
}

function listenToCanvas(canvas) {
  let down = null;
  canvas.addEventListener("pointerdown", (event) => { down = [event.offsetX, event.offsetY]; });
  canvas.addEventListener("pointerup", (event) => {
    if (down && Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) < 5) clicked(event.offsetX, event.offsetY);
    down = null;
  });
}

export function setLayer(name, press) {
  const { layers } = view.scene;
  layers[name].visible = !layers[name].visible;
  if (name === "grid") layers.axes.visible = layers.grid.visible;
  press.ariaPressed = String(layers[name].visible);
  showLegend();
  redraw(view.drawing);
}

// --- keys ---

const ACTS = {
  " ": () => toggle(view.player),
  ArrowRight: () => stepMove(1),
  ArrowLeft: () => stepMove(-1),
  f: lookAtAll,
  "+": () => zoom(1.25),
  "-": () => zoom(0.8),
  c: () => setColour(after(colourNames(), view.colour)),
  s: () => view.programs.length > 1 && setAlone(after([-1, 0, 1], view.alone)),
  r: () => setRapids(!view.rapids),
  d: () => setDark(!view.dark),
  "?": showHelp,
  Escape: chooseNothing,
  ...Object.fromEntries(Object.keys(VIEWS).map((name, k) => [String(k + 1), () => turn(name)])),
};

function after(list, value) {
  return list[(list.indexOf(value) + 1) % list.length];
}

function zoom(by) {
  view.drawing.camera.zoom *= by;
  view.drawing.camera.updateProjectionMatrix();
  view.drawing.controls.update();
  redraw(view.drawing);
}

function pressed(event) {
  const busy = event.target.matches("input, select, textarea") || event.ctrlKey || event.metaKey || event.altKey;
  const isButton = event.target.matches("button") && event.key === " ";
  if (busy || isButton || byId("keys").open || !ACTS[event.key]) return;
  event.preventDefault();
  ACTS[event.key]();
}
