// The lines of a program, unpacked in blocks when they are looked at: see gcxform/view/lines.py.
import { unfolded } from "./bytes.js";

const LINES = 4096;
const KEPT = 24; // blocks
const MARK = "\0";
const [WIDTH, PLUS, ZERO] = [32, 1024, 2048];

export function textOf(head, open) {
  return { count: head.lines, blocks: head.blocks, open, known: new Map() };
}

// The text of a line, or undefined where its block is still being opened.
export function lineNow(text, line) {
  const block = text.known.get(Math.floor(line / LINES));
  return block instanceof Array ? block[line % LINES] : undefined;
}

export async function lineOf(text, line) {
  const block = await blockOf(text, Math.floor(line / LINES));
  return block[line % LINES] ?? "";
}

export async function blockOf(text, nth) {
  if (!text.known.has(nth)) {
    text.known.set(nth, opened(text, nth));
    if (text.known.size > KEPT) text.known.delete(text.known.keys().next().value);
  }
  return text.known.get(nth);
}

async function opened(text, nth) {
  const found = linesOf(await text.open(text.blocks[nth]));
  if (text.known.has(nth)) text.known.set(nth, found);
  return found;
}

function linesOf(octets) {
  const size = new DataView(octets.buffer, octets.byteOffset).getUint32(0, true);
  const head = JSON.parse(latin(octets.subarray(4, 4 + size)));
  const rest = octets.subarray(4 + size);
  if (!head.which) return latin(rest).split("\n").map(readable);
  const templates = latin(rest.subarray(0, head.templates)).split("\n");
  const which = unfolded(rest, head.which, head.templates);
  const columns = columnsOf(head, rest);
  return Array.from(which, (k) => readable(filled(templates[k], columns)));
}

function columnsOf(head, octets) {
  let at = head.templates + head.which.n * head.which.width;
  const found = new Map();
  for (const { letter, decimals, number, manner } of head.columns) {
    const values = unfolded(octets, number, at);
    at += number.n * number.width;
    const manners = unfolded(octets, manner, at);
    at += manner.n * manner.width;
    found.set(letter, { values, manners, decimals, next: 0 });
  }
  return found;
}

function filled(template, columns) {
  const parts = template.split(MARK);
  let line = parts[0];
  for (let k = 1; k < parts.length; k++) {
    const column = columns.get(line[line.length - 1]);
    const at = column.next++;
    line += numberOf(column.values[at], column.manners[at], column.decimals) + parts[k];
  }
  return line;
}

// A number as it was written.
function numberOf(value, manner, finest) {
  const point = manner % WIDTH;
  const decimals = Math.max(point - 1, 0);
  const digits = Math.floor((manner % PLUS) / WIDTH) - 1;
  const sign = value < 0 || manner & ZERO ? "-" : manner & PLUS ? "+" : "";
  const all = String(Math.round(Math.abs(value) / 10 ** (finest - decimals)));
  const padded = all.padStart(decimals + (digits < 0 ? 1 : digits), "0");
  const whole = padded.slice(0, padded.length - decimals);
  return sign + whole + (point ? "." + padded.slice(padded.length - decimals) : "");
}

function latin(octets) {
  let found = "";
  for (let at = 0; at < octets.length; at += 8192) {
    found += String.fromCharCode(...octets.subarray(at, at + 8192));
  }
  return found;
}

// Bytes as text: UTF-8 where they are that, else Latin-1.
function readable(line) {
  if (!/[\x80-\xff]/.test(line)) return line;
  try {
    const octets = Uint8Array.from(line, (character) => character.charCodeAt(0));
    return new TextDecoder("utf-8", { fatal: true }).decode(octets);
  } catch {
    return line;
  }
}
