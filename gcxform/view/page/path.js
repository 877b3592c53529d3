// A path: its columns, where its moves are, how long they take, and the corners it is drawn by.
import { column } from "./bytes.js";

export const RAPID = 0;
const CW = 2;
export const SPLINE_FORM = 5;
const INVERSE = 93;
const TURN = 2 * Math.PI;
const CHORD = 2e-5; // of the size of the path: how far an arc may be from what is drawn
const FEWEST = 16; // pieces of a full circle
const MOST = 256; // pieces of one move
const PIECES = 24; // of a spline
export const FIELDS = 4; // of a corner: x, y, z and the row that ends there or leads on from there

// `tools` are the tools of the frames: from the tip to what positions are of.
export async function pathOf(head, open, tools) {
  const get = (section) => column(open, section);
  const [kind, form, unknown, block, frame, feed, mode, ...ends] = await Promise.all(
    [head.kind, head.form, head.unknown, head.block, head.frame, head.feed, head.mode, ...head.ends].map(get),
  );
  const path = {
    count: head.moves, axes: head.axes, linear: head.linear, planes: head.planes, entry: head.entry,
    entryUnknown: head.entryUnknown, kind: Uint8Array.from(kind), form: Uint8Array.from(form),
    unknown: Uint32Array.from(unknown), block: Uint32Array.from(block), frame, feed,
    mode: Uint8Array.from(mode), ends, arcs: await arcsOf(head, get), splines: await splinesOf(head, get),
    vectors: head.vectors ? await Promise.all(head.vectors.map(get)) : null,
    tools: tools.some(Boolean) ? tools : null, tips: await tipsOf(head, get),
  };
  path.arcAt = places(path.kind, (value) => value >= CW);
  path.splineAt = places(path.form, (value) => value === SPLINE_FORM);
  path.size = sizeOf(path);
  return Object.assign(path, cornersOf(path));
}

async function arcsOf(head, get) {
  if (!head.arcs) return null;
  const names = ["plane", "first", "second", "sweep"];
  const found = await Promise.all(names.map((name) => get(head.arcs[name])));
  return Object.fromEntries(names.map((name, k) => [name, found[k]]));
}

async function splinesOf(head, get) {
  return head.splines ? Promise.all(head.splines.map(get)) : null;
}

// Where the tip is on the workpiece, for positions of axes that turn.
async function tipsOf(head, get) {
  if (!head.tips) return null;
  const [pieces, ...points] = await Promise.all([head.tips.pieces, ...head.tips.points].map(get));
  return { entry: head.tips.entry, pieces: Uint16Array.from(pieces), points };
}

// For each row, how many before it are of a kind: where its values stand in a shorter column.
function places(values, belongs) {
  const found = new Uint32Array(values.length + 1);
  for (let row = 0; row < values.length; row++) found[row + 1] = found[row] + belongs(values[row]);
  return found;
}

export function endOf(path, row, axis) {
  return row < 0 ? path.entry[axis] : path.ends[axis][row];
}

export function isKnown(path, row, axis) {
  return row < 0 ? !path.entryUnknown[axis] : !((path.unknown[row] >> axis) & 1);
}

export function startsKnown(path, row, axis) {
  return isKnown(path, row - 1, axis) && !((path.unknown[row] >> (16 + axis)) & 1);
}

// Whether the course of a move is known: it starts where it is known if it ends there.
export function isDrawn(path, row) {
  for (let axis = 0; axis < 3; axis++) {
    if (isKnown(path, row, axis) && !startsKnown(path, row, axis)) return false;
  }
  return true;
}

function sizeOf(path) {
  let square = 0;
  for (let axis = 0; axis < 3; axis++) {
    let [low, high] = [Infinity, -Infinity];
    for (const value of path.ends[axis]) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
    if (high > low) square += (high - low) ** 2;
  }
  return Math.sqrt(square) || 1;
}

// --- corners ---

function cornersOf(path) {
  const { tips } = path;
  const pieces = new Uint16Array(path.count).fill(1);
  let total = path.count + 1;
  for (let row = 0; row < path.count; row++) {
    if (tips) pieces[row] = Math.max(1, tips.pieces[row]);
    else if (path.kind[row] >= CW) pieces[row] = piecesOfArc(path, row);
    else if (path.form[row] === SPLINE_FORM) pieces[row] = PIECES;
    total += pieces[row] - 1;
  }
  const corners = new Float32Array(FIELDS * total);
  const last = new Uint32Array(path.count + 1); // the corner in which each row ends, from 1
  const middle = middleOf(path);
  const put = (corner, [x, y, z], row) => {
    const at = FIELDS * corner;
    corners[at] = x - middle[0];
    corners[at + 1] = y - middle[1];
    corners[at + 2] = z - middle[2];
    corners[at + 3] = row;
  };
  put(0, tips ? tips.entry : lowered(path, 0, positionAt(path, -1)), 0);
  let corner = 0;
  for (let row = 0; row < path.count; row++) {
    for (let piece = 1; piece <= pieces[row]; piece++, corner++) {
      if (tips) put(corner + 1, tips.points.map((column) => column[corner]), row);
      else if (piece < pieces[row]) put(corner + 1, pointOn(path, row, piece / pieces[row]), row);
      else put(corner + 1, lowered(path, row, positionAt(path, row)), row);
    }
    last[row + 1] = corner;
  }
  return { corners, last, middle };
}

function positionAt(path, row) {
  return [endOf(path, row, 0), endOf(path, row, 1), endOf(path, row, 2)];
}

// From a position of a row to the tip of its tool.
function lowered(path, row, position) {
  const tool = path.tools?.[path.frame[row]];
  return tool ? position.map((value, axis) => value - tool[axis]) : position;
}

// The middle of the path: what is drawn counts from there, so that single precision is enough.
function middleOf(path) {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  const count = path.tips ? path.tips.points[0].length : path.count;
  for (let k = 0; k < count; k++) {
    const point = path.tips ? path.tips.points.map((column) => column[k]) : lowered(path, k, positionAt(path, k));
    for (let axis = 0; axis < 3; axis++) {
      low[axis] = Math.min(low[axis], point[axis]);
      high[axis] = Math.max(high[axis], point[axis]);
    }
  }
  return low.map((value, axis) => (count ? (value + high[axis]) / 2 : 0));
}

function piecesOfArc(path, row) {
  const at = path.arcAt[row];
  const radius = Math.hypot(path.arcs.first[at], path.arcs.second[at]);
  const half = radius > CHORD * path.size ? Math.acos(1 - (CHORD * path.size) / radius) : 1;
  const sweep = path.arcs.sweep[at];
  const wanted = Math.max(sweep / (2 * half), (sweep / TURN) * FEWEST);
  return Math.min(MOST, Math.max(1, Math.ceil(wanted)));
}

// Where the tip is in a move at a part of its way, from 0 to 1.
export function pointOn(path, row, part) {
  return path.tips ? pointOnTips(path, row, part) : lowered(path, row, pointOnAxes(path, row, part));
}

function pointOnTips(path, row, part) {
  const at = path.last[row] + part * (path.last[row + 1] - path.last[row]);
  const from = Math.min(Math.floor(at), path.last[row + 1] - 1);
  const [a, share] = [FIELDS * from, at - from];
  return path.middle.map((value, axis) => value + (1 - share) * path.corners[a + axis] + share * path.corners[a + FIELDS + axis]);
}

function pointOnAxes(path, row, part) {
  const from = [0, 1, 2].map((axis) => endOf(path, row - 1, axis));
  const to = [0, 1, 2].map((axis) => path.ends[axis][row]);
  if (path.kind[row] >= CW) return pointOnArc(path, row, part, from, to);
  if (path.form[row] === SPLINE_FORM) return pointOnSpline(path, row, part, from, to);
  return from.map((value, axis) => value + part * (to[axis] - value));
}

export function circleOf(path, row) {
  const at = path.arcAt[row];
  const [u, v, normal] = path.planes[path.arcs.plane[at]];
  const centre = [path.ends[u][row] + path.arcs.first[at], path.ends[v][row] + path.arcs.second[at]];
  return { u, v, normal, centre, sweep: path.arcs.sweep[at], sense: path.kind[row] === CW ? -1 : 1 };
}

// The radius changes evenly, as in gcxform/toolpath/circles.py.
function pointOnArc(path, row, part, from, to) {
  const { u, v, centre, sweep, sense } = circleOf(path, row);
  const [x, y] = [from[u] - centre[0], from[v] - centre[1]];
  const [first, last] = [Math.hypot(x, y), Math.hypot(to[u] - centre[0], to[v] - centre[1])];
  const angle = Math.atan2(y, x) + sense * sweep * part;
  const size = first + (last - first) * part;
  const point = from.map((value, axis) => value + part * (to[axis] - value));
  point[u] = centre[0] + size * Math.cos(angle);
  point[v] = centre[1] + size * Math.sin(angle);
  return point;
}

function pointOnSpline(path, row, t, from, to) {
  const [at, s] = [path.splineAt[row], 1 - t];
  return from.map((value, axis) => {
    const [one, two] = [path.splines[axis][at], path.splines[3 + axis][at]];
    return s ** 3 * value + 3 * s * s * t * one + 3 * s * t * t * two + t ** 3 * to[axis];
  });
}

// --- lengths and times ---

// How long a move of the axes is, mm.
export function lengthOf(path, row) {
  if (path.kind[row] < CW && path.form[row] !== SPLINE_FORM) {
    return Math.hypot(...[0, 1, 2].map((axis) => path.ends[axis][row] - endOf(path, row - 1, axis)));
  }
  let length = 0;
  const [from, to] = [path.last[row], path.last[row + 1]];
  for (let corner = from; corner < to; corner++) {
    const at = FIELDS * corner;
    length += Math.hypot(
      path.corners[at + 4] - path.corners[at], path.corners[at + 5] - path.corners[at + 1],
      path.corners[at + 6] - path.corners[at + 2],
    );
  }
  return length;
}

function turnOf(path, row) {
  let square = 0;
  for (let axis = 0; axis < path.ends.length; axis++) {
    if (!path.linear[axis]) square += (path.ends[axis][row] - endOf(path, row - 1, axis)) ** 2;
  }
  return Math.sqrt(square);
}

// When each move ends, in seconds; `speeds` are the top speeds of the axes for rapids.
export function timesOf(path, speeds) {
  const ends = new Float64Array(path.count + 1);
  for (let row = 0; row < path.count; row++) {
    const seconds = secondsOf(path, row, speeds);
    ends[row + 1] = ends[row] + (Number.isFinite(seconds) ? seconds : 0);
  }
  return ends;
}

function secondsOf(path, row, speeds) {
  if (!isDrawn(path, row)) return 0;
  if (path.kind[row] === RAPID) return rapidSeconds(path, row, speeds);
  const feed = path.feed[row];
  if (path.mode[row] === INVERSE) return 60 / feed;
  return (60 * (lengthOf(path, row) || turnOf(path, row))) / feed;
}

// The slowest axis decides how long a rapid takes.
function rapidSeconds(path, row, speeds) {
  let most = 0;
  for (let axis = 0; axis < path.ends.length; axis++) {
    const way = Math.abs(path.ends[axis][row] - endOf(path, row - 1, axis));
    const speed = speeds[path.axes[axis]] ?? speeds.assumed;
    most = Math.max(most, (60 * way) / speed);
  }
  return most;
}
