// The page: programs are unpacked, drawn, listed and played, and what is chosen is told.
import { fromBase64, column, opener } from "./bytes.js";
import { showCertificate } from "./certificate.js";
import { GREY, OKABE_ITO, css, gradient, ramp } from "./colours.js";
import { VIEWS, addPath, boxOf, drawNow, drawingOn, highlight, lookAt, paint, redraw, setGround, stir, turnBy, unmark } from "./drawing.js";
import { listOf, mark } from "./list.js";
import { lineOf, textOf } from "./lines.js";
import { RAPID, pathOf, pointOn, timesOf } from "./path.js";
import { rowAt } from "./picking.js";
import { goTo, playerOf, rowAtTime, setTimes, toggle } from "./player.js";
import { hairsOf, placeTool, sceneOf, toolAxis } from "./scene.js";
import { toldOf } from "./told.js";

const byId = (id) => document.getElementById(id);
const KINDS = ["rapid", "line", "clockwise arc", "counter-clockwise arc"];
const MARKED = [230, 60, 130];
const MOST_MARKED = 400; // moves that are highlighted at once
const KEYS = `space  play or stop          ← →  one move back or on
↑ ↓  one line (in a list)     f  all of it
1 to 7  isometric, top, front, right, back, left, bottom
+ -  nearer, farther          c  next colour
s  next of the programs       r  rapids
d  dark or light              esc  nothing chosen
drag to turn, drag with the right button or two fingers to move, wheel or pinch to zoom, click a move`;

const view = { programs: [], chosen: null, colour: "kind", rapids: true, alone: -1, dark: false };

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

// A point as it is drawn: from the middle of the first program.
function fromMiddle(point) {
  return point.map((value, axis) => value - view.drawing.middle[axis]);
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

function setLayer(name, press) {
  const { layers } = view.scene;
  layers[name].visible = !layers[name].visible;
  if (name === "grid") layers.axes.visible = layers.grid.visible;
  press.ariaPressed = String(layers[name].visible);
  showLegend();
  redraw(view.drawing);
}

// The program that is played: the last, which is what the machine is given.
function main() {
  return view.programs[view.programs.length - 1];
}

// --- programs ---

async function programOf(head, open) {
  const path = await pathOf(head.path, open);
  const get = (section) => column(open, section);
  const program = {
    name: head.name, words: head.words, follows: head.follows, frames: head.frames, modes: head.modes, path, text: textOf(head, open),
    mode: await get(head.mode), line: head.line ? Uint32Array.from(await get(head.line)) : null,
    from: head.from ? Int32Array.from(await get(head.from)) : null, sizes: [], sorts: [],
  };
  for (const each of head.sizes) program.sizes.push({ ...each, of: await get(each.of) });
  for (const each of head.sorts) program.sorts.push({ ...each, of: await get(each.of) });
  program.times = timesOf(path, head.speeds);
  const lineOfRow = (row) => (program.line ? program.line[path.block[row]] : path.block[row]);
  program.lineOfRow = lineOfRow;
  program.index = indexOf(path.count, lineOfRow, head.lines);
  program.rowsOf = (line) => membersOf(program.index, line);
  program.lineAt = (line) => lineOf(program.text, line);
  return program;
}

// Which of `count` things belong to each of `groups`: offsets, and the things in order.
function indexOf(count, groupOf, groups) {
  const first = new Uint32Array(groups + 2);
  for (let k = 0; k < count; k++) first[groupOf(k) + 2] += 1;
  for (let k = 2; k < first.length; k++) first[k] += first[k - 1];
  const order = new Uint32Array(count);
  for (let k = 0; k < count; k++) order[first[groupOf(k) + 1]++] = k;
  return { first, order };
}

function membersOf(index, group) {
  return Array.from(index.order.subarray(index.first[group], index.first[group + 1]));
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

// Lines of the source by lines of the output, and the other way.
function linkAll() {
  const [source, output] = view.programs;
  if (!output?.from) return;
  source.linkOf = indexOf(output.from.length, (line) => output.from[line] + 1, source.text.count + 1);
}

function linesLinked(nth, line) {
  const [source, output] = view.programs;
  if (!output?.from) return [];
  if (nth === 1) return output.from[line] >= 0 ? [output.from[line]] : [];
  return membersOf(source.linkOf, line + 1);
}

// --- what is chosen ---

function choose(nth, line) {
  view.chosen = { nth, line };
  const other = view.programs.length > 1 ? 1 - nth : -1;
  const linked = other >= 0 ? linesLinked(nth, line) : [];
  unmark(view.drawing);
  mark(view.programs[nth].list, line);
  light(view.programs[nth], view.programs[nth].rowsOf(line));
  if (other >= 0) {
    mark(view.programs[other].list, -1, linked);
    light(view.programs[other], linked.slice(0, MOST_MARKED).flatMap((each) => view.programs[other].rowsOf(each)));
  }
  history.replaceState(null, "", `#${nth + 1}:${line + 1}`);
  tell(nth, line, other, linked);
}

function light(program, rows) {
  highlight(view.drawing, program.shown, rows.slice(0, MOST_MARKED), MARKED);
}

async function tell(nth, line, other, linked) {
  const parts = [[view.programs[nth], line]];
  for (const each of linked.slice(0, 3)) parts.push([view.programs[other], each]);
  const told = await Promise.all(parts.map(([program, each]) => toldOf(program, each)));
  if (view.chosen?.nth !== nth || view.chosen?.line !== line) return;
  const page = byId("told");
  page.replaceChildren();
  parts.forEach(([program, each], k) => {
    page.append(made("h2", `${program.name}, line ${each + 1}`), made("pre", told[k]));
  });
  if (linked.length > 3) page.append(made("p", `and ${linked.length - 3} more lines`));
}

function chooseNothing() {
  view.chosen = null;
  unmark(view.drawing);
  for (const program of view.programs) mark(program.list, -1);
  byId("told").replaceChildren(made("p", "Click a move or a line."));
  history.replaceState(null, "", location.pathname);
}

// `#2:812` is line 812 of the second program.
function chooseByName(name) {
  const found = /^#(\d+):(\d+)$/.exec(name);
  const program = found && view.programs[found[1] - 1];
  if (program && found[2] >= 1 && found[2] <= program.text.count) choose(found[1] - 1, found[2] - 1);
  else byId("told").replaceChildren(made("p", "Click a move or a line."));
}

function made(kind, text) {
  const element = document.createElement(kind);
  element.textContent = text;
  return element;
}

function clicked(x, y) {
  let best = { row: -1, score: Infinity, nth: -1 };
  view.programs.forEach((program, nth) => {
    if (!program.shown.group.visible) return;
    const found = rowAt(view.drawing, program.shown, x, y);
    if (found.row >= 0 && found.score <= best.score) best = { ...found, nth };
  });
  if (best.row < 0) return;
  const program = view.programs[best.nth];
  choose(best.nth, program.lineOfRow(best.row));
  if (program === main()) goTo(view.player, program.times[best.row + 1]);
}

// --- time ---

function show(seconds) {
  const program = main();
  if (!program.path.count) return;
  const { row, part } = rowAtTime(program.times, seconds);
  view.at = { row, part };
  program.shown.uniforms.played.value = seconds >= view.player.total ? Infinity : row - 1 + part;
  placeTool(view.scene, program, fromMiddle(pointOn(program.path, row, part)), row);
  view.scene.tool.visible = seconds < view.player.total || view.chosen !== null;
  stir(view.drawing);
}

function stepMove(by) {
  const program = main();
  if (!program.path.count) return;
  const row = Math.min(program.path.count - 1, Math.max(0, (view.at?.row ?? 0) + by));
  goTo(view.player, program.times[row + 1]);
  view.at = { row, part: 1 };
  choose(view.programs.length - 1, program.lineOfRow(row));
}

// --- colours ---

function paintAll() {
  for (const program of view.programs) {
    const colourOf = colourer(program);
    paint(view.drawing, program.shown, (row) => (view.rapids || program.path.kind[row] !== RAPID ? colourOf(row) : null));
    const behind = view.programs.length > 1 && program !== main() && view.alone < 0;
    program.shown.uniforms.single.value = behind ? [...GREY.map((each) => each / 255), 1] : [0, 0, 0, 0];
    program.shown.uniforms.width.value = behind ? 1.2 : 2;
    program.shown.uniforms.behind.value = behind ? 1e-4 : 0;
  }
  showLegend();
}

function colourer(program) {
  const { path } = program;
  if (view.colour === "kind") return (row) => (path.kind[row] === RAPID ? GREY : OKABE_ITO[path.kind[row] - 1]);
  if (view.colour === "feed") return sized(program, path.feed, rangeOf("feed"));
  const size = program.sizes.find((each) => each.name === view.colour);
  if (size) return sized(program, size.of, rangeOf(view.colour));
  const sort = program.sorts.find((each) => each.name === view.colour);
  return sort ? (row) => OKABE_ITO[sort.of[row] % OKABE_ITO.length] : () => GREY;
}

function sized(program, values, [low, high]) {
  const span = high - low || 1;
  const plain = (row) => program.path.kind[row] === RAPID || !(values[row] >= 0);
  return (row) => (plain(row) ? GREY : ramp((values[row] - low) / span, view.dark));
}

function rangeOf(name) {
  let [low, high] = [Infinity, -Infinity];
  for (const { path, sizes } of view.programs) {
    const values = name === "feed" ? path.feed : sizes.find((each) => each.name === name)?.of ?? [];
    for (let row = 0; row < values.length; row++) {
      if (path.kind[row] === RAPID || !(values[row] >= 0)) continue;
      low = Math.min(low, values[row]);
      high = Math.max(high, values[row]);
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

function colourNames() {
  const names = new Set(["kind", "feed"]);
  for (const { sizes, sorts } of view.programs) for (const each of [...sizes, ...sorts]) names.add(each.name);
  return [...names];
}

function showLegend() {
  const legend = byId("legend");
  legend.replaceChildren();
  const sort = view.programs.flatMap(({ sorts }) => sorts).find((each) => each.name === view.colour);
  const names = view.colour === "kind" ? KINDS : sort?.names;
  if (view.scene?.layers.errors?.visible) {
    const { factor, most } = view.scene;
    legend.append(made("div", `errors of the machine × ${factor}, largest ${Number((1000 * most).toPrecision(4))} um`));
  }
  if (names) {
    names.slice(0, 24).forEach((name, k) => {
      const colour = view.colour !== "kind" ? OKABE_ITO[k % OKABE_ITO.length] : k ? OKABE_ITO[k - 1] : GREY;
      const swatch = made("i", "");
      swatch.className = "swatch";
      swatch.style.background = css(colour);
      legend.append(swatch, made("span", name));
    });
    return;
  }
  const unit = view.programs.flatMap(({ sizes }) => sizes).find((each) => each.name === view.colour)?.unit ?? "";
  const [low, high] = rangeOf(view.colour);
  const bar = made("i", "");
  bar.className = "bar";
  bar.style.background = gradient(view.dark);
  const ends = made("span", "");
  ends.className = "ends";
  ends.append(made("span", `${Number(low.toPrecision(4))}`), made("span", `${view.colour} ${unit}`), made("span", `${Number(high.toPrecision(4))}`));
  legend.append(bar, ends);
}

// --- controls ---

function buildControls() {
  for (const name of colourNames()) byId("colour").add(new Option(name, name));
  byId("colour").addEventListener("change", () => setColour(byId("colour").value));
  if (view.programs.length > 1) {
    [["both", -1], ["before", 0], ["after", 1]].forEach(([name, nth]) => button("sides", name, () => setAlone(nth)));
    setAlone(-1);
  }
  button("parts", "rapids", () => setRapids(!view.rapids)).ariaPressed = "true";
  button("views", "all", () => lookAt(view.drawing, boxOf(view.drawing, view.rapids)));
  for (const name of ["iso", "top", "front", "right"]) button("views", name, () => turn(name));
  byId("theme").addEventListener("click", () => setDark(!view.dark));
  byId("help").addEventListener("click", showHelp);
  document.addEventListener("keydown", pressed);
  if (view.head.certificate) addCertificate();
  listenToCanvas(byId("canvas"));
}

function button(where, name, act) {
  const element = made("button", name);
  element.type = "button";
  element.addEventListener("click", act);
  byId(where).append(element);
  return element;
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

function setDark(dark) {
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
  byId("path").hidden = name !== "path";
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

// --- keys ---

const ACTS = {
  " ": () => toggle(view.player),
  ArrowRight: () => stepMove(1),
  ArrowLeft: () => stepMove(-1),
  f: () => lookAt(view.drawing, boxOf(view.drawing, view.rapids)),
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

start().catch((error) => {
  byId("note").textContent = `The page could not be shown: ${error.message}`;
  throw error;
});
