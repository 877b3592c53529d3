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
  const feed = row && path.feed[row - 1] ? shown(path.feed[row - 1]) : "none";
  const { work } = program.frames[path.frame[Math.max(0, row - 1)]];
  const codes = block ? program.modes[program.mode[block - 1]].replace("@", work) : "none yet";
  return [`  modal ${codes}, F ${feed}`, `  at    ${pointBefore(program, row)}`];
}

function shown(value) {
  return String(Number(Number(value.toFixed(4)).toPrecision(6))); // no finer than they are packed
}

// A position as the words of a block say it: shifted and turned back into the frame of a move.
function wordsAt(program, row, position) {
  const { shift, inverse, diameter } = program.frames[program.path.frame[row]];
  const words = shift ? position.map((value, axis) => value - shift[axis]) : [...position];
  if (inverse) {
    const [x, y, z] = words;
    inverse.forEach((line, axis) => { words[axis] = line[0] * x + line[1] * y + line[2] * z; });
  }
  if (diameter) words[0] *= 2;
  return words;
}

function pointOf(program, row, at, known) {
  const { path } = program;
  const words = wordsAt(program, row, [...path.axes].map((_, axis) => endOf(path, at, axis)));
  const told = words.map((value, axis) => (known(axis) ? path.axes[axis] + shown(value) : axis < 3 ? `${path.axes[axis]}?` : ""));
  return told.filter(Boolean).join(" ");
}

function pointBefore(program, row) {
  return pointOf(program, row, row - 1, (axis) => startsKnown(program.path, row, axis));
}

function pointAfter(program, row) {
  return pointOf(program, row, row, (axis) => isKnown(program.path, row, axis));
}

function moveOf(program, row) {
  const { path } = program;
  const rapid = path.kind[row] === 0;
  const name = path.form[row] === SPLINE_FORM ? "spline" : NAMES[path.kind[row]];
  const parts = [`  ${name}${rapid ? "" : ` at ${shown(path.feed[row])} ${UNITS[path.mode[row]]}`}`];
  parts.push(`    from ${pointBefore(program, row)}`, `    to   ${pointAfter(program, row)}`);
  if (path.kind[row] >= 2) parts.push(...arcOf(program, row));
  for (const { name: what, of, unit } of program.sizes) parts.push(`    ${what} ${of[row] < 0 ? "not known" : `${shown(of[row])} ${unit}`}`);
  for (const { name: what, of, names } of program.sorts) parts.push(`    ${what} ${names[of[row]]}`);
  return parts;
}

function arcOf(program, row) {
  const { path } = program;
  const { u, v, centre, sweep } = circleOf(path, row);
  const radius = Math.hypot(endOf(path, row - 1, u) - centre[0], endOf(path, row - 1, v) - centre[1]);
  const middle = [...path.axes].map((_, axis) => path.ends[axis][row]);
  [middle[u], middle[v]] = centre;
  const words = wordsAt(program, row, middle);
  const about = `${path.axes[u]}${shown(words[u])} ${path.axes[v]}${shown(words[v])}`;
  const plane = PLANES[path.arcs.plane[path.arcAt[row]]];
  const degrees = shown((sweep * 180) / Math.PI);
  return [`    about ${about}, radius ${shown(radius)} mm, in the plane ${plane}`, `    through ${degrees} degrees`];
}
