// A list of lines of which only those in sight are in the page.
import { lineNow, lineOf } from "./lines.js";

const HIGH = 18; // pixels of a line
const TALLEST = 6e6; // pixels that browsers scroll; beyond, a pixel of the bar is more than one

export function listOf(name, text, acts) {
  const box = element("div", "list");
  const heading = element("h2");
  const title = element("span");
  title.textContent = name;
  const number = element("input");
  Object.assign(number, { type: "number", min: 1, max: text.count, placeholder: "line" });
  number.setAttribute("aria-label", `go to a line of ${name}`);
  heading.append(title, number);
  const rows = element("div", "rows");
  rows.tabIndex = 0;
  const tall = element("div");
  rows.append(tall);
  box.append(heading, rows);
  const list = { box, rows, tall, text, acts, chosen: -1, linked: new Set(), shown: new Map() };
  tall.style.height = `${Math.min(text.count * HIGH, TALLEST)}px`;
  tall.style.minWidth = "max-content";
  rows.addEventListener("scroll", () => fill(list));
  new ResizeObserver(() => fill(list)).observe(rows);
  rows.addEventListener("click", (event) => clicked(list, event));
  rows.addEventListener("keydown", (event) => walked(list, event));
  number.addEventListener("change", () => acts.choose(Math.min(text.count, Math.max(1, number.valueAsNumber || 1)) - 1));
  return list;
}

function element(kind, name = "") {
  const made = document.createElement(kind);
  if (name) made.className = name;
  return made;
}

function clicked(list, event) {
  const line = event.target.closest(".line");
  if (line) list.acts.choose(Number(line.dataset.line));
}

function walked(list, event) {
  const steps = { ArrowDown: 1, ArrowUp: -1, PageDown: 20, PageUp: -20 };
  if (!(event.key in steps)) return;
  event.preventDefault();
  event.stopPropagation();
  const next = Math.max(0, list.chosen) + steps[event.key];
  list.acts.choose(Math.min(list.text.count - 1, Math.max(0, next)));
}

// Lines to a pixel of the scroll bar, where there are more than it has pixels.
function stretch(list) {
  const room = list.rows.clientHeight;
  const all = list.text.count * HIGH;
  return all <= TALLEST ? 1 : (all - room) / (TALLEST - room);
}

function firstInSight(list) {
  return Math.floor((list.rows.scrollTop * stretch(list)) / HIGH);
}

export function fill(list) {
  const first = Math.max(0, firstInSight(list));
  const last = Math.min(list.text.count - 1, first + Math.ceil(list.rows.clientHeight / HIGH) + 1);
  for (const [line, shown] of list.shown) {
    if (line < first || line > last) {
      shown.remove();
      list.shown.delete(line);
    }
  }
  const top = list.rows.scrollTop - ((list.rows.scrollTop * stretch(list)) % HIGH);
  for (let line = first; line <= last; line++) {
    const shown = list.shown.get(line) ?? added(list, line);
    shown.style.top = `${top + (line - first) * HIGH}px`;
    marked(list, line, shown);
  }
}

function added(list, line) {
  const shown = element("div", "line");
  const number = element("i");
  number.textContent = line + 1;
  const words = document.createTextNode(lineNow(list.text, line) ?? "");
  shown.append(number, words);
  shown.dataset.line = line;
  shown.classList.toggle("still", !list.acts.moves(line));
  if (lineNow(list.text, line) === undefined) {
    lineOf(list.text, line).then((text) => { words.data = text; });
  }
  list.tall.append(shown);
  list.shown.set(line, shown);
  return shown;
}

function marked(list, line, shown) {
  shown.classList.toggle("chosen", line === list.chosen);
  shown.classList.toggle("linked", list.linked.has(line));
}

// Mark lines, and bring the first of them into sight.
export function mark(list, chosen, linked = []) {
  list.chosen = chosen;
  list.linked = new Set(linked);
  const line = chosen >= 0 ? chosen : Math.min(...linked);
  if (Number.isFinite(line) && line >= 0) intoSight(list, line);
  fill(list);
}

function intoSight(list, line) {
  const first = firstInSight(list);
  const room = Math.floor(list.rows.clientHeight / HIGH);
  if (line > first && line < first + room - 1) return;
  list.rows.scrollTop = ((Math.max(0, line - Math.floor(room / 3))) * HIGH) / stretch(list);
}
