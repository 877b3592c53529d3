// What is chosen, and when: a line and its moves, a move and its line, and the tool at a time.
import { highlight, stir, unmark } from "./drawing.js";
import { mark } from "./list.js";
import { pointOn } from "./path.js";
import { rowAt } from "./picking.js";
import { goTo, rowAtTime } from "./player.js";
import { linesLinked } from "./programs.js";
import { hidePlane, placePlane, placeTool } from "./scene.js";
import { byId, fromMiddle, made, main, view } from "./state.js";
import { toldOf } from "./told.js";

const MARKED = [230, 60, 130];
const MOST_MARKED = 400; // moves that are highlighted at once

export function choose(nth, line) {
  view.chosen = { nth, line };
  const other = view.programs.length > 1 ? 1 - nth : -1;
  const linked = other >= 0 ? linesLinked(nth, line) : [];
  unmark(view.drawing);
  mark(view.programs[nth].list, line);
  const rows = view.programs[nth].rowsOf(line);
  light(view.programs[nth], rows);
  if (rows.length) placePlane(view.scene, view.programs[nth], fromMiddle(pointOn(view.programs[nth].path, rows[0], 0.5)), rows[0]);
  else hidePlane(view.scene);
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

export function chooseNothing() {
  view.chosen = null;
  unmark(view.drawing);
  hidePlane(view.scene);
  for (const program of view.programs) mark(program.list, -1);
  byId("told").replaceChildren(made("p", "Click a move or a line."));
  history.replaceState(null, "", location.pathname);
}

// `#2:812` is line 812 of the second program.
export function chooseByName(name) {
  const found = /^#(\d+):(\d+)$/.exec(name);
  const program = found && view.programs[found[1] - 1];
  if (program && found[2] >= 1 && found[2] <= program.text.count) choose(found[1] - 1, found[2] - 1);
  else byId("told").replaceChildren(made("p", "Click a move or a line."));
}

export function clicked(x, y) {
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

export function show(seconds) {
  const program = main();
  if (!program.path.count) return;
  const { row, part } = rowAtTime(program.times, seconds);
  view.at = { row, part };
  program.shown.uniforms.played.value = seconds >= view.player.total ? Infinity : row - 1 + part;
  const point = fromMiddle(pointOn(program.path, row, part));
  placeTool(view.scene, program, point, row);
  view.scene.tool.visible = seconds < view.player.total || view.chosen !== null;
  if (seconds < view.player.total) placePlane(view.scene, program, point, row);
  else if (!view.chosen) hidePlane(view.scene);
  stir(view.drawing);
}

export function stepMove(by) {
  const program = main();
  if (!program.path.count) return;
  const row = Math.min(program.path.count - 1, Math.max(0, (view.at?.row ?? 0) + by));
  goTo(view.player, program.times[row + 1]);
  view.at = { row, part: 1 };
  choose(view.programs.length - 1, program.lineOfRow(row));
}
