// What a line says and does, in the words of `gcxform explain`.
import { lineOf } from "./lines.js";
import { SPLINE_FORM, circleOf, endOf, isKnown, startsKnown } from "./path.js";

const NAMES = ["rapid", "line", "clockwise arc", "counter-clockwise arc"];
const UNITS = { 93: "1/min", 94: "mm/min", 95: "mm/turn" };
const PLANES = ["XY", "ZX", "YZ"];
const MOST = 12; // moves of a line that are told one by one

// The paragraphs about a line of a program.
export async function toldOf(program, line) {
  const text = await lineOf(program.text, line);
  const parts = [`${program.name}:${line + 1}  ${text}`, "", ...wordsOf(program, text)];
  const rows = program.rowsOf(line);
  if (!rows.length) return [...parts, "", "  it moves nothing"].join("\n");
  parts.push("", "before it", ...before(program, rows[0]), "", "what it does");
  for (const row of rows.slice(0, MOST)) parts.push(...moveOf(program, row));
  if (rows.length > MOST) parts.push(`  and ${rows.length - MOST} more moves`);
  return parts.join("\n");
}

// The words of a block, where its language has words.
function wordsOf(program, text) {
  if (!program.words) return [];
  const found = [];
  const item = /\(([^)]*)\)|;.*$|([A-Za-z])\s*([+-]?[\d.]+)|([A-Za-z]+)\s*(=?\s*[[#][^\s]*)/g;
  for (const [all, , letter, number, name, value] of text.matchAll(item)) {
    if (letter) found.push(`  word ${letter.toUpperCase()}, number ${number}`);
    else if (name) found.push(`  word ${name.toUpperCase()}, expression ${value}`);
    else found.push(`  comment ${all}`);
  }
  return found;
}

function before(program, row) {
  const { path } = program;
  const block = path.block[row];
  const feed = row ? `${shown(path.feed[row - 1])}` : "none";
  const codes = block ? program.modes[program.mode[block - 1]] : "none yet";
  return [`  modal ${codes}, F ${feed}`, `  at    ${pointBefore(path, row)}`];
}

function shown(value) {
  return String(Number(value.toPrecision(6)));
}

function placed(path, value, known, axis) {
  return known || axis < 3 ? `${path.axes[axis]}${known ? shown(value) : "?"}` : "";
}

function pointBefore(path, row) {
  return [...path.axes].map((_, axis) => placed(path, endOf(path, row - 1, axis), startsKnown(path, row, axis), axis)).filter(Boolean).join(" ");
}

function pointAfter(path, row) {
  return [...path.axes].map((_, axis) => placed(path, path.ends[axis][row], isKnown(path, row, axis), axis)).filter(Boolean).join(" ");
}

function moveOf(program, row) {
  const { path } = program;
  const rapid = path.kind[row] === 0;
  const name = path.form[row] === SPLINE_FORM ? "spline" : NAMES[path.kind[row]];
  const parts = [`  ${name}${rapid ? "" : ` at ${shown(path.feed[row])} ${UNITS[path.mode[row]]}`}`];
  parts.push(`    from ${pointBefore(path, row)}`, `    to   ${pointAfter(path, row)}`);
  if (path.kind[row] >= 2) parts.push(...arcOf(path, row));
  for (const { name: what, of, unit } of program.sizes) parts.push(`    ${what} ${of[row] < 0 ? "not known" : `${shown(of[row])} ${unit}`}`);
  for (const { name: what, of, names } of program.sorts) parts.push(`    ${what} ${names[of[row]]}`);
  return parts;
}

function arcOf(path, row) {
  const { u, v, centre, sweep } = circleOf(path, row);
  const radius = Math.hypot(endOf(path, row - 1, u) - centre[0], endOf(path, row - 1, v) - centre[1]);
  const plane = PLANES[path.arcs.plane[path.arcAt[row]]];
  const about = `${path.axes[u]}${shown(centre[0])} ${path.axes[v]}${shown(centre[1])}`;
  const degrees = shown((sweep * 180) / Math.PI);
  return [`    about ${about}, radius ${shown(radius)} mm, in the plane ${plane}`, `    through ${degrees} degrees`];
}

