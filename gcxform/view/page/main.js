// The page: programs are unpacked, drawn, listed and played, and what is chosen is told.
import { fromBase64, opener } from "./bytes.js";
import { VIEWS, boxOf, lookAt, turnBy } from "./camera.js";
import { choose, chooseByName, show } from "./choosing.js";
import { buildControls, setDark, setLayer } from "./controls.js";
import { addPath, drawNow, drawingOn } from "./drawing.js";
import { listOf } from "./list.js";
import { pointOn } from "./path.js";
import { goTo, playerOf, setTimes } from "./player.js";
import { linkAll, programOf } from "./programs.js";
import { hairsOf, sceneOf, toolAxis } from "./scene.js";
import { button, byId, fromMiddle, main, view } from "./state.js";

async function start() {
  const head = JSON.parse(byId("head").textContent);
  const open = opener(fromBase64(byId("data").textContent));
  byId("data").remove();
  view.head = head;
  byId("title").textContent = head.title;
  view.drawing = drawingOn(byId("canvas"));
  view.programs = await Promise.all(head.programs.map((each) => programOf(each, open)));
  view.drawing.middle = view.programs[0].path.middle;
  for (const program of view.programs) equip(program);
  linkAll();
  buildControls();
  setDark(matchMedia("(prefers-color-scheme: dark)").matches);
  surround();
  lookAt(view.drawing, boxOf(view.drawing), VIEWS.iso);
  view.player = playerOf({ play: byId("play"), time: byId("time"), clock: byId("clock"), speed: byId("speed") }, { show });
  setTimes(view.player, main().times);
  chooseByName(location.hash);
  const still = view.programs.filter((program) => !program.path.count);
  byId("note").textContent = [...head.notes, ...still.map(({ name }) => `${name} moves nothing.`)].join(" ");
  globalThis.gcxformView = Object.assign(view, forConsole());
  document.documentElement.dataset.ready = "yes";
}

// What is of use to whoever looks from the console, and to tests.
function forConsole() {
  return {
    drawNow: () => drawNow(view.drawing),
    goTo: (seconds) => goTo(view.player, seconds),
    turnBy: (angle) => turnBy(view.drawing, angle),
    toolAxis: (nth, row) => toolAxis(view.scene, view.programs[nth], row),
    middleOf: (nth, row) => fromMiddle(pointOn(view.programs[nth].path, row, 0.5)),
  };
}

// What stands around the paths, and a button for each kind of it.
function surround() {
  view.scene = sceneOf(view.drawing, view.head.scene, boxOf(view.drawing));
  const { layers } = view.scene;
  for (const program of view.programs) {
    const hairs = hairsOf(view.scene, program);
    if (hairs) program.shown.group.parent.add(hairs);
    if (hairs) layers["tool axes"] = layers["tool axes"] ? layers["tool axes"].add(hairs) : hairs;
  }
  for (const name of Object.keys(layers)) {
    if (name === "axes") continue;
    layers[name].visible = !["envelope", "errors"].includes(name);
    const press = button("parts", name, () => setLayer(name, press));
    press.ariaPressed = String(layers[name].visible);
  }
}

function equip(program) {
  const nth = view.programs.indexOf(program);
  program.shown = addPath(view.drawing, program.path);
  program.list = listOf(program.name, program.text, {
    choose: (line) => choose(nth, line),
    moves: (line) => program.index.first[line + 1] > program.index.first[line],
  });
  byId("lists").append(program.list.box);
}

start().catch((error) => {
  byId("note").textContent = `The page could not be shown: ${error.message}`;
  throw error;
});
